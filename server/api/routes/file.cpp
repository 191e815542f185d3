// Mission files of other programs, in and out.

#include <algorithm>
#include <utility>
#include <vector>

#include "api/context.hpp"
#include "api/import_request.hpp"

namespace roverd::api {

namespace {

/// RFC 6266: a name in ASCII for all, and the mission's own in UTF-8 for those that read it.
std::string attachment(const std::string& ascii, const std::string& name) {
  std::string out = "attachment; filename=\"" + ascii + "\"";
  const std::string whole = name + ascii.substr(ascii.rfind('.'));
  if (whole == ascii) return out;
  out += "; filename*=UTF-8''";
  for (const char c : whole) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    const auto byte = static_cast<unsigned char>(c);
    if (plain) {
      out += c;
    } else if (c == '/' || c == '\\' || byte < 0x20 || byte == 0x7F) {
      out += '_';  // no path, no control characters
    } else {
      constexpr std::string_view kHex = "0123456789ABCDEF";
      out += {'%', kHex[byte >> 4U], kHex[byte & 15U]};
    }
  }
  return out;
}

/// With the first mission's place and tag, or the fence's; 200 where there was nothing to keep.
Response import_response(const mission::ImportedFile& file, const store::StoredImport& kept) {
  const bool none = kept.missions.empty() && !kept.fence;
  Response response =
      json_response(none ? http::status::ok : http::status::created, Json::object());
  response.body() = import_text(file, kept);
  if (!kept.missions.empty()) {
    response.set(http::field::location, "/api/v1/missions/" + kept.missions.front().id);
    response.set(http::field::etag, etag_of(kept.missions.front().revision));
  } else if (kept.fence) {
    response.set(http::field::location, "/api/v1/fences/" + kept.fence->id);
    response.set(http::field::etag, etag_of(kept.fence->revision));
  }
  return response;
}

/// Keeps all that the file holds, or nothing.
void keep_import(const ContextPtr& context, const CallPtr& call, Upload upload) {
  auto file = std::make_shared<mission::ImportedFile>(std::move(upload.file));
  std::vector<mission::Plan> plans;
  if (!file->plan.items.empty()) plans.push_back(std::move(file->plan));
  for (mission::Plan& plan : file->more) plans.push_back(std::move(plan));
  file->more.clear();
  const auto tell = [context, call, file](store::StoredImport kept) {
    std::size_t items = 0;
    for (const auto& mission : kept.missions) items += mission.plan.items.size();
    const Effort effort{100 * (items + file->rows.size()), true};
    context->answer_aside(call, effort, [file = std::move(*file), kept = std::move(kept)] {
      return import_response(file, kept);
    });
  };
  if (plans.empty() && !file->fence) return tell({});
  auto fence = file->fence;
  context->deps.store.create_import(std::move(plans), std::move(fence),
                                    {"local", "imported from " + upload.from},
                                    [context, call, tell](base::Result<store::StoredImport> kept) {
                                      if (!kept) return call->respond(problem(kept.error()));
                                      for (const auto& mission : kept->missions)
                                        context->announce(mission.id, mission.revision);
                                      tell(std::move(*kept));
                                    });
}

/// A file that is kept, or the refusal of one.
struct ReadFile {
  base::Result<Upload> upload;
  std::optional<Rest> rest;
};

ReadFile read_file(const std::string& body, const ImportWish& wish) {
  ReadFile out{read_upload(body, wish), std::nullopt};
  if (!out.upload) out.rest = rest_of(body, wish, out.upload.error());
  return out;
}

Response import_problem(const base::Error& error, const std::optional<Rest>& rest) {
  if (!rest) return problem(error);
  Json body = problem_json(error);
  body["rest"] = {{"taken", rest->taken}, {"changed", rest->changed}, {"left_out", rest->left_out}};
  return problem_response(status_of(error.code), body);
}

Handler import_mission(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    std::string body = std::move(call->request.body());
    const Effort effort{2 * body.size()};
    context->aside(
        call, effort,
        [body = std::move(body), wish = import_wish(*call)] { return read_file(body, wish); },
        [context, call](ReadFile read) {
          if (!read.upload) {
            return call->respond(import_problem(read.upload.error(), read.rest));
          }
          keep_import(context, call, std::move(*read.upload));
        });
  };
}

/// Files of others hold places on the earth. @return what is in the way of that; empty: nothing
std::optional<Response> cannot_be_laid(const mission::Plan& plan) {
  const bool in_map = std::ranges::any_of(plan.items, [](const mission::Item& item) {
    return std::holds_alternative<mission::MapPoint>(item);
  });
  if (!in_map || (plan.frame && plan.frame->lies)) return std::nullopt;
  const std::string map = plan.frame ? " \"" + plan.frame->map + "\"" : "";
  return problem(
      {base::Code::Conflict,
       "the mission's points are metres of the map" + map +
           ", and nobody knows where on the earth that lies; this format holds latitudes "
           "and longitudes. Give the map an anchor, or take the mission as JSON: GET "
           "/missions/{id}",
       {}});
}

Response file_response(const store::StoredMission& stored, mission::Format format,
                       const std::shared_ptr<const store::StoredFence>& fence) {
  if (auto refusal = cannot_be_laid(stored.plan)) return std::move(*refusal);
  mission::ExportedFile file =
      mission::export_file(stored.plan, format, fence ? &fence->fence : nullptr);
  const auto count = [&file](mission::Outcome outcome) {
    return std::to_string(
        std::count_if(file.rows.begin(), file.rows.end(),
                      [outcome](const auto& row) { return row.outcome == outcome; }));
  };
  Response response = text_response(
      http::status::ok, file.binary ? file.media_type : file.media_type + "; charset=utf-8",
      std::move(file.content));
  response.set(http::field::content_disposition, attachment(file.file_name, stored.plan.name));
  response.set(http::field::etag, etag_of(stored.revision));
  // What the format could not hold: never lost in silence.
  response.set("Items-Changed", count(mission::Outcome::Changed));
  response.set("Items-Left-Out", count(mission::Outcome::LeftOut));
  return response;
}

Handler export_mission(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const std::string word = query_text(*call, "format");
    const auto format = mission::format_from(word);
    if (!format || !mission::is_written(*format)) {
      return call->respond(problem(not_a_format(word, true)));
    }
    const std::string with_fence = query_text(*call, "fence");
    if (!with_fence.empty() && with_fence != "active" && with_fence != "none") {
      const char* detail = "must be active or none";
      return call->respond(
          problem({base::Code::Invalid, "fence " + std::string(detail), {{"fence", detail}}}));
    }
    const auto fence = with_fence == "active" ? context->fence : nullptr;
    context->deps.store.read_mission(
        call->params.at("id"),
        [context, call, format, fence](base::Result<store::StoredMission> stored) {
          if (!stored) return call->respond(problem(stored.error()));
          if (auto& frame = stored->plan.frame) frame->lies = context->lies_of(frame->map);
          const Effort effort{2 * bytes_of(stored->plan)};
          context->answer_aside(call, effort,
                                [format = *format, fence, mission = std::move(*stored)] {
                                  return file_response(mission, format, fence);
                                });
        });
  };
}

}  // namespace

void add_file_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/import",
                 {200, 201, 400, 403, 413, 415, 422, 429, 503},
                 import_mission(c),
                 kFileBytes});
  c->router.add({http::verb::get,
                 "/missions/{id}/export",
                 {200, 400, 404, 409, 422, 503},
                 export_mission(c)});
}

}  // namespace roverd::api
