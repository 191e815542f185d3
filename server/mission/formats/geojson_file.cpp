// GeoJSON (RFC 7946): LineString, MultiLineString; without one, Point and MultiPoint; alone, in a
// Feature, a FeatureCollection or a GeometryCollection. Positions are longitude, latitude and
// perhaps a height. Each line is a way of its own, unless it is of one Feature with the one before
// it and begins where that ends. Polygons are areas that can be covered, or fences if they say so
// (see geojson_fence.hpp). A `crs` (of the 2008 specification) must be WGS84.
//
// Written as one Feature with a LineString (a MultiPoint below two positions). What RFC 7946 has no
// place for stands in the Feature's property "waypoints": one object for each position, with the
// members that a waypoint has beside its position; other programs pass over it.

#include <utility>

#include "mission/formats/field_area.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/geojson_fence.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

namespace {

using base::Error;
using base::Result;
using nlohmann::json;

constexpr int kMaxDepth = 16;

/// Of the specification of 2008: {"type": "name", "properties": {"name": …}}, or as older
/// programs wrote it {"type": "EPSG", "properties": {"code": 4326}}. Axes are longitude, latitude
/// in both.
bool is_wgs84(const json& crs) {
  const auto properties = crs.is_object() ? crs.find("properties") : crs.end();
  if (!crs.is_object() || properties == crs.end() || !properties->is_object()) return false;
  if (const auto code = properties->find("code"); code != properties->end()) {
    return *code == 4326 || *code == "4326";
  }
  const auto name = properties->find("name");
  if (name == properties->end() || !name->is_string()) return false;
  std::string word = name->get<std::string>();
  for (char& c : word) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  // "urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "http://www.opengis.net/def/crs/EPSG/0/4326"
  const std::string last = word.substr(word.find_last_of(":/") + 1);
  if (last == "crs84" || last == "crs84h" || last == "wgs84") return true;
  const bool epsg = word.find("epsg") != std::string::npos;
  return epsg && (last == "4326" || last == "4979");
}

class GeoJsonReader {
 public:
  explicit GeoJsonReader(bool leave_out_wrong) : builder_(file_, problems_, leave_out_wrong) {}

  Result<ImportedFile> read(std::string_view content) {
    auto document = parse_json(content);
    if (!document) {
      Error error = std::move(document.error());
      if (error.code == base::Code::Malformed) error.code = base::Code::Invalid;  // the file is
      return tl::unexpected<Error>(std::move(error));
    }
    object(*document, "", kMaxDepth);
    if (!fence_.areas.empty() || !fence_.rally.empty()) file_.fence = std::move(fence_);
    if (file_.plan.name.empty() && builder_.count() == 0) file_.plan.name = first_name_;
    return std::move(builder_).finish();
  }

 private:
  static std::string text_of(const json& value, const char* name) {
    const auto at = value.find(name);
    return at != value.end() && at->is_string() ? at->get<std::string>() : std::string();
  }

  static bool says_fence(const json& properties) {
    const std::string kind = text_of(properties, "fence");
    return kind == "inclusion" || kind == "exclusion";
  }

  void object(const json& value, const std::string& where, int depth) {
    if (!value.is_object()) return problems_.add(where, "must be an object");
    if (depth == 0) return problems_.add(where, "is nested too deeply");
    if (const auto crs = value.find("crs"); crs != value.end() && !is_wgs84(*crs)) {
      return problems_.add(where + "/crs", "must be WGS84 (CRS84, EPSG:4326), as RFC 7946 has it");
    }
    const std::string type = text_of(value, "type");
    if (type == "FeatureCollection") {
      if (file_.plan.name.empty()) file_.plan.name = text_of(value, "name");
      return each(value, "features", where, depth);
    }
    if (type == "GeometryCollection") return each(value, "geometries", where, depth);
    if (type == "Feature") return feature(value, where, depth);
    geometry(value, type, where);
  }

  void each(const json& value, const char* name, const std::string& where, int depth) {
    const auto list = value.find(name);
    const std::string pointer = where + '/' + name;
    if (list == value.end() || !list->is_array()) return problems_.add(pointer, "must be a list");
    for (std::size_t i = 0; i < list->size(); ++i) {
      object((*list)[i], pointer + '/' + std::to_string(i), depth - 1);
    }
  }

  void feature(const json& value, const std::string& where, int depth) {
    const auto shape = value.find("geometry");
    const auto properties = value.find("properties");
    const bool has_properties = properties != value.end() && properties->is_object();
    if (shape == value.end() || shape->is_null()) {
      if (has_properties && says_fence(*properties)) {
        return problems_.add(where, "must be a Polygon, or a Point with radius_m, to be a fence");
      }
      if (has_properties && properties->value("rally", json()) == true) {
        return problems_.add(where, "must be a Point to be a rally point");
      }
      return builder_.leave_out(where, "Feature", "it has no geometry");
    }
    if (has_properties && take_fence_feature(*properties, *shape, {where, where + "/geometry"},
                                             fence_, file_.rows, problems_)) {
      return;
    }
    name_ = has_properties ? text_of(*properties, "name") : std::string();
    if (first_name_.empty()) first_name_ = name_;
    const std::size_t before = builder_.count();
    const bool own = has_properties && properties->contains("waypoints");
    builder_.keep_each(own);
    object(*shape, where + "/geometry", depth - 1);
    builder_.keep_each(false);
    builder_.end_whole(name_);
    if (own) take_waypoints(*properties, where + "/properties/waypoints", before);
    name_.clear();
  }

  /// The property of our own files: what the positions from item `before` on have beside them.
  void take_waypoints(const json& properties, const std::string& where, std::size_t before) {
    const auto list = properties.find("waypoints");
    if (list == properties.end()) return;
    if (!list->is_array() || list->size() != builder_.count() - before) {
      return builder_.leave_out(where, "waypoints", "not one object for each position");
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      json item = (*list)[i];
      Waypoint& waypoint = builder_.point(before + i);
      if (!item.is_object()) {
        problems_.add(where + '/' + std::to_string(i), "must be an object");
        continue;
      }
      item["type"] = "waypoint";
      item["lat"] = waypoint.at.lat;
      item["lon"] = waypoint.at.lon;
      if (waypoint.alt_m) item["alt_m"] = *waypoint.alt_m;
      const auto read = item_from_json(item, where + '/' + std::to_string(i));
      if (read) {
        waypoint = std::get<Waypoint>(*read);
      } else {
        for (const auto& [pointer, detail] : read.error().fields) problems_.add(pointer, detail);
      }
    }
  }

  void geometry(const json& value, const std::string& type, const std::string& where) {
    const auto coordinates = value.find("coordinates");
    const std::string pointer = where + "/coordinates";
    const bool known = type == "Point" || type == "MultiPoint" || type == "LineString" ||
                       type == "MultiLineString" || type == "Polygon" || type == "MultiPolygon";
    if (!known) return problems_.add(where + "/type", "is no type of GeoJSON");
    if (coordinates == value.end() || !coordinates->is_array()) {
      return problems_.add(pointer, "must be a list");
    }
    if (coordinates->empty()) {
      return builder_.leave_out(where, type, "it has no coordinates");
    }
    if (type == "Polygon") return area(*coordinates, pointer, where);
    if (type == "Point" || type == "MultiPoint") {
      builder_.begin(PartKind::Points);
      return type == "Point" ? position(*coordinates, pointer) : positions(*coordinates, pointer);
    }
    if (type == "LineString") return line(*coordinates, pointer);
    for (std::size_t i = 0; i < coordinates->size(); ++i) {
      const std::string each = pointer + '/' + std::to_string(i);
      if (type == "MultiPolygon") {
        area((*coordinates)[i], each, each);
      } else {
        line((*coordinates)[i], each);
      }
    }
  }

  void line(const json& list, const std::string& where) {
    builder_.begin(PartKind::Line);
    positions(list, where);
  }

  /// @param rings lists of positions @param row for its account
  void area(const json& rings, const std::string& where, const std::string& row) {
    if (!rings.is_array()) return problems_.add(where, "must be a list of rings");
    FieldArea out{name_, row, {}};
    for (std::size_t r = 0; r < rings.size(); ++r) {
      const std::string ring_at = where + '/' + std::to_string(r);
      if (!rings[r].is_array()) return problems_.add(ring_at, "must be a list of positions");
      auto& ring = out.rings.emplace_back();
      for (std::size_t i = 0; i < rings[r].size(); ++i) {
        const json& at = rings[r][i];
        if (!is_position(at)) {
          return problems_.add(ring_at + '/' + std::to_string(i), kNoPosition);
        }
        ring.push_back({at[1].get<double>(), at[0].get<double>()});
      }
    }
    take_field_area(std::move(out), "Polygon", file_, problems_);
  }

  void positions(const json& list, const std::string& where) {
    if (!list.is_array()) return problems_.add(where, "must be a list");
    for (std::size_t i = 0; i < list.size(); ++i) {
      position(list[i], where + '/' + std::to_string(i));
    }
  }

  static constexpr const char* kNoPosition = "must be [longitude, latitude] or with a height";

  static bool is_position(const json& value) {
    bool good = value.is_array() && value.size() >= 2;
    for (std::size_t i = 0; good && i < value.size() && i < 3; ++i) good = value[i].is_number();
    return good;
  }

  void position(const json& value, std::string where) {
    if (!is_position(value)) return builder_.refuse(std::move(where), "position", kNoPosition);
    TrackPoint point{std::move(where), "position", value[1].get<double>(), value[0].get<double>()};
    if (value.size() > 2) point.alt_m = value[2].get<double>();
    if (value.size() > 3) {
      point.note = "of its " + std::to_string(value.size()) + " numbers the first three are kept";
    }
    builder_.add(std::move(point));
  }

  std::string name_;        ///< of the open Feature
  std::string first_name_;  ///< of the first Feature that has one
  ImportedFile file_;
  Fence fence_;
  Problems problems_;
  TrackBuilder builder_;
};

}  // namespace

Result<ImportedFile> read_geojson(std::string_view content, const ImportHints& hints) {
  return GeoJsonReader(hints.leave_out_wrong).read(without_bom(content));
}

std::string write_geojson(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows) {
  std::vector<FileRow> all;
  report_left_out(plan, {true, true}, all);
  for (FileRow& row : all) {
    if (row.what != "waypoint") rows.push_back(std::move(row));  // those are whole
  }
  json coordinates = json::array();
  json settings = json::array();
  bool any = false;
  for (const Waypoint& point : positions_of(plan)) {
    json position = {point.at.lon, point.at.lat};
    if (point.alt_m) position.push_back(*point.alt_m);
    coordinates.push_back(std::move(position));
    json more = item_to_json(point);
    for (const char* name : {"type", "lat", "lon", "alt_m"}) more.erase(name);
    any = any || !more.empty();
    settings.push_back(std::move(more));
  }
  json properties = {{"name", plan.name}};
  if (any) properties["waypoints"] = std::move(settings);
  const bool line = coordinates.size() >= 2;
  json document = {{"type", "FeatureCollection"},
                   {"features",
                    {{{"type", "Feature"},
                      {"properties", std::move(properties)},
                      {"geometry",
                       {{"type", line ? "LineString" : "MultiPoint"},
                        {"coordinates", std::move(coordinates)}}}}}}};
  if (fence != nullptr) {
    for (json& feature : fence_features(*fence)) document["features"].push_back(std::move(feature));
  }
  return document.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace roverd::mission
