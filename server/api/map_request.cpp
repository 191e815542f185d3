#include "api/map_request.hpp"

#include <cstdint>
#include <optional>
#include <utility>

#include "api/body.hpp"
#include "api/form_data.hpp"
#include "mission/text.hpp"

namespace roverd::api {

namespace {

using base::Code;
using base::Error;
using base::Result;

auto refuse(const std::string& pointer, const std::string& detail) {
  return base::fail(Code::Invalid, pointer.substr(1) + " " + detail, {{pointer, detail}});
}

/// "maps/shed.yaml" → "shed".
std::string bare_name(std::string name) {
  if (const auto slash = name.find_last_of("/\\"); slash != std::string::npos) {
    name.erase(0, slash + 1);
  }
  if (const auto dot = name.rfind('.'); dot != std::string::npos && dot > 0) name.erase(dot);
  return name;
}

/// The form's parts, each at most once.
struct Parts {
  std::optional<std::string_view> yaml;
  std::optional<std::string_view> image;
  std::optional<std::string_view> cloud;
  std::optional<std::string_view> name;
  std::string file;  ///< of the yaml, or of the cloud
};

Result<Parts> parts_of(std::string_view body, std::string_view boundary) {
  const auto parts = form_parts(body, boundary);
  if (!parts) return tl::unexpected<Error>(parts.error());
  Parts out;
  for (const FormPart& part : *parts) {
    auto* const place = part.name == "yaml"    ? &out.yaml
                        : part.name == "image" ? &out.image
                        : part.name == "cloud" ? &out.cloud
                        : part.name == "name"  ? &out.name
                                               : nullptr;
    const std::string field = "/" + mission::clean_name(part.name, "without a name");
    if (place == nullptr) return refuse(field, "is no field of this form");
    if (*place) return refuse(field, "comes twice");
    *place = part.content;
    if (place == &out.yaml || place == &out.cloud) out.file = part.file_name.value_or("");
  }
  if (out.cloud) {
    if (out.yaml) return refuse("/yaml", "comes beside a cloud: one of both is the map");
    if (out.image) return refuse("/image", "comes beside a cloud: one of both is the map");
    return out;
  }
  if (!out.yaml) return refuse("/yaml", "is missing: the map's .yaml");
  if (!out.image) return refuse("/image", "is missing: the map's .pgm");
  return out;
}

std::optional<std::string> problem_with(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  std::string problem = mission::name_problem(*name);
  return problem.empty() ? std::nullopt : std::optional(std::move(problem));
}

/// [{x_m, y_m}, …]
Result<maps::Area> area_from(const Json& json, const std::string& pointer) {
  const std::string wrong =
      "must be 3 to " + std::to_string(maps::kMostCorners) + " corners {x_m, y_m}";
  if (!json.is_array() || json.size() < 3 || json.size() > maps::kMostCorners) {
    return refuse(pointer, wrong);
  }
  maps::Area area;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string at = pointer + "/" + std::to_string(i);
    if (!json[i].is_object()) return refuse(at, "must be a corner {x_m, y_m}");
    Members members(json[i], at);
    members.require("x_m");
    members.require("y_m");
    const auto x_m = members.number("x_m", -maps::kFarthest_m, maps::kFarthest_m);
    const auto y_m = members.number("y_m", -maps::kFarthest_m, maps::kFarthest_m);
    if (auto read = members.finish("the corner"); !read) {
      return tl::unexpected<Error>(read.error());
    }
    area.push_back({*x_m, *y_m});
  }
  return area;
}

Result<maps::Edit> edit_from(const Json& json, const std::string& pointer) {
  if (!json.is_object()) return refuse(pointer, "must be an edit {kind, polygon}");
  Members members(json, pointer);
  members.require("kind");
  members.require("polygon");
  const auto kind = members.text("kind");
  const Json* const polygon = members.any("polygon");
  if (kind && *kind != "erase" && *kind != "wall" && *kind != "forbid") {
    members.complain("kind", "must be erase, wall or forbid");
  }
  if (auto read = members.finish("the edit"); !read) return tl::unexpected<Error>(read.error());
  auto area = area_from(*polygon, pointer + "/polygon");
  if (!area) return tl::unexpected<Error>(area.error());
  using Kind = maps::Edit::Kind;
  return maps::Edit{*kind == "erase"  ? Kind::Erase
                    : *kind == "wall" ? Kind::Wall
                                      : Kind::Forbid,
                    std::move(*area)};
}

Result<maps::Anchor> anchor_from(const Json& json) {
  if (!json.is_object()) return refuse("/anchor", "must be {lat, lon, heading_deg, …}, or null");
  Members members(json, "/anchor");
  for (const char* name : {"lat", "lon", "heading_deg"}) members.require(name);
  maps::Anchor out;
  out.at.lat = members.number("lat", -90.0, 90.0).value_or(0.0);
  out.at.lon = members.number("lon", -180.0, 180.0).value_or(0.0);
  out.heading_deg = members.number("heading_deg", 0.0, 360.0).value_or(0.0);
  out.accuracy_m = members.number("accuracy_m", 0.0, 10.0).value_or(out.accuracy_m);
  out.heading_accuracy_deg =
      members.number("heading_accuracy_deg", 0.0, 45.0).value_or(out.heading_accuracy_deg);
  if (auto read = members.finish("the anchor"); !read) return tl::unexpected<Error>(read.error());
  return out;
}

/// Of an array: one by one.
template <class T, class Read>
Result<std::vector<T>> list_from(const Json& json, const std::string& pointer, std::size_t most,
                                 Read read) {
  if (!json.is_array() || json.size() > most) {
    return refuse(pointer, "must be an array of at most " + std::to_string(most));
  }
  std::vector<T> out;
  for (std::size_t i = 0; i < json.size(); ++i) {
    auto one = read(json[i], pointer + "/" + std::to_string(i));
    if (!one) return tl::unexpected<Error>(one.error());
    out.push_back(std::move(*one));
  }
  return out;
}

}  // namespace

namespace {

/// A cloud's body goes before its cells are drawn and written: both beside it would be too much.
Result<maps::Upload> upload_of(const Parts& parts, std::string& body) {
  if (!parts.cloud) return maps::read_upload(*parts.yaml, *parts.image);
  auto read = maps::read_cloud(*parts.cloud);
  std::string().swap(body);
  if (!read) return tl::unexpected<Error>(read.error());
  return maps::solid_upload(std::move(*read));
}

}  // namespace

Result<MapForm> read_map_form(std::string body, std::string_view content_type) {
  const auto boundary = form_boundary(content_type);
  if (!boundary) return tl::unexpected<Error>(boundary.error());
  if (!*boundary) {
    return base::fail(Code::Unsupported,
                      "a map comes as multipart/form-data: curl -F yaml=@shed.yaml "
                      "-F image=@shed.pgm, or -F cloud=@yard.pcd");
  }
  const auto parts = parts_of(body, **boundary);
  if (!parts) return tl::unexpected<Error>(parts.error());
  std::optional<std::string> name;
  if (parts->name) name = std::string(*parts->name);
  if (const auto problem = problem_with(name)) return refuse("/name", *problem);
  const std::string of_file = mission::clean_name(bare_name(parts->file), "Map");
  auto upload = upload_of(*parts, body);
  if (!upload) return tl::unexpected<Error>(upload.error());
  const auto if_taken = name ? maps::IfTaken::Refuse : maps::IfTaken::Number;
  if (!name) name = mission::clean_name(upload->name, of_file);
  return MapForm{std::move(*name), if_taken, std::move(*upload)};
}

Result<StopMaking> read_stop_making(const Json& body) {
  Members members(body);
  const auto name = members.text("name");
  if (const auto problem = problem_with(name)) members.complain("name", *problem);
  const bool discard = members.flag("discard").value_or(false);
  if (auto read = members.finish(); !read) return tl::unexpected<Error>(read.error());
  return StopMaking{name.value_or("Map"), name ? maps::IfTaken::Refuse : maps::IfTaken::Number,
                    discard};
}

Result<maps::Change> read_map_change(const Json& body) {
  Members members(body);
  maps::Change out;
  out.of_revision = members.whole("revision", 1, std::int64_t{1} << 53);
  out.name = members.text("name");
  if (const auto problem = problem_with(out.name)) members.complain("name", *problem);
  const Json* const anchor = members.known("anchor");
  const Json* const forbidden = members.any("forbidden");
  const Json* const edits = members.any("edits");
  if (auto read = members.finish(); !read) return tl::unexpected<Error>(read.error());
  if (anchor != nullptr) {
    out.changes_anchor = true;
    if (!anchor->is_null()) {
      const auto read = anchor_from(*anchor);
      if (!read) return tl::unexpected<Error>(read.error());
      out.anchor = *read;
    }
  }
  if (forbidden != nullptr) {
    auto read = list_from<maps::Area>(*forbidden, "/forbidden", maps::kMostForbidden, area_from);
    if (!read) return tl::unexpected<Error>(read.error());
    out.forbidden = std::move(*read);
  }
  if (edits != nullptr) {
    auto read = list_from<maps::Edit>(*edits, "/edits", maps::kMostEdits, edit_from);
    if (!read) return tl::unexpected<Error>(read.error());
    out.edits = std::move(*read);
  }
  return out;
}

}  // namespace roverd::api
