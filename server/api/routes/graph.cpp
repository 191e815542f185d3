// Node maps: imported, listed, read, deleted, and the shortest way through one as a mission.

#include <charconv>
#include <utility>

#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::api {

namespace {

using base::LatLon;

/// ?name= as a number in a range; left out: empty.
base::Result<std::optional<double>> query_number(const Call& call, const char* name, double min,
                                                 double max) {
  const std::string text = query_text(call, name);
  if (text.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = ec == std::errc{} && end == text.data() + text.size();
  if (number && value >= min && value <= max) return value;
  const std::string detail =
      "must be a number from " + mission::number_text(min) + " to " + mission::number_text(max);
  return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
}

base::Result<mission::MapFrame> map_frame_of(const Call& call) {
  const auto lat = query_number(call, "origin_lat", -90.0, 90.0);
  if (!lat) return tl::unexpected(lat.error());
  const auto lon = query_number(call, "origin_lon", -180.0, 180.0);
  if (!lon) return tl::unexpected(lon.error());
  const auto heading = query_number(call, "heading_deg", -360.0, 360.0);
  if (!heading) return tl::unexpected(heading.error());
  if (lat->has_value() != lon->has_value()) {
    const char* missing = *lat ? "origin_lon" : "origin_lat";
    return base::fail(base::Code::Invalid, std::string(missing) + " is missing",
                      {{missing, "is missing"}});
  }
  mission::MapFrame frame;
  if (*lat) frame.origin = LatLon{**lat, **lon};
  frame.heading_deg = heading->value_or(frame.heading_deg);
  return frame;
}

Json map_json(const store::RouteMapSummary& s) {
  Json out = {{"id", s.id},
              {"name", s.name},
              {"created", base::to_rfc3339(s.created)},
              {"origin", nullptr},
              {"heading_deg", s.frame.heading_deg},
              {"home", s.home ? Json(*s.home) : Json(nullptr)},
              {"nodes", s.nodes},
              {"links", s.links}};
  if (s.frame.origin) {
    out["origin"] = {{"lat", s.frame.origin->lat}, {"lon", s.frame.origin->lon}};
  }
  return out;
}

Json map_with_nodes_json(const store::RouteMap& map) {
  Json out = map_json(map.about);
  Json nodes = Json::array();
  for (const mission::MapNode& n : map.graph.nodes) {
    Json node = {{"id", n.id},     {"x_m", n.x_m},   {"y_m", n.y_m},    {"theta_rad", n.theta_rad},
                 {"lat", nullptr}, {"lon", nullptr}, {"links", n.links}};
    if (map.about.frame.origin) {
      const LatLon at = mission::position_of(n, map.about.frame);
      node["lat"] = at.lat;
      node["lon"] = at.lon;
    }
    nodes.push_back(std::move(node));
  }
  out["node_list"] = std::move(nodes);
  return out;
}

store::Reply<store::RouteMap> imported(const ContextPtr& context, const CallPtr& call,
                                       std::vector<mission::MapNote> notes) {
  return [context, call, notes = std::move(notes)](base::Result<store::RouteMap> stored) {
    if (!stored) return call->respond(problem(stored.error()));
    Json body = map_json(stored->about);
    body["notes"] = Json::array();
    for (const mission::MapNote& note : notes) {
      body["notes"].push_back({{"line", note.line}, {"detail", note.detail}});
    }
    Response response = json_response(http::status::created, body);
    response.set(http::field::location, "/api/v1/routes/" + stored->about.id);
    call->respond(std::move(response));
    context->discard(std::move(*stored));
  };
}

Handler import_map(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto frame = map_frame_of(*call);
    if (!frame) return call->respond(problem(frame.error()));
    std::string body = std::move(call->request.body());
    const Effort effort{body.size()};
    context->aside(
        call, effort, [body = std::move(body)] { return mission::graph_from_text(body); },
        [context, call, frame = *frame](auto read) {
          if (!read) return call->respond(problem(read.error()));
          store::RouteMap map;
          map.about.name = mission::clean_name(query_text(*call, "name"), "Node map");
          map.about.frame = frame;
          map.graph = std::move(read->graph);
          context->deps.store.create_route_map(std::move(map),
                                               imported(context, call, std::move(read->notes)));
        });
  };
}

Handler list_maps(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto limit = limit_of(*call);
    if (!limit) return call->respond(problem(limit.error()));
    context->deps.store.list_route_maps(
        *limit, query_text(*call, "cursor"),
        [call](base::Result<store::Page<store::RouteMapSummary>> page) {
          if (!page) return call->respond(problem(page.error()));
          Json items = Json::array();
          for (const auto& summary : page->items) items.push_back(map_json(summary));
          Json body = {{"items", std::move(items)}, {"next_cursor", nullptr}};
          if (page->next_cursor) body["next_cursor"] = *page->next_cursor;
          call->respond(json_response(http::status::ok, body));
        });
  };
}

Handler read_map(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    context->deps.store.read_route_map(
        call->params.at("id"), [context, call](base::Result<store::RouteMap> map) {
          if (!map) return call->respond(problem(map.error()));
          const Effort effort{150 * map->graph.nodes.size()};
          context->answer_aside(call, effort, [map = std::move(*map)] {
            return json_response(http::status::ok, map_with_nodes_json(map));
          });
        });
  };
}

Handler delete_map(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    context->deps.store.delete_route_map(call->params.at("id"), [call](base::Result<void> result) {
      if (!result) return call->respond(problem(result.error()));
      call->respond(Response{http::status::no_content, 11});
    });
  };
}

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
    if (!map.about.frame.origin) return wrong("cannot be here: the map lies indoors");
    const auto snapshot = context_->deps.robot.snapshot();
    const bool known =
        snapshot && snapshot->pose &&
        base::seconds(base::steady_now() - snapshot->pose->stamp) <= StaleAfter::kPosition_s;
    if (!known) return base::fail(base::Code::Conflict, "the vehicle's position is not known");
    const auto nearest = mission::nearest_node(map.graph, map.about.frame, snapshot->pose->global);
    if (nearest) return *nearest;
    return base::fail(base::Code::Conflict, "the vehicle is more than 10 km away from the map");
  }

  struct Way {
    mission::Plan plan;
    std::shared_ptr<Json> body;
    std::string what;
  };

  void plan(store::RouteMap map) {
    const Effort effort{20 * map.graph.nodes.size()};
    context_->aside(
        call_, effort,
        [self = shared_from_this(), map = std::move(map)] { return self->way_on(map); },
        [self = shared_from_this()](base::Result<Way> way) {
          if (!way) return self->refuse(way.error());
          self->answer(std::move(*way));
        });
  }

  /// Beside the web thread: reads what nobody changes any more.
  base::Result<Way> way_on(const store::RouteMap& map) const {
    const auto from = node_of(map, from_, "/from");
    if (!from) return tl::unexpected<base::Error>(from.error());
    const auto to = node_of(map, to_, "/to");
    if (!to) return tl::unexpected<base::Error>(to.error());
    const auto way = mission::shortest_way(map.graph, *from, *to);
    if (!way) return tl::unexpected<base::Error>(way.error());
    mission::Plan plan;
    plan.name = name_.value_or("Node " + std::to_string(*from) + " to " + std::to_string(*to));
    plan.settings.speed_mps = speed_mps_;
    plan.items = mission::items_along(map.graph, map.about.frame, *way);
    if (const auto fine = mission::check_plan(plan); !fine) {
      return tl::unexpected<base::Error>(fine.error());
    }
    auto body = std::make_shared<Json>(Json{{"graph", map.about.id},
                                            {"nodes", *way},
                                            {"length_m", mission::way_length_m(map.graph, *way)}});
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

void add_route_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  c->router.add(
      {post, "/routes/import", {201, 400, 403, 413, 422, 429, 503}, import_map(c), kDocumentBytes});
  c->router.add({get, "/routes", {200, 400, 422, 503}, list_maps(c)});
  c->router.add({get, "/routes/{id}", {200, 404, 503}, read_map(c)});
  c->router.add(
      {http::verb::delete_, "/routes/{id}", {204, 400, 403, 404, 429, 503}, delete_map(c)});
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
