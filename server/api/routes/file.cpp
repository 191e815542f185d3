// Mission files of other programs, in and out.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "api/context.hpp"

namespace roverd::api {

namespace {

base::Error not_a_format(const std::string& word) {
  std::string detail = "\"" + word + "\" is not a known format; known are";
  for (const mission::Format format : mission::kFormats) {
    detail += ' ' + std::string(mission::to_string(format));
  }
  return {base::Code::Invalid, detail, {{"format", detail}}};
}

/// Words, no path: what a person called the file.
std::string file_name(std::string name) {
  if (const auto slash = name.find_last_of("/\\"); slash != std::string::npos) {
    name.erase(0, slash + 1);
  }
  return name;
}

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

/// ?origin_lat=, ?origin_lon= (both or neither) and ?speed_unit=mps|kmh.
base::Result<mission::ImportHints> hints_of(const Call& call) {
  mission::ImportHints hints;
  const auto refuse = [](const char* name, const char* detail) {
    return base::fail(base::Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
  };
  const std::string unit = query_text(call, "speed_unit");
  if (!unit.empty() && unit != "mps" && unit != "kmh") {
    return refuse("speed_unit", "must be mps or kmh");
  }
  hints.kmh = unit == "kmh";
  const std::string lat = query_text(call, "origin_lat");
  const std::string lon = query_text(call, "origin_lon");
  if (lat.empty() && lon.empty()) return hints;
  base::LatLon origin;
  const auto read = [](const std::string& text, double& out) {
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
    return ec == std::errc{} && end == text.data() + text.size();
  };
  if (!read(lat, origin.lat) || !(std::abs(origin.lat) <= 90.0)) {
    return refuse("origin_lat", "must be a latitude in degrees");
  }
  if (!read(lon, origin.lon) || !(std::abs(origin.lon) <= 180.0)) {
    return refuse("origin_lon", "must be a longitude in degrees");
  }
  hints.origin = origin;
  return hints;
}

/// @param fence of the same file, kept already; null: it has none
void keep_mission(const ContextPtr& context, const CallPtr& call,
                  const std::shared_ptr<mission::ImportedFile>& imported,
                  const store::Change& change,
                  const std::shared_ptr<const store::StoredFence>& fence) {
  context->deps.store.create_mission(
      std::move(imported->plan), change,
      [context, call, imported, change, fence](base::Result<store::StoredMission> stored) {
        if (!stored) {
          // Both or neither.
          if (fence)
            context->deps.store.delete_fence(fence->id, fence->revision, change, [](auto) {});
          return call->respond(problem(stored.error()));
        }
        context->announce(stored->id, stored->revision);
        const Effort effort{3 * bytes_of(stored->plan) + 100 * imported->rows.size(), true};
        context->answer_aside(
            call, effort, [file = std::move(*imported), mission = std::move(*stored), fence] {
              Json body = import_json(file, mission);
              body["fence_id"] = fence ? Json(fence->id) : Json(nullptr);
              Response response = json_response(http::status::created, body);
              response.set(http::field::location, "/api/v1/missions/" + mission.id);
              response.set(http::field::etag, etag_of(mission.revision));
              return response;
            });
      });
}

void keep_file(const ContextPtr& context, const CallPtr& call, const std::string& name,
               mission::ImportedFile file) {
  auto imported = std::make_shared<mission::ImportedFile>(std::move(file));
  const std::string from =
      name.empty() ? std::string(mission::to_string(imported->format)) + " file" : name;
  const store::Change change{"local", "imported from " + from};
  if (!imported->fence) return keep_mission(context, call, imported, change, nullptr);
  context->deps.store.create_fence(
      *imported->fence, change,
      [context, call, imported, change](base::Result<store::StoredFence> fence) {
        if (!fence) return call->respond(problem(fence.error()));
        keep_mission(context, call, imported, change,
                     std::make_shared<const store::StoredFence>(std::move(*fence)));
      });
}

Handler import_mission(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const std::string word = query_text(*call, "format");
    const auto format = mission::format_from(word);
    if (!word.empty() && !format) return call->respond(problem(not_a_format(word)));
    if (call->request.body().empty()) {
      return call->respond(problem({base::Code::Malformed, "the file is empty"}));
    }
    const std::string name = file_name(query_text(*call, "name"));
    const auto hints = hints_of(*call);
    if (!hints) return call->respond(problem(hints.error()));
    std::string body = std::move(call->request.body());
    const Effort effort{2 * body.size()};
    context->aside(
        call, effort,
        [body = std::move(body), format, name, hints = *hints] {
          return mission::import_file(body, format, name, hints);
        },
        [context, call, name](base::Result<mission::ImportedFile> file) {
          if (!file) return call->respond(problem(file.error()));
          keep_file(context, call, name, std::move(*file));
        });
  };
}

Response file_response(const store::StoredMission& stored, mission::Format format,
                       const std::shared_ptr<const store::StoredFence>& fence) {
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
    if (!format) return call->respond(problem(not_a_format(word)));
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
                 {201, 400, 403, 413, 415, 422, 429, 503},
                 import_mission(c),
                 kFileBytes});
  c->router.add(
      {http::verb::get, "/missions/{id}/export", {200, 400, 404, 422, 503}, export_mission(c)});
}

}  // namespace roverd::api
