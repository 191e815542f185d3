// Maps of the plane, and of three dimensions: kept, changed a little, chosen. What touches their
// files is done beside the web thread.

#include <cstdint>
#include <functional>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "api/context.hpp"
#include "api/json/map_words.hpp"
#include "api/map_request.hpp"
#include "maps/exchange.hpp"
#include "mission/formats/formats.hpp"
#include "robot/modes/machine.hpp"

namespace roverd::api {

namespace {

using base::Code;
using base::Error;
using base::Result;

constexpr std::int64_t kUsualCells = 1'000'000;
constexpr std::int64_t kMostCells = 40'000'000;
const Effort kLook{Effort::kAtOnce + 1};        // a disk may pause
const Effort kCells{Effort::kSlow};             // all cells of a map
const Effort kKeep{Effort::kSlow, true};        // waits for the robot
const Effort kTell{Effort::kAtOnce + 1, true};  // what was done is told, however many ask

Response no_shelf() {
  return problem({Code::Unavailable, "no maps are kept here"});
}

MapsNow now_of(const Context& context) {
  const MapDoor& door = context.deps.maps;
  MapsNow out{door.shelf->in_use(), std::nullopt, std::nullopt};
  if (door.making) out.making = door.making();
  if (out.in_use && door.placed) out.placed = door.placed();
  return out;
}

/// The map that the path means; empty: no number as the list writes them. By "03" a map would have
/// two names, and who may change it is asked of one.
std::optional<std::int64_t> id_of(const Call& call) {
  const std::string& said = call.params.at("id");
  const auto id = whole_number(said);
  return id && std::to_string(*id) == said ? id : std::nullopt;
}

/// Calls then(shelf, id), or answers what is in the way of that.
template <class Then>
Handler with_map(const ContextPtr& context, Then then) {
  return [context, then](const CallPtr& call) {
    maps::Shelf* const shelf = context->deps.maps.shelf;
    if (shelf == nullptr) return call->respond(no_shelf());
    const auto id = id_of(*call);
    if (!id) {
      return call->respond(problem({Code::NotFound, "there is no such map: its id is a number"}));
    }
    then(call, *shelf, *id);
  };
}

Response map_response(const Context& context, http::status status, const maps::About& about) {
  return json_response(status, map_json(about, now_of(context), true));
}

Response map_or_problem(const Context& context, const Result<maps::About>& about) {
  return about ? map_response(context, http::status::ok, *about) : problem(about.error());
}

/// Why no other map may be taken now: what is driven would be another way.
std::optional<Error> drives_by_itself(const Context& context) {
  const auto snapshot = context.deps.robot.snapshot();
  if (!snapshot || !snapshot->armed || !robot::drives_by_itself(snapshot->mode)) {
    return std::nullopt;
  }
  return Error{Code::Conflict,
               "the robot drives by itself (" + std::string(base::to_string(snapshot->mode)) +
                   "): the map stays as it is until it is in HOLD or MANUAL",
               {}};
}

void tell(const Context& context, const std::string& detail) {
  context.deps.robot.tell({base::wall_now(), base::Severity::Info, "map_in_use", detail});
}

/// On the web thread: what was made beside it is taken into use, if nothing came between.
std::optional<Error> take(const ContextPtr& context, const CallPtr& call,
                          const MapDoor::Take& into_use) {
  if (context->without_control(*call)) {
    return Error{Code::Conflict, "control went to another meanwhile", {}};
  }
  if (auto why = drives_by_itself(*context)) return why;
  into_use();
  return std::nullopt;
}

/// Frees a map of some hundred megabytes beside the web thread.
template <class T>
struct Beside {
  const Context& context;
  T& what;
  ~Beside() {
    try {
      context.discard(std::move(what));
    } catch (const std::bad_alloc&) {  // then it is freed here
    }
  }
};

/// The choice is made; it is written down, and the answer tells it once the robot looks there.
void keep_choice(const ContextPtr& context, const CallPtr& call, std::function<Response()> answer) {
  context->answer_aside(
      call, kKeep, [door = context->deps.maps, answer = std::move(answer)]() -> Response {
        if (const auto kept = door.shelf->keep_choice(); !kept) {
          return problem({Code::Unavailable,
                          "it is so now, but not after a restart: " + kept.error().detail,
                          {}});
        }
        if (door.looks && !door.looks()) {
          return problem({Code::Unavailable,
                          "it is chosen and kept, but the robot does not look there yet",
                          {}});
        }
        return answer();
      });
}

void use(const ContextPtr& context, const CallPtr& call, maps::Shelf& shelf, std::int64_t id) {
  const auto& prepare = context->deps.maps.prepare;
  const auto found = shelf.find(id);
  if (!found) return call->respond(problem(found.error()));
  if (!prepare) {
    return call->respond(
        problem({Code::Conflict, "no sensor looks around: nobody would look for the robot in it"}));
  }
  if (const auto why = drives_by_itself(*context)) return call->respond(problem(*why));
  context->aside(
      call, kCells, [prepare, id] { return prepare(id, false); },
      [context, call, &shelf, id, revision = found->revision](Result<MapDoor::Take> made) {
        if (!made) return call->respond(problem(made.error()));
        // On every way out; what was taken into use is held where it is used.
        const Beside<Result<MapDoor::Take>> freed{*context, made};
        if (const auto now = shelf.find(id); now && now->revision != revision) {
          return call->respond(
              problem({Code::Conflict, "the map was changed meanwhile: once more", {}}));
        }
        const auto why = take(context, call, [&] {
          if (shelf.choose(id)) (*made)();
        });
        if (why) return call->respond(problem(*why));
        const auto about = shelf.find(id);  // somebody may have deleted it meanwhile
        if (!about) return call->respond(problem(about.error()));
        tell(*context, "the map " + about->name + " is in use now");
        keep_choice(context, call, [context, about = *about] {
          return map_response(*context, http::status::ok, about);
        });
      });
}

Handler unuse(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    maps::Shelf* const shelf = context->deps.maps.shelf;
    if (shelf == nullptr) return call->respond(no_shelf());
    if (const auto why = drives_by_itself(*context)) return call->respond(problem(*why));
    (void)shelf->choose(std::nullopt);
    if (context->deps.maps.drop) context->deps.maps.drop();
    tell(*context, "no map is in use now");
    keep_choice(context, call, [context, shelf] {
      return json_response(http::status::ok, map_list_json(shelf->look(), now_of(*context)));
    });
  };
}

Handler add(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    maps::Shelf* const shelf = context->deps.maps.shelf;
    if (shelf == nullptr) return call->respond(no_shelf());
    std::string body = std::move(call->request.body());
    context->answer_aside(
        call, kCells,
        [context, shelf, now = base::wall_now(), body = std::move(body),
         type =
             std::string(header(call->request, http::field::content_type))]() mutable -> Response {
          const auto form = read_map_form(std::move(body), type);
          if (!form) return problem(form.error());
          const auto about = shelf->add(form->name, form->upload.map, form->upload.anchor, now,
                                        form->upload.solid, form->if_taken);
          if (!about) return problem(about.error());
          Json json = map_json(*about, now_of(*context), true);
          json["passed_over"] = form->upload.passed_over;
          Response response = json_response(http::status::created, json);
          response.set(http::field::location, "/api/v1/maps/" + std::to_string(about->id));
          return response;
        });
  };
}

Handler start_making(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const MapDoor& door = context->deps.maps;
    if (door.shelf == nullptr) return call->respond(no_shelf());
    if (!door.start_making) {
      return call->respond(problem({Code::Conflict, "no sensor looks around: there is no map"}));
    }
    if (const auto begun = door.start_making(); !begun) {
      return call->respond(problem(begun.error()));
    }
    call->respond(json_response(http::status::ok, making_json(now_of(*context).making)));
  };
}

/// What was seen becomes a map that is kept, or nothing.
Handler stop_making(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const MapDoor& door = context->deps.maps;
    if (door.shelf == nullptr) return call->respond(no_shelf());
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    auto what = read_stop_making(*body);
    if (!what) return call->respond(problem(what.error()));
    if (!door.finish_making || !door.making || !door.making()) {
      return call->respond(problem({Code::Conflict, "no map is being made"}));
    }
    // Before it ends the drive.
    if (!what->discard && what->if_taken == maps::IfTaken::Refuse) {
      if (const auto free = door.shelf->is_free(what->name); !free) {
        return call->respond(problem(free.error()));
      }
    }
    context->answer_aside(
        call, kCells,
        [context, door, what = std::move(*what), now = base::wall_now()]() -> Response {
          if (what.discard) {
            if (const auto done = door.drop_making(); !done) return problem(done.error());
            return Response{http::status::no_content, 11};
          }
          const auto about = door.finish_making([&](const maps::Made& made) {
            return door.shelf->add(what.name, made.map, made.anchor, now, made.solid,
                                   what.if_taken);
          });
          if (!about) return problem(about.error());
          Response response = map_response(*context, http::status::created, *about);
          response.set(http::field::location, "/api/v1/maps/" + std::to_string(about->id));
          return response;
        });
  };
}

/// What a change gave, and what takes it into use where it is of the map in use.
struct ChangedMap {
  maps::About about;
  MapDoor::Take into_use;  ///< empty: nobody needs it
  std::string not_used;    ///< why it could not be made; empty: it could
};

Result<ChangedMap> change(const MapDoor& door, std::int64_t id, const maps::Change& what) {
  const auto before = door.shelf->find(id);
  auto about = door.shelf->change(id, what);
  if (!about) return tl::unexpected<Error>(about.error());
  ChangedMap out{std::move(*about), {}, {}};
  if (!what.moves(before ? before->name : std::string{}) || door.shelf->in_use() != id ||
      !door.prepare)
    return out;
  try {  // it is kept by now: an answer that it failed would have it done once more
    auto made = door.prepare(id, true);
    if (made) {
      out.into_use = std::move(*made);
    } else {
      out.not_used = made.error().detail;
    }
  } catch (const std::bad_alloc&) {
    out.not_used = "there is no memory for it";
  }
  return out;
}

/// On the web thread: the robot looks through what was changed, unless another change or choice
/// came between. @return why it does not though it should
std::optional<std::string> look_through(const ContextPtr& context, const CallPtr& call,
                                        const maps::Shelf& shelf, const ChangedMap& changed) {
  const auto now = shelf.find(changed.about.id);
  if (!now || now->revision != changed.about.revision || shelf.in_use() != changed.about.id) {
    return std::nullopt;
  }
  if (!changed.not_used.empty()) return changed.not_used;
  if (!changed.into_use) return std::nullopt;
  call->acts = true;  // it may have come into use since the call was let in
  const auto why = take(context, call, changed.into_use);
  return why ? std::optional(why->detail) : std::nullopt;
}

void apply(const ContextPtr& context, const CallPtr& call, maps::Shelf& shelf, std::int64_t id,
           maps::Change what) {
  const auto now = shelf.find(id);
  if (what.moves(now ? now->name : std::string{}) && shelf.in_use() == id) {
    if (const auto why = drives_by_itself(*context)) return call->respond(problem(*why));
  }
  context->aside(
      call, kCells,
      [door = context->deps.maps, id, what = std::move(what)] { return change(door, id, what); },
      [context, call, &shelf](Result<ChangedMap> changed) {
        if (!changed) return call->respond(problem(changed.error()));
        const Beside<MapDoor::Take> freed{*context, changed->into_use};
        if (const auto why = look_through(context, call, shelf, *changed)) {
          return call->respond(problem({Code::Conflict,
                                        "the map is changed and kept, but the robot does not look "
                                        "through it yet: use it again (" +
                                            *why + ")",
                                        {}}));
        }
        context->answer_aside(call, kTell, [context, about = std::move(changed->about)] {
          return map_response(*context, http::status::ok, about);
        });
      });
}

/// What it asks for is read beside the web, too: it may name thousands of corners.
void patch(const ContextPtr& context, const CallPtr& call, maps::Shelf& shelf, std::int64_t id) {
  const Effort effort{call->request.body().size() * 4};
  context->aside(
      call, effort,
      [call]() -> Result<maps::Change> {
        const auto body = json_body(call->request);
        if (!body) return tl::unexpected<Error>(body.error());
        return read_map_change(*body);
      },
      [context, call, &shelf, id](Result<maps::Change> what) {
        if (!what) return call->respond(problem(what.error()));
        apply(context, call, shelf, id, std::move(*what));
      });
}

Response cells_response(const maps::Shelf& shelf, std::int64_t id, std::size_t most,
                        const std::string& tag) {
  const auto about = shelf.find(id);
  if (!about) return problem(about.error());
  const auto map = shelf.read(id);
  if (!map) return problem(map.error());
  maps::Shown shown = maps::shown(*map, about->forbidden, most);
  Response response =
      text_response(http::status::ok, "image/x-portable-graymap", std::move(shown.pgm));
  response.set("Roverd-Thinned", std::to_string(shown.factor));
  response.set(http::field::etag, tag);
  response.set(http::field::cache_control, "no-cache");
  return response;
}

/// A map of this number may be another one after a restart: its time tells them apart.
std::string tag_of(const maps::About& about, std::int64_t most) {
  return "\"map-" + std::to_string(about.id) + "-" + std::to_string(about.revision) + "-" +
         std::to_string(about.created.time_since_epoch().count()) + "-" + std::to_string(most) +
         "\"";
}

void cells(const ContextPtr& context, const CallPtr& call, const maps::Shelf& shelf,
           std::int64_t id) {
  std::int64_t most = kUsualCells;
  if (const std::string said = query_text(*call, "most"); !said.empty()) {
    const auto number = whole_number(said);
    if (!number || *number < 1 || *number > kMostCells) {
      const std::string detail = "must be a whole number in 1 .. " + std::to_string(kMostCells);
      return call->respond(problem({Code::Invalid, "most " + detail, {{"most", detail}}}));
    }
    most = *number;
  }
  const auto about = shelf.find(id);
  if (!about) return call->respond(problem(about.error()));
  const std::string tag = tag_of(*about, most);
  const bool known =
      header(call->request, http::field::if_none_match).find(tag) != std::string_view::npos;
  if (known && id != maps::kConfigured) {  // that one's file may be another by now
    Response response{http::status::not_modified, 11};
    response.set(http::field::etag, tag);
    return call->respond(std::move(response));
  }
  context->answer_aside(call, kCells, [&shelf, id, most, tag] {
    return cells_response(shelf, id, static_cast<std::size_t>(most), tag);
  });
}

Response export_response(const maps::Shelf& shelf, std::int64_t id, const std::string& format,
                         bool with_forbidden) {
  const auto about = shelf.find(id);
  if (!about) return problem(about.error());
  const std::string name = mission::file_stem(about->name, "map") + "-" + std::to_string(id);
  const auto file = [&name](const char* type, const char* ending, std::string content) {
    Response response = text_response(http::status::ok, type, std::move(content));
    response.set(http::field::content_disposition,
                 "attachment; filename=\"" + name + ending + "\"");
    return response;
  };
  if (format == "pcd") {
    const auto solid = shelf.solid_file(id);
    if (!solid) return problem(solid.error());
    return file("application/octet-stream", ".pcd", {solid->begin(), solid->end()});
  }
  auto map = shelf.read(id);
  if (!map) return problem(map.error());
  if (format == "yaml")
    return file("application/yaml", ".yaml", maps::exported_yaml(*map, *about, name + ".pgm"));
  auto pgm = maps::exported_pgm(std::move(*map),
                                with_forbidden ? about->forbidden : std::vector<maps::Area>());
  if (!pgm) return problem(pgm.error());
  return file("image/x-portable-graymap", ".pgm", std::move(*pgm));
}

void export_map(const ContextPtr& context, const CallPtr& call, const maps::Shelf& shelf,
                std::int64_t id) {
  const std::string format = query_text(*call, "format");
  const std::string forbidden = query_text(*call, "forbidden");
  const auto invalid = [&call](const char* name, const std::string& detail) {
    call->respond(problem({Code::Invalid, name + (" " + detail), {{name, detail}}}));
  };
  if (format != "yaml" && format != "pgm" && format != "pcd") {
    return invalid("format", "must be yaml, pgm or pcd");
  }
  if (!forbidden.empty() && forbidden != "drawn" && forbidden != "left_out") {
    return invalid("forbidden", "must be drawn or left_out");
  }
  context->answer_aside(call, kCells, [&shelf, id, format, drawn = forbidden != "left_out"] {
    return export_response(shelf, id, format, drawn);
  });
}

}  // namespace

void add_map_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  using Shelf = maps::Shelf;
  c->router.add({get, "/maps", {200, 503}, [c](const CallPtr& call) {
                   Shelf* const shelf = c->deps.maps.shelf;
                   if (shelf == nullptr) return call->respond(no_shelf());
                   c->answer_aside(call, kLook, [c, shelf] {
                     return json_response(http::status::ok,
                                          map_list_json(shelf->look(), now_of(*c)));
                   });
                 }});
  c->router.add({post, "/maps", {201, 400, 403, 409, 413, 415, 422, 429, 503}, add(c), kFileBytes});
  c->router.add({post, "/maps/start", {200, 403, 409, 429, 503}, start_making(c)});
  c->router.add(
      {post, "/maps/stop", {201, 204, 400, 403, 409, 413, 415, 422, 429, 503}, stop_making(c)});
  c->router.add({post, "/maps/unuse", {200, 403, 409, 429, 503}, unuse(c)});
  c->router.add({get,
                 "/maps/{id}",
                 {200, 404, 503},
                 with_map(c, [c](const CallPtr& call, Shelf& shelf, std::int64_t id) {
                   c->answer_aside(call, kLook,
                                   [c, &shelf, id] { return map_or_problem(*c, shelf.look(id)); });
                 })});
  c->router.add({http::verb::patch,
                 "/maps/{id}",
                 {200, 400, 403, 404, 409, 413, 415, 422, 429, 503},
                 with_map(c, [c](const CallPtr& call, Shelf& shelf,
                                 std::int64_t id) { patch(c, call, shelf, id); }),
                 kDocumentBytes});
  c->router.add({http::verb::delete_,
                 "/maps/{id}",
                 {204, 400, 403, 404, 409, 429, 503},
                 with_map(c, [c](const CallPtr& call, Shelf& shelf, std::int64_t id) {
                   c->answer_aside(call, kCells, [&shelf, id] {
                     const auto done = shelf.remove(id);
                     return done ? Response{http::status::no_content, 11} : problem(done.error());
                   });
                 })});
  c->router.add({get,
                 "/maps/{id}/cells",
                 {200, 304, 404, 422, 503},
                 with_map(c, [c](const CallPtr& call, Shelf& shelf, std::int64_t id) {
                   cells(c, call, shelf, id);
                 })});
  c->router.add({get,
                 "/maps/{id}/export",
                 {200, 404, 409, 422, 503},
                 with_map(c, [c](const CallPtr& call, Shelf& shelf, std::int64_t id) {
                   export_map(c, call, shelf, id);
                 })});
  c->router.add({post,
                 "/maps/{id}/use",
                 {200, 403, 404, 409, 429, 503},
                 with_map(c, [c](const CallPtr& call, Shelf& shelf, std::int64_t id) {
                   use(c, call, shelf, id);
                 })});
}

}  // namespace roverd::api
