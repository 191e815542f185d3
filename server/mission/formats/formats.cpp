#include "mission/formats/formats.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "mission/formats/encoding.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/json/json.hpp"
#include "mission/text.hpp"

namespace roverd::mission {
namespace {

using base::Code;
using base::Error;
using base::Result;

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view base_name(std::string_view file_name) {
  const std::size_t slash = file_name.find_last_of("/\\");
  return slash == std::string_view::npos ? file_name : file_name.substr(slash + 1);
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::string_view without_ending(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos || dot == 0 ? name : name.substr(0, dot);
}

/// Is anything of it a way?
bool drives(const Plan& plan) {
  return std::any_of(plan.items.begin(), plan.items.end(), [](const Item& item) {
    return std::holds_alternative<Waypoint>(item) || std::holds_alternative<Local>(item) ||
           std::holds_alternative<Move>(item) || std::holds_alternative<TurnBy>(item) ||
           std::holds_alternative<Row>(item) || std::holds_alternative<Wall>(item) ||
           std::holds_alternative<Landmarks>(item) || std::holds_alternative<Dock>(item) ||
           std::holds_alternative<ReturnHome>(item) || std::holds_alternative<Circle>(item) ||
           std::holds_alternative<MapPoint>(item) || place_of(item).has_value();
  });
}

/// Nothing to drive is no mission: what was taken for it is not.
void drop_plan(ImportedFile& file) {
  for (FileRow& row : file.rows) {
    const bool of_plan = row.item || row.what == "home" || row.what == "cruise speed";
    if (!of_plan || row.outcome == Outcome::LeftOut) continue;
    row.item.reset();
    row.outcome = Outcome::LeftOut;
    row.reason = "there is nothing to drive, so there is no mission that it could belong to";
  }
  std::string name = std::move(file.plan.name);
  file.plan = Plan{};
  file.plan.name = std::move(name);
}

/// One mission is called as the file; of several each has its own name behind that.
void name_missions(ImportedFile& file, std::string_view file_name) {
  const std::string own = file.more.empty() ? file.plan.name : file.name;
  const std::string base =
      clean_name(without_ending(base_name(file_name)), clean_name(own, "Imported mission"));
  if (file.more.empty()) {
    file.plan.name = base;
    return;
  }
  std::map<std::string, int> used;
  const auto name = [&](Plan& plan) {
    const std::string part = clean_name(plan.name, "");
    plan.name = part.empty() || part == base ? base : clean_name(base + ": " + part, base);
    const int number = ++used[plan.name];
    if (number > 1) {
      plan.name = name_with_ending(plan.name, " (" + std::to_string(number) + ")");
    }
  };
  name(file.plan);
  for (Plan& plan : file.more) name(plan);
  file.name = base;
}

Result<void> check_missions(ImportedFile& file) {
  if (!drives(file.plan)) {
    if (!file.fence && file.areas.empty()) {
      const char* detail = "has nothing to drive";
      std::string why = "the file " + std::string(detail);
      const auto lost = std::find_if(file.rows.begin(), file.rows.end(), [](const FileRow& row) {
        return row.outcome == Outcome::LeftOut && !row.reason.empty();
      });
      if (lost != file.rows.end())
        why += ": " + lost->row + ", " + lost->what + ": " + lost->reason;
      return base::fail(Code::Invalid, why, {{"", detail}});
    }
    drop_plan(file);
  } else if (auto ok = check_plan(file.plan); !ok) {
    return ok;
  }
  for (const Plan& plan : file.more) {
    if (auto ok = check_plan(plan); !ok) return ok;
  }
  return {};
}

std::string ending_of(Format format) {
  return format == Format::Follower ? "csv" : std::string(to_string(format));
}

Result<ImportedFile> read_as(std::string_view content, Format format, const ImportHints& hints) {
  switch (format) {
    case Format::Plan:
      return read_qgc_plan(content);
    case Format::Waypoints:
      return read_waypoints(content);
    case Format::Gpx:
      return read_gpx(content, hints);
    case Format::Kml:
      return read_kml(content, hints);
    case Format::Kmz:
      return read_kmz(content, hints);
    case Format::GeoJson:
      return read_geojson(content, hints);
    case Format::Csv:
    case Format::Follower:
      return read_csv(content, hints);
    case Format::Fence:
      return read_fence_text(content);
  }
  return read_csv(content, hints);
}

}  // namespace

std::string_view to_string(Format format) noexcept {
  switch (format) {
    case Format::Plan:
      return "plan";
    case Format::Waypoints:
      return "waypoints";
    case Format::Gpx:
      return "gpx";
    case Format::Kml:
      return "kml";
    case Format::Kmz:
      return "kmz";
    case Format::GeoJson:
      return "geojson";
    case Format::Csv:
      return "csv";
    case Format::Follower:
      return "follower";
    case Format::Fence:
      return "fence";
  }
  return "plan";
}

bool is_written(Format format) noexcept {
  return format != Format::Fence;
}

std::optional<Format> format_from(std::string_view word) noexcept {
  for (const Format format : kFormats) {
    if (to_string(format) == word) return format;
  }
  return std::nullopt;
}

std::string_view to_string(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::Taken:
      return "taken";
    case Outcome::Changed:
      return "changed";
    case Outcome::LeftOut:
      return "left_out";
  }
  return "left_out";
}

namespace {

/// Does an element of that name begin, with a namespace's prefix or without?
bool has_element(std::string_view xml, std::string_view name) {
  for (std::size_t at = xml.find(name); at != std::string_view::npos; at = xml.find(name, at + 1)) {
    std::size_t begin = at;
    if (begin > 0 && xml[begin - 1] == ':') {
      --begin;
      while (begin > 0 && xml[begin - 1] != '<' && xml[begin - 1] > ' ') --begin;
    }
    const std::size_t end = at + name.size();
    if (begin == 0 || xml[begin - 1] != '<') continue;
    if (end == xml.size() || xml[end] <= ' ' || xml[end] == '>' || xml[end] == '/') return true;
  }
  return false;
}

/// Of a plan that counts from a map: where that lies is known.
ExportedFile export_laid(const Plan& plan, Format format, const Fence* fence) {
  ExportedFile file = export_file(laid_on_earth(plan, *plan.frame->lies), format, fence);
  std::unordered_map<std::string, std::size_t> told;  // the first row of each item
  for (std::size_t i = 0; i < file.rows.size(); ++i) told.try_emplace(file.rows[i].row, i);
  for (std::size_t i = 0; i < plan.items.size(); ++i) {
    const auto* point = std::get_if<MapPoint>(&plan.items[i]);
    if (point == nullptr) continue;
    const std::string row = "/items/" + std::to_string(i);
    const std::string reason = "a point of the map \"" + plan.frame->map +
                               "\", written as a waypoint where that lies by now" +
                               (point->yaw_deg ? "; its heading is lost" : "");
    const auto at = told.find(row);
    if (at == told.end()) {
      file.rows.push_back({row, "map_point", Outcome::Changed, reason, static_cast<int>(i) + 1});
    } else {
      FileRow& of_waypoint = file.rows[at->second];
      of_waypoint.what = "map_point";
      of_waypoint.reason = reason + (of_waypoint.reason.empty() ? "" : "; " + of_waypoint.reason);
    }
  }
  return file;
}

}  // namespace

std::optional<Format> detect_format(std::string_view raw, std::string_view file_name) {
  if (raw.starts_with("PK\x03\x04")) return Format::Kmz;
  const Utf8Text decoded(raw);
  const std::string_view content = without_bom(decoded.text());
  const std::size_t start = content.find_first_not_of(kBlanks);
  const std::string_view text =
      start == std::string_view::npos ? std::string_view{} : content.substr(start);
  if (text.starts_with("QGC WPL")) return Format::Waypoints;
  if (text.starts_with('{') && text.find("\"fileType\"") != std::string_view::npos) {
    return Format::Plan;
  }
  if (text.starts_with('{') && text.find("\"type\"") != std::string_view::npos) {
    return Format::GeoJson;
  }
  if (text.starts_with('<')) {
    if (has_element(text, "gpx")) return Format::Gpx;
    if (has_element(text, "kml")) return Format::Kml;
  }
  if (looks_like_fence_text(text)) return Format::Fence;
  const std::string name = lower(file_name);
  if (name.ends_with(".fen") || name.ends_with(".ral")) return Format::Fence;
  for (const Format format : kFormats) {
    if (name.ends_with('.' + ending_of(format))) return format;
  }
  return looks_like_csv(content) ? std::optional(Format::Csv) : std::nullopt;
}

Result<ImportedFile> import_file(std::string_view content, std::optional<Format> format,
                                 std::string_view file_name, const ImportHints& hints) {
  const Utf8Text decoded(content);
  if (!format) format = detect_format(decoded.text(), file_name);
  if (!format) {
    return base::fail(Code::Unsupported,
                      "none of .plan, .waypoints, GPX, KML, KMZ, GeoJSON and a table of positions");
  }
  Result<ImportedFile> file = read_as(decoded.text(), *format, hints);
  if (!file) return file;
  file->format = *format;
  name_missions(*file, file_name);
  if (auto ok = check_missions(*file); !ok) return tl::unexpected<Error>(ok.error());
  const std::string& name = file->more.empty() ? file->plan.name : file->name;
  for (FieldArea& area : file->areas) area.name = clean_name(area.name, name);
  if (file->fence) {
    file->fence->name = name;
    if (auto ok = check_fence(*file->fence); !ok) return tl::unexpected<Error>(ok.error());
  }
  return file;
}

std::string file_stem(std::string_view name, std::string_view otherwise) {
  constexpr std::size_t kMax = 80;
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    if (plain) {
      out += c;
    } else if (!out.empty() && out.back() != '_') {
      out += '_';
    }
    if (out.size() == kMax) break;
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.empty() ? std::string(otherwise) : out;
}

ExportedFile export_file(const Plan& plan, Format format, const Fence* fence) {
  if (plan.frame && plan.frame->lies) return export_laid(plan, format, fence);
  ExportedFile file;
  file.file_name = file_stem(plan.name) + '.' + ending_of(format);
  switch (format) {
    case Format::Plan:
      file.content = write_qgc_plan(plan, fence, file.rows);
      file.media_type = "application/json";
      break;
    case Format::Waypoints:
      file.content = write_waypoints(plan, file.rows);
      file.media_type = "text/plain";
      break;
    case Format::Gpx:
      file.content = write_gpx(plan, file.rows);
      file.media_type = "application/gpx+xml";
      break;
    case Format::Kml:
      file.content = write_kml(plan, fence, file.rows);
      file.media_type = "application/vnd.google-earth.kml+xml";
      break;
    case Format::Kmz:
      file.content = write_kmz(plan, fence, file.rows);
      file.media_type = "application/vnd.google-earth.kmz";
      file.binary = true;
      break;
    case Format::GeoJson:
      file.content = write_geojson(plan, fence, file.rows);
      file.media_type = "application/geo+json";
      break;
    case Format::Csv:
      file.content = write_csv(plan, file.rows);
      file.media_type = "text/csv";
      break;
    case Format::Follower:
      file.content = write_follower(plan, file.rows);
      file.media_type = "text/csv";
      break;
    case Format::Fence:
      break;  // read only
  }
  const bool holds_fences = format == Format::Plan || format == Format::GeoJson ||
                            format == Format::Kml || format == Format::Kmz;
  if (fence != nullptr && !holds_fences) {
    file.rows.push_back(
        {"", "fence", Outcome::LeftOut, "this format has no place for fences", std::nullopt});
  }
  return file;
}

}  // namespace roverd::mission
