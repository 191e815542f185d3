#include <utility>

#include "api/context.hpp"

namespace roverd::api {

namespace {

constexpr int kMostZoom = 30;

Json sets_json(const std::vector<store::TileSet>& sets) {
  Json items = Json::array();
  for (const store::TileSet& set : sets) {
    items.push_back({{"set", set.set},
                     {"name", set.name},
                     {"format", set.format},
                     {"min_zoom", set.min_zoom},
                     {"max_zoom", set.max_zoom},
                     {"bounds", set.bounds_deg ? Json(*set.bounds_deg) : Json(nullptr)},
                     {"attribution", set.attribution}});
  }
  return {{"items", std::move(items)}, {"next_cursor", nullptr}};
}

/// "12" or "12.png": the ending is for people, the set knows its format.
std::optional<std::int64_t> tile_number(std::string_view text) {
  return whole_number(text.substr(0, text.find('.')));
}

struct TilePlace {
  int x = 0;
  int y = 0;
};

Response tile_response(const Tiles& tiles, const Call& call, int zoom, TilePlace at) {
  const std::string& set = call.params.at("set");
  auto found = tiles.read ? tiles.read(set, zoom, at.x, at.y) : std::optional<store::Tile>{};
  if (!found) return problem({base::Code::NotFound, "no such tile in set \"" + set + "\""});
  const std::string tag = "\"" + std::to_string(std::hash<std::string>{}(found->bytes)) + "\"";
  Response response = text_response(http::status::ok, found->content_type, std::move(found->bytes));
  response.set(http::field::cache_control, "max-age=3600");
  response.set(http::field::etag, tag);
  if (!found->content_encoding.empty()) {
    response.set(http::field::content_encoding, found->content_encoding);
  }
  if (header(call.request, http::field::if_none_match).find(tag) != std::string_view::npos) {
    response.result(http::status::not_modified);
    response.body().clear();
  }
  return response;
}

Handler tile(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    std::vector<base::FieldError> errors;
    const auto number = [&](const char* name, std::int64_t most) {
      const auto value = tile_number(call->params.at(name));
      if (value && *value <= most) return static_cast<int>(*value);
      errors.push_back({name, "must be a whole number in 0 .. " + std::to_string(most)});
      return 0;
    };
    const int zoom = number("z", kMostZoom);
    const std::int64_t side = (std::int64_t{1} << zoom) - 1;
    const int x = number("x", side);
    const int y = number("y", side);
    if (!errors.empty()) {
      return call->respond(
          problem({base::Code::Invalid, "there is no such tile address", std::move(errors)}));
    }
    const Effort effort{Effort::kAtOnce + 1};  // a disk may pause
    context->answer_aside(call, effort, [context, call, zoom, x, y] {
      return tile_response(context->deps.tiles, *call, zoom, {x, y});
    });
  };
}

}  // namespace

void add_tile_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  c->router.add({get, "/tiles", {200}, [c](const CallPtr& call) {
                   call->respond(json_response(http::status::ok, sets_json(c->deps.tiles.sets)));
                 }});
  c->router.add({get, "/tiles/{set}/{z}/{x}/{y}", {200, 304, 404, 422, 503}, tile(c)});
}

}  // namespace roverd::api
