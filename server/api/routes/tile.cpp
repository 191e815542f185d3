#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "api/body.hpp"
#include "api/context.hpp"

namespace roverd::api {

namespace {

using base::Code;
using base::Result;

constexpr std::int64_t kMostBytes = std::int64_t{1} << 40;
const Effort kADisk{Effort::kAtOnce + 1};  // it may pause
const Effort kAFile{Effort::kSlow};        // a whole set is looked through when it is complete

Json set_json(const store::TileSet& set) {
  return {{"set", set.set},
          {"name", set.name},
          {"format", set.format},
          {"min_zoom", set.min_zoom},
          {"max_zoom", set.max_zoom},
          {"bounds", set.bounds_deg ? Json(*set.bounds_deg) : Json(nullptr)},
          {"attribution", set.attribution},
          {"kept", set.kept},
          {"grows", set.grows},
          {"shift_m", set.shift_m},
          {"bytes", set.bytes}};
}

Json list_json(const Tiles& tiles) {
  Json items = Json::array();
  Json unfinished = Json::array();
  Json online = Json::array();
  if (tiles.shelf != nullptr) {
    for (const store::TileSet& set : tiles.shelf->sets()) items.push_back(set_json(set));
    for (const auto& [set, bytes] : tiles.shelf->unfinished()) {
      unfinished.push_back({{"set", set}, {"received_bytes", bytes}});
    }
  }
  for (const OnlineTiles& one : tiles.online) {
    online.push_back({{"name", one.name},
                      {"url", one.url},
                      {"attribution", one.attribution},
                      {"max_zoom", one.max_zoom}});
  }
  return {{"items", std::move(items)},
          {"unfinished", std::move(unfinished)},
          {"online", std::move(online)},
          {"next_cursor", nullptr}};
}

/// "12" or "12.png": the ending is for people, the set knows its format.
std::optional<std::int64_t> tile_number(std::string_view text) {
  return whole_number(text.substr(0, text.find('.')));
}

Result<store::TileAddress> address_of(const Call& call) {
  std::vector<base::FieldError> errors;
  const auto number = [&](const char* name, std::int64_t most) {
    const auto value = tile_number(call.params.at(name));
    if (value && *value <= most) return static_cast<int>(*value);
    errors.push_back({name, "must be a whole number in 0 .. " + std::to_string(most)});
    return 0;
  };
  const int zoom = number("z", store::kMostZoom);
  const std::int64_t side = (std::int64_t{1} << zoom) - 1;
  const store::TileAddress at{zoom, number("x", side), number("y", side)};
  if (errors.empty()) return at;
  return base::fail(Code::Invalid, "there is no such tile address", std::move(errors));
}

Response tile_response(const Tiles& tiles, const Call& call, const store::TileAddress& at) {
  const std::string& set = call.params.at("set");
  auto found = tiles.shelf != nullptr ? tiles.shelf->read(set, at) : std::nullopt;
  if (!found) return problem({Code::NotFound, "no such tile in set \"" + set + "\""});
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
    const auto at = address_of(*call);
    if (!at) return call->respond(problem(at.error()));
    context->answer_aside(call, kADisk, [context, call, at = *at] {
      return tile_response(context->deps.tiles, *call, at);
    });
  };
}

/// Calls then(call, shelf), or says that there is none.
template <class Then>
Handler with_shelf(const ContextPtr& context, Then then) {
  return [context, then](const CallPtr& call) {
    store::TileShelf* const shelf = context->deps.tiles.shelf;
    if (shelf != nullptr) return then(call, *shelf);
    call->respond(problem({Code::Unavailable, "no map tiles are kept here"}));
  };
}

Result<store::TileSet> read_new_set(const Json& body) {
  Members members(body);
  store::TileSet set;
  members.require("set");
  set.set = members.text("set").value_or("");
  set.name = members.text("name").value_or(set.set);
  set.format = members.text("format").value_or("png");
  set.attribution = members.text("attribution").value_or("");
  if (!members.complained() && !store::is_tile_set_name(set.set)) {
    members.complain("set", "must be 1 to 40 of a-z, 0-9, - and _");
  }
  if (set.format != "png" && set.format != "jpg" && set.format != "webp" && set.format != "pbf") {
    members.complain("format", "must be one of png jpg webp pbf");
  }
  constexpr std::size_t kMost = 200;
  if (set.name.empty() || set.name.size() > kMost) {
    members.complain("name", "must have 1 to 200 bytes");
  }
  if (set.attribution.size() > kMost) members.complain("attribution", "must have up to 200 bytes");
  if (auto fine = members.finish(); !fine) return tl::unexpected(fine.error());
  return set;
}

Result<store::TileChange> read_set_change(const Json& body) {
  Members members(body);
  store::TileChange change;
  change.name = members.text("name");
  if (const Json* shift = members.any("shift_m"); shift != nullptr) {
    if (shift->is_array() && shift->size() == 2 && (*shift)[0].is_number() &&
        (*shift)[1].is_number()) {
      change.shift_m = {(*shift)[0].get<double>(), (*shift)[1].get<double>()};
    } else {
      members.complain("shift_m", "must be two numbers: metres to the east and to the north");
    }
  }
  if (auto fine = members.finish(); !fine) return tl::unexpected(fine.error());
  return change;
}

void create(const ContextPtr& context, const CallPtr& call, store::TileShelf& shelf) {
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  const auto set = read_new_set(*body);
  if (!set) return call->respond(problem(set.error()));
  context->answer_aside(call, kAFile, [&shelf, set = *set]() -> Response {
    const auto made = shelf.create(set);
    if (!made) return problem(made.error());
    Response response = json_response(http::status::created, set_json(*made));
    response.set(http::field::location, "/api/v1/tiles/" + made->set);
    return response;
  });
}

void put_tile(const ContextPtr& context, const CallPtr& call, store::TileShelf& shelf) {
  const auto at = address_of(*call);
  if (!at) return call->respond(problem(at.error()));
  context->answer_aside(
      call, kADisk,
      [&shelf, at = *at, set = call->params.at("set"),
       bytes = std::move(call->request.body())]() -> Response {
        const auto done = shelf.put(set, at, bytes);
        return done ? Response{http::status::no_content, 11} : problem(done.error());
      });
}

/// ?offset=N&size=N
Result<store::TilePiece> read_piece(const Call& call) {
  std::vector<base::FieldError> errors;
  const auto number = [&](const char* name) {
    const auto value = whole_number(query_text(call, name));
    if (value && *value <= kMostBytes) return static_cast<std::uintmax_t>(*value);
    errors.push_back({name, "must be a number of bytes"});
    return std::uintmax_t{0};
  };
  const store::TilePiece piece{number("offset"), number("size"), {}};
  if (!store::is_tile_set_name(call.params.at("set"))) {
    errors.push_back({"set", "must be 1 to 40 of a-z, 0-9, - and _"});
  }
  if (errors.empty()) return piece;
  return base::fail(Code::Invalid, "it cannot be told which piece it is", std::move(errors));
}

void take_piece(const ContextPtr& context, const CallPtr& call, store::TileShelf& shelf) {
  const auto piece = read_piece(*call);
  if (!piece) return call->respond(problem(piece.error()));
  context->answer_aside(call, kAFile,
                        [&shelf, piece = *piece, set = call->params.at("set"),
                         bytes = std::move(call->request.body())]() mutable -> Response {
                          piece.bytes = bytes;
                          const auto taken = shelf.take(set, piece);
                          if (!taken) return problem(taken.error());
                          if (*taken)
                            return json_response(http::status::created, set_json(**taken));
                          return json_response(
                              http::status::accepted,
                              {{"set", set}, {"received_bytes", piece.offset + bytes.size()}});
                        });
}

void change_set(const ContextPtr& context, const CallPtr& call, store::TileShelf& shelf) {
  const auto body = json_body(call->request);
  if (!body) return call->respond(problem(body.error()));
  const auto change = read_set_change(*body);
  if (!change) return call->respond(problem(change.error()));
  context->answer_aside(call, kADisk,
                        [&shelf, set = call->params.at("set"), change = *change]() -> Response {
                          const auto changed = shelf.change(set, change);
                          return changed ? json_response(http::status::ok, set_json(*changed))
                                         : problem(changed.error());
                        });
}

void remove_set(const ContextPtr& context, const CallPtr& call, store::TileShelf& shelf) {
  context->answer_aside(call, kADisk, [&shelf, set = call->params.at("set")]() -> Response {
    const auto gone = shelf.remove(set);
    return gone ? Response{http::status::no_content, 11} : problem(gone.error());
  });
}

}  // namespace

void add_tile_routes(const ContextPtr& c) {
  const auto on_shelf = [&c](auto handler) {
    return with_shelf(
        c, [c, handler](const CallPtr& call, store::TileShelf& shelf) { handler(c, call, shelf); });
  };
  c->router.add({http::verb::get, "/tiles", {200}, [c](const CallPtr& call) {
                   call->respond(json_response(http::status::ok, list_json(c->deps.tiles)));
                 }});
  c->router.add(
      {http::verb::post, "/tiles", {201, 400, 409, 413, 415, 422, 503}, on_shelf(create)});
  c->router.add({http::verb::patch,
                 "/tiles/{set}",
                 {200, 400, 404, 409, 413, 415, 422, 503},
                 on_shelf(change_set)});
  c->router.add(
      {http::verb::delete_, "/tiles/{set}", {204, 400, 404, 409, 503}, on_shelf(remove_set)});
  c->router.add({http::verb::put,
                 "/tiles/{set}/file",
                 {201, 202, 400, 409, 413, 415, 422, 503},
                 on_shelf(take_piece),
                 kPieceBytes});
  c->router.add({http::verb::get, "/tiles/{set}/{z}/{x}/{y}", {200, 304, 404, 422, 503}, tile(c)});
  c->router.add({http::verb::put,
                 "/tiles/{set}/{z}/{x}/{y}",
                 {204, 400, 404, 409, 413, 415, 422, 503},
                 on_shelf(put_tile),
                 kPictureBytes});
}

}  // namespace roverd::api
