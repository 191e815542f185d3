// The shortest way through a node map as a mission.

#include <algorithm>
#include <utility>

#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"
#include "robot/map_frame.hpp"

namespace roverd::api {

namespace {

/// One way on its way. Web thread.
class WayRequest : public std::enable_shared_from_this<WayRequest> {
 public:
  WayRequest(ContextPtr context, CallPtr call)
      : context_(std::move(context)), call_(std::move(call)) {}

  void begin(const Json& body) {
    Members members(body);
    for (const char* name : {"from", "to"}) members.require(name);
    from_ = place(members, "from");
    to_ = place(members, "to");
    const auto graph = members.text("graph");
    name_ = members.text("name");
    speed_mps_ = members.number("speed_mps", 0.05, 10.0);
    if (name_) {
      if (auto wrong = mission::name_problem(*name_); !wrong.empty()) {
        members.complain("name", std::move(wrong));
      }
    }
    if (const auto fine = members.finish(); !fine) return refuse(fine.error());
    if (graph) return read(*graph);
    // Without a name the only one is meant.
    context_->deps.store.list_route_maps(2, "", [self = shared_from_this()](auto page) {
      if (!page) return self->refuse(page.error());
      if (page->items.size() == 1) return self->read(page->items.front().id);
      const char* detail = page->items.empty() ? "cannot be: no node map was imported"
                                               : "is needed: there are several node maps";
      self->refuse({base::Code::Invalid, std::string("graph ") + detail, {{"/graph", detail}}});
    });
  }

 private:
  /// A node's id, or a word.
  struct Place {
    std::optional<std::int64_t> node;
    std::string word;
  };

  static Place place(Members& members, const char* name) {
    Place out;
    const Json* value = members.any(name);
    if (value == nullptr) return out;
    if (value->is_string()) {
      out.word = value->get<std::string>();
      if (out.word != "here" && out.word != "home") {
        members.complain(name, "must be a node's id, \"here\" or \"home\"");
      }
    } else if (value->is_number_integer() &&
               !(value->is_number_unsigned() && value->get<std::uint64_t>() > INT64_MAX)) {
      out.node = value->get<std::int64_t>();
    } else {
      members.complain(name, "must be a node's id, \"here\" or \"home\"");
    }
    return out;
  }

  void refuse(const base::Error& error) { call_->respond(problem(error)); }

  void read(const std::string& id) {
    context_->deps.store.read_route_map(
        id, [self = shared_from_this()](base::Result<store::RouteMap> map) {
          if (map) return self->plan(std::move(*map));
          base::Error error = std::move(map.error());
          if (error.code == base::Code::NotFound) {
            error.code = base::Code::Invalid;
            error.fields = {{"/graph", error.detail}};
          }
          self->refuse(error);
        });
  }

  base::Result<std::int64_t> node_of(const store::RouteMap& map, const Place& place,
                                     const char* pointer) const {
    const auto wrong = [pointer](std::string detail) {
      return base::fail(base::Code::Invalid, std::string(pointer + 1) + " " + detail,
                        {{pointer, detail}});
    };
    if (place.node) {
      if (map.graph.find(*place.node) != nullptr) return *place.node;
      return wrong("cannot be: the map has no node " + std::to_string(*place.node));
    }
    if (place.word == "home") {
      if (map.graph.home) return *map.graph.home;
      return wrong("cannot be home: the map has no home node");
    }
    if (!map.about.frame.map && !map.about.frame.origin) {
      return wrong("cannot be here: the graph lies indoors, in no map that the robot knows");
    }
    return here(map);
  }

  /// Of a robot that is found in the graph's map the nearest node in it; else by its position.
  base::Result<std::int64_t> here(const store::RouteMap& map) const {
    const auto snapshot = context_->deps.robot.snapshot();
    const mission::MapFrame& frame = map.about.frame;
    base::Error unknown{base::Code::Conflict, "the vehicle's position is not known", {}};
    if (frame.map) {
      const auto place = snapshot ? snapshot->place : std::nullopt;
      const auto found = robot::found_in({*frame.map}, place, base::steady_now());
      const auto nearest = found ? mission::nearest_node(map.graph, found->x_m, found->y_m)
                                 : std::optional<std::int64_t>();
      if (nearest) return *nearest;
      if (!found) unknown = found.error();  // as the start of the mission would say it
      const bool outdoors = std::ranges::any_of(
          map.graph.nodes, [](const auto& n) { return n.on_earth.has_value(); });
      if (!outdoors) return tl::unexpected(std::move(unknown));
    }
    const bool known =
        snapshot && snapshot->pose &&
        base::seconds(base::steady_now() - snapshot->pose->stamp) <= StaleAfter::kPosition_s;
    if (!known) return tl::unexpected(std::move(unknown));
    const auto nearest = mission::nearest_node(map.graph, frame, snapshot->pose->global);
    if (nearest) return *nearest;
    return base::fail(base::Code::Conflict, "the vehicle is more than 10 km away from the map");
  }

  /// Along the links; where that is refused for want of a place on the earth, it says so.
  static base::Result<std::vector<std::int64_t>> along(const store::RouteMap& map,
                                                       const mission::OnePlane& flat,
                                                       std::int64_t from, std::int64_t to) {
    auto way = mission::shortest_way(flat.graph, from, to);
    if (way || !flat.parted || !mission::shortest_way(map.graph, from, to)) return way;
    return base::fail(base::Code::Conflict,
                      way.error().detail +
                          ": it would lead between places on the earth and the map \"" +
                          *map.about.frame.map +
                          "\", and nobody knows where on the earth that lies. Give it an anchor");
  }

  struct Way {
    mission::Plan plan;
    std::shared_ptr<Json> body;
    std::string what;
  };

  void plan(store::RouteMap map) {
    const Effort effort{20 * map.graph.nodes.size()};
    const auto& of_map = map.about.frame.map;
    const auto lies = of_map ? context_->lies_of(*of_map) : std::nullopt;
    context_->aside(
        call_, effort,
        [self = shared_from_this(), map = std::move(map), lies] { return self->way_on(map, lies); },
        [self = shared_from_this()](base::Result<Way> way) {
          if (!way) return self->refuse(way.error());
          self->answer(std::move(*way));
        });
  }

  /// Beside the web thread: reads what nobody changes any more.
  base::Result<Way> way_on(const store::RouteMap& map,
                           const std::optional<base::MapLies>& lies) const {
    const auto from = node_of(map, from_, "/from");
    if (!from) return tl::unexpected<base::Error>(from.error());
    const auto to = node_of(map, to_, "/to");
    if (!to) return tl::unexpected<base::Error>(to.error());
    const mission::OnePlane flat = mission::on_one_plane(map.graph, lies);
    const auto way = along(map, flat, *from, *to);
    if (!way) return tl::unexpected<base::Error>(way.error());
    mission::Plan plan;
    plan.name = name_.value_or("Node " + std::to_string(*from) + " to " + std::to_string(*to));
    plan.settings.speed_mps = speed_mps_;
    plan.items = mission::items_along(flat.graph, map.about.frame, *way);
    const bool in_map = std::ranges::any_of(
        *way, [&flat](std::int64_t id) { return !flat.graph.find(id)->on_earth; });
    const auto& of_map = map.about.frame.map;
    if (of_map && in_map) plan.frame = mission::MissionMap{*of_map};
    if (const auto fine = mission::check_plan(plan); !fine) {
      return tl::unexpected<base::Error>(fine.error());
    }
    auto body = std::make_shared<Json>(Json{{"graph", map.about.id},
                                            {"nodes", *way},
                                            {"length_m", mission::way_length_m(flat.graph, *way)}});
    if (!name_) (*body)["mission"] = mission::plan_to_json(plan);
    return Way{std::move(plan), std::move(body), "planned on " + map.about.name};
  }

  void answer(Way way) {
    const Effort effort{2 * bytes_of(way.plan), true};
    if (!name_) {
      return context_->answer_aside(call_, effort, [body = std::move(way.body)] {
        return json_response(http::status::ok, *body);
      });
    }
    context_->deps.store.create_mission(
        std::move(way.plan), {kAuthor, way.what},
        [self = shared_from_this(), body = std::move(way.body),
         effort](base::Result<store::StoredMission> stored) {
          if (!stored) return self->refuse(stored.error());
          self->context_->announce(stored->id, stored->revision);
          self->context_->answer_aside(self->call_, effort, [body, mission = std::move(*stored)] {
            Response response = mission_response(http::status::created, mission);
            (*body)["mission"] = mission_json(mission);
            response.body() = json_response(http::status::created, *body).body();
            return response;
          });
        });
  }

  ContextPtr context_;
  CallPtr call_;
  Place from_;
  Place to_;
  std::optional<std::string> name_;
  std::optional<double> speed_mps_;
};

}  // namespace

void add_way_routes(const ContextPtr& c) {
  const auto post = http::verb::post;
  c->router.add({post,
                 "/routes/plan",
                 {200, 201, 400, 403, 409, 413, 415, 422, 429, 503},
                 [c](const CallPtr& call) {
                   const auto body = json_body(call->request);
                   if (!body) return call->respond(problem(body.error()));
                   std::make_shared<WayRequest>(c, call)->begin(*body);
                 }});
}

}  // namespace roverd::api
