// GeoJSON (RFC 7946): LineString, MultiLineString, Point, MultiPoint, alone, in a Feature, a
// FeatureCollection or a GeometryCollection. Positions are longitude, latitude and perhaps a
// height. Areas are no way to drive: left out, unless they say that they are a fence.
//
// Written as one Feature with a LineString (a MultiPoint below two positions). What RFC 7946 has no
// place for stands in the Feature's property "waypoints": one object for each position, with the
// members that a waypoint has beside its position; other programs pass over it.

#include <utility>

#include "mission/formats/file_formats.hpp"
#include "mission/formats/geojson_fence.hpp"
#include "mission/formats/track_points.hpp"

namespace roverd::mission {

namespace {

using base::Error;
using base::Result;
using nlohmann::json;

constexpr int kMaxDepth = 16;

class GeoJsonReader {
 public:
  Result<ImportedFile> read(std::string_view content) {
    auto document = parse_json(content);
    if (!document) {
      Error error = std::move(document.error());
      error.code = base::Code::Invalid;  // of the file, not of the request
      return tl::unexpected<Error>(std::move(error));
    }
    object(*document, "", kMaxDepth);
    if (!fence_.areas.empty() || !fence_.rally.empty()) file_.fence = std::move(fence_);
    return std::move(builder_).finish();
  }

 private:
  static std::string text_of(const json& value, const char* name) {
    const auto at = value.find(name);
    return at != value.end() && at->is_string() ? at->get<std::string>() : std::string();
  }

  void object(const json& value, const std::string& where, int depth) {
    if (!value.is_object()) return problems_.add(where, "must be an object");
    if (depth == 0) return problems_.add(where, "is nested too deeply");
    const std::string type = text_of(value, "type");
    if (type == "FeatureCollection") {
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
    if (shape == value.end() || shape->is_null()) {
      return builder_.leave_out(where, "Feature", "it has no geometry");
    }
    const auto properties = value.find("properties");
    const bool has_properties = properties != value.end() && properties->is_object();
    if (has_properties && take_fence_feature(*properties, *shape, {where, where + "/geometry"},
                                             fence_, file_.rows, problems_)) {
      return;
    }
    if (has_properties && file_.plan.name.empty()) file_.plan.name = text_of(*properties, "name");
    const std::size_t before = file_.plan.items.size();
    object(*shape, where + "/geometry", depth - 1);
    if (has_properties) take_waypoints(*properties, where + "/properties/waypoints", before);
  }

  /// The property of our own files: what the positions from item `before` on have beside them.
  void take_waypoints(const json& properties, const std::string& where, std::size_t before) {
    const auto list = properties.find("waypoints");
    if (list == properties.end()) return;
    if (!list->is_array() || list->size() != file_.plan.items.size() - before) {
      return builder_.leave_out(where, "waypoints", "not one object for each position");
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      json item = (*list)[i];
      auto& waypoint = std::get<Waypoint>(file_.plan.items[before + i]);
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
    if (type == "Polygon" || type == "MultiPolygon") {
      return builder_.leave_out(where, type, "an area is no way to drive");
    }
    const bool known = type == "Point" || type == "MultiPoint" || type == "LineString" ||
                       type == "MultiLineString";
    if (!known) return problems_.add(where + "/type", "is no type of GeoJSON");
    if (coordinates == value.end() || !coordinates->is_array()) {
      return problems_.add(pointer, "must be a list");
    }
    if (type == "Point") return position(*coordinates, pointer);
    if (type != "MultiLineString") return positions(*coordinates, pointer);
    for (std::size_t i = 0; i < coordinates->size(); ++i) {
      positions((*coordinates)[i], pointer + '/' + std::to_string(i));
    }
  }

  void positions(const json& list, const std::string& where) {
    if (!list.is_array()) return problems_.add(where, "must be a list");
    for (std::size_t i = 0; i < list.size(); ++i) {
      position(list[i], where + '/' + std::to_string(i));
    }
  }

  void position(const json& value, std::string where) {
    bool good = value.is_array() && value.size() >= 2;
    for (std::size_t i = 0; good && i < value.size() && i < 3; ++i) good = value[i].is_number();
    if (!good) return problems_.add(where, "must be [longitude, latitude] or with a height");
    TrackPoint point{std::move(where), "position", value[1].get<double>(), value[0].get<double>()};
    if (value.size() > 2) point.alt_m = value[2].get<double>();
    builder_.add(std::move(point));
  }

  ImportedFile file_;
  Fence fence_;
  Problems problems_;
  TrackBuilder builder_{file_, problems_};
};

}  // namespace

Result<ImportedFile> read_geojson(std::string_view content) {
  return GeoJsonReader().read(without_bom(content));
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
  for (const Item& item : plan.items) {
    const auto* point = std::get_if<Waypoint>(&item);
    if (point == nullptr) continue;
    json position = {point->at.lon, point->at.lat};
    if (point->alt_m) position.push_back(*point->alt_m);
    coordinates.push_back(std::move(position));
    json more = item_to_json(item);
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
