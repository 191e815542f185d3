// Node maps: imported, listed, read and deleted.

#include <charconv>
#include <utility>

#include "api/context.hpp"
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

/// A graph counts from one thing. @param beside what says something else; empty: nothing does
base::Result<std::string> map_named(std::string map, const std::string& beside) {
  const auto wrong = [](const std::string& detail) {
    return base::fail(base::Code::Invalid, "map " + detail, {{"map", detail}});
  };
  if (auto problem = mission::name_problem(map); !problem.empty()) return wrong(problem);
  if (beside.empty()) return map;
  return wrong("cannot stand beside " + beside +
               ": the nodes are metres of that map, which says itself where on the earth it "
               "lies; nodes that lie on the earth are a graph of their own");
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
  if (std::string map = query_text(call, "map"); !map.empty()) {
    auto named = map_named(std::move(map), *lat ? "origin_lat" : *heading ? "heading_deg" : "");
    if (!named) return tl::unexpected(named.error());
    frame.map = std::move(*named);
  }
  if (*lat) frame.origin = LatLon{**lat, **lon};
  frame.heading_deg = heading->value_or(frame.heading_deg);
  return frame;
}

Json map_json(const store::RouteMapSummary& s) {
  Json out = {{"id", s.id},
              {"name", s.name},
              {"created", base::to_rfc3339(s.created)},
              {"origin", nullptr},
              {"map", s.frame.map ? Json(*s.frame.map) : Json(nullptr)},
              {"heading_deg", s.frame.heading_deg},
              {"home", s.home ? Json(*s.home) : Json(nullptr)},
              {"nodes", s.nodes},
              {"links", s.links}};
  if (s.frame.origin) {
    out["origin"] = {{"lat", s.frame.origin->lat}, {"lon", s.frame.origin->lon}};
  }
  return out;
}

/// Empty: indoors, or nobody knows where the map lies that it counts from.
std::optional<LatLon> on_earth(const mission::MapNode& node, const mission::MapFrame& frame,
                               const std::optional<base::MapLies>& lies) {
  if (node.on_earth) return node.on_earth;
  if (frame.origin) return mission::position_of(node, frame);
  if (!lies) return std::nullopt;
  return mission::place_on_earth(*lies, {.x_m = node.x_m, .y_m = node.y_m});
}

/// @param lies the map that it counts from
Json map_with_nodes_json(const store::RouteMap& map, const std::optional<base::MapLies>& lies) {
  Json out = map_json(map.about);
  Json nodes = Json::array();
  for (const mission::MapNode& n : map.graph.nodes) {
    Json node = {{"id", n.id},     {"x_m", n.x_m},   {"y_m", n.y_m},    {"theta_rad", n.theta_rad},
                 {"lat", nullptr}, {"lon", nullptr}, {"links", n.links}};
    if (n.on_earth) node["x_m"] = node["y_m"] = node["theta_rad"] = nullptr;
    if (const auto at = on_earth(n, map.about.frame, lies)) {
      node["lat"] = at->lat;
      node["lon"] = at->lon;
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
        call, effort,
        [body = std::move(body), frame = *frame] {
          auto read = mission::graph_from_text(body);
          if (!read) return read;
          if (const auto fine = mission::settle_on_earth(read->graph, frame); !fine) {
            read = tl::unexpected(fine.error());
          }
          return read;
        },
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
          const auto& of_map = map->about.frame.map;
          auto lies = of_map ? context->lies_of(*of_map) : std::nullopt;
          context->answer_aside(call, effort, [map = std::move(*map), lies] {
            return json_response(http::status::ok, map_with_nodes_json(map, lies));
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
}

}  // namespace roverd::api
