#include "api/import_request.hpp"

#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "api/body.hpp"
#include "api/form_data.hpp"
#include "mission/text.hpp"

namespace roverd::api {

namespace {

using base::Code;
using base::Error;
using base::Result;

constexpr std::string_view kLeaveOut = "leave_out";

/// Words, no path: what a person called the file.
std::string without_folders(std::string name) {
  if (const auto slash = name.find_last_of("/\\"); slash != std::string::npos) {
    name.erase(0, slash + 1);
  }
  return name;
}

/// origin_lat and origin_lon (both or neither), speed_unit=mps|kmh and wrong=refuse|leave_out.
Result<mission::ImportHints> hints_of(const ImportWish& wish) {
  mission::ImportHints hints;
  const auto refuse = [](const char* name, const char* detail) {
    return base::fail(Code::Invalid, std::string(name) + " " + detail, {{name, detail}});
  };
  if (!wish.speed_unit.empty() && wish.speed_unit != "mps" && wish.speed_unit != "kmh") {
    return refuse("speed_unit", "must be mps or kmh");
  }
  hints.kmh = wish.speed_unit == "kmh";
  if (!wish.wrong.empty() && wish.wrong != "refuse" && wish.wrong != kLeaveOut) {
    return refuse("wrong", "must be refuse or leave_out");
  }
  hints.leave_out_wrong = wish.wrong == kLeaveOut;
  if (wish.origin_lat.empty() && wish.origin_lon.empty()) return hints;
  base::LatLon origin;
  const auto read = [](const std::string& text, double& out) {
    const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
    return ec == std::errc{} && end == text.data() + text.size();
  };
  if (!read(wish.origin_lat, origin.lat) || !(std::abs(origin.lat) <= 90.0)) {
    return refuse("origin_lat", "must be a latitude in degrees");
  }
  if (!read(wish.origin_lon, origin.lon) || !(std::abs(origin.lon) <= 180.0)) {
    return refuse("origin_lon", "must be a longitude in degrees");
  }
  hints.origin = origin;
  return hints;
}

/// The member of the wish that a field of a form fills; null: there is none.
std::string* member_of(ImportWish& wish, std::string_view field) {
  if (field == "format") return &wish.format;
  if (field == "name") return &wish.name;
  if (field == "origin_lat") return &wish.origin_lat;
  if (field == "origin_lon") return &wish.origin_lon;
  if (field == "speed_unit") return &wish.speed_unit;
  return field == "wrong" ? &wish.wrong : nullptr;
}

/// The one file of a form; its fields go into the wish.
Result<std::string_view> file_of_form(std::string_view body, std::string_view boundary,
                                      ImportWish& wish) {
  const auto parts = form_parts(body, boundary);
  if (!parts) return tl::unexpected<Error>(parts.error());
  std::vector<const FormPart*> files;
  for (const FormPart& part : *parts) {
    if (part.file_name || part.name == "file") {
      files.push_back(&part);
      continue;
    }
    std::string* const member = member_of(wish, part.name);
    if (member == nullptr) {
      const std::string field = mission::clean_name(part.name, "without a name");
      return base::fail(Code::Invalid, "the form's field \"" + field + "\" is not known",
                        {{field, "is no field of this form"}});
    }
    if (member->empty()) *member = part.content;
  }
  if (files.size() != 1) {
    const std::string detail = files.empty()
                                   ? "has no file: send it as the field \"file\""
                                   : "has " + std::to_string(files.size()) + " files: send one";
    return base::fail(Code::Invalid, "the form " + detail, {{"file", detail}});
  }
  if (wish.name.empty()) wish.name = files.front()->file_name.value_or("");
  return files.front()->content;
}

}  // namespace

Error not_a_format(const std::string& word, bool written) {
  std::string detail = "\"" + mission::clean_name(word, "") + "\" is not a known format; known are";
  for (const mission::Format format : mission::kFormats) {
    if (!written || mission::is_written(format)) {
      detail += ' ' + std::string(mission::to_string(format));
    }
  }
  return {Code::Invalid, detail, {{"format", detail}}};
}

ImportWish import_wish(const Call& call) {
  return {std::string(header(call.request, http::field::content_type)),
          query_text(call, "format"),
          query_text(call, "name"),
          query_text(call, "origin_lat"),
          query_text(call, "origin_lon"),
          query_text(call, "speed_unit"),
          query_text(call, "wrong")};
}

std::optional<Rest> rest_of(std::string_view body, ImportWish wish, const Error& refused) {
  if (refused.code != Code::Invalid || !wish.wrong.empty()) return std::nullopt;
  wish.wrong = kLeaveOut;
  const auto upload = read_upload(body, std::move(wish));
  if (!upload) return std::nullopt;
  Rest rest;
  for (const mission::FileRow& row : upload->file.rows) {
    const bool taken = row.outcome == mission::Outcome::Taken;
    const bool changed = row.outcome == mission::Outcome::Changed;
    (taken ? rest.taken : changed ? rest.changed : rest.left_out) += 1;
  }
  return rest;
}

Result<Upload> read_upload(std::string_view body, ImportWish wish) {
  const auto boundary = form_boundary(wish.content_type);
  if (!boundary) return tl::unexpected<Error>(boundary.error());
  Result<std::string_view> content = body;
  if (*boundary) content = file_of_form(body, **boundary, wish);
  if (!content) return tl::unexpected<Error>(content.error());
  const auto format = mission::format_from(wish.format);
  if (!wish.format.empty() && !format) {
    return tl::unexpected<Error>(not_a_format(wish.format, false));
  }
  if (content->empty()) return base::fail(Code::Malformed, "the file is empty");
  const auto hints = hints_of(wish);
  if (!hints) return tl::unexpected<Error>(hints.error());
  const std::string name = without_folders(std::move(wish.name));
  auto file = mission::import_file(*content, format, name, *hints);
  if (!file) return tl::unexpected<Error>(file.error());
  std::string from =
      mission::clean_name(name, std::string(mission::to_string(file->format)) + " file");
  return Upload{std::move(*file), std::move(from)};
}

}  // namespace roverd::api
