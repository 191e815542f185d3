#include "mission/formats/geojson_fence.hpp"

#include <utility>

#include "mission/fence/fence_json.hpp"

namespace roverd::mission {

namespace {

using nlohmann::json;

/// [longitude, latitude, …]
bool read_lon_lat(const json& value, base::LatLon& out) {
  if (!value.is_array() || value.size() < 2 || !value[0].is_number() || !value[1].is_number()) {
    return false;
  }
  out = {value[1].get<double>(), value[0].get<double>()};
  return true;
}

/// The outer ring, which GeoJSON closes. Else what is wrong with it.
base::Result<FencePolygon> ring_of(const json& coordinates) {
  const auto bad = [](const char* detail) { return base::fail(base::Code::Invalid, detail); };
  if (!coordinates.is_array() || coordinates.empty() || !coordinates[0].is_array()) {
    return bad("must be a list of rings");
  }
  if (coordinates.size() > 1) return bad("must have no holes: say them as exclusions");
  FencePolygon out;
  for (const json& corner : coordinates[0]) {
    base::LatLon at;
    if (!read_lon_lat(corner, at)) return bad("must have corners [longitude, latitude]");
    out.points.push_back(at);
  }
  if (out.points.size() > 1 && out.points.front() == out.points.back()) out.points.pop_back();
  return out;
}

struct Part {
  Fence alone{"fence", {}, {}};
  const char* what = "fence";
  std::string problem;
};

Part part_of(const json& properties, const json& shape) {
  Part out;
  const json type = shape.value("type", json());
  const json coordinates = shape.value("coordinates", json());
  const json kind = properties.value("fence", json());
  base::LatLon at;
  const bool is_point = type == "Point" && read_lon_lat(coordinates, at);
  if (kind.is_null()) {
    out.what = "rally point";
    if (!is_point) {
      out.problem = "must be a Point to be a rally point";
      return out;
    }
    RallyPoint& rally = out.alone.rally.emplace_back();
    rally.at = at;
    if (coordinates.size() > 2 && coordinates[2].is_number()) {
      rally.alt_m = coordinates[2].get<double>();
    }
    return out;
  }
  if (kind != "inclusion" && kind != "exclusion") {
    out.problem = "must have \"inclusion\" or \"exclusion\" as its property fence";
    return out;
  }
  FenceArea area{kind == "inclusion" ? AreaKind::Inclusion : AreaKind::Exclusion, FencePolygon{}};
  const json radius_m = properties.value("radius_m", json());
  if (is_point && radius_m.is_number()) {
    area.shape = FenceCircle{at, radius_m.get<double>()};
  } else if (type == "Polygon") {
    auto ring = ring_of(coordinates);
    if (!ring) out.problem = ring.error().detail;
    if (ring) area.shape = std::move(*ring);
  } else {
    out.problem = "must be a Polygon, or a Point with radius_m, to be a fence";
  }
  out.alone.areas.push_back(std::move(area));
  return out;
}

json feature_json(json properties, const char* type, json coordinates) {
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}};
}

}  // namespace

bool take_fence_feature(const json& properties, const json& shape, const FencePlace& where,
                        Fence& fence, std::vector<FileRow>& rows, Problems& problems) {
  const bool rally = properties.value("rally", json()) == true;
  if (!shape.is_object() || (!rally && !properties.contains("fence"))) return false;
  Part part = part_of(properties, shape);
  if (part.problem.empty()) {
    if (const auto fine = check_fence(part.alone); !fine) {
      const auto& fields = fine.error().fields;
      part.problem = fields.empty() ? fine.error().detail : fields.front().detail;
    }
  }
  if (!part.problem.empty()) {
    problems.add(where.problem, std::move(part.problem));
    return true;
  }
  for (FenceArea& area : part.alone.areas) fence.areas.push_back(std::move(area));
  for (const RallyPoint& point : part.alone.rally) fence.rally.push_back(point);
  rows.push_back({where.row, part.what, Outcome::Taken, {}, std::nullopt});
  return true;
}

std::vector<json> fence_features(const Fence& fence) {
  std::vector<json> out;
  for (const FenceArea& area : fence.areas) {
    json properties{{"fence", to_string(area.kind)}};
    if (const auto* circle = std::get_if<FenceCircle>(&area.shape)) {
      properties["radius_m"] = circle->radius_m;
      out.push_back(feature_json(std::move(properties), "Point",
                                 json::array({circle->center.lon, circle->center.lat})));
      continue;
    }
    json ring = json::array();
    const auto& points = std::get<FencePolygon>(area.shape).points;
    for (const base::LatLon at : points) ring.push_back(json::array({at.lon, at.lat}));
    ring.push_back(ring.front());
    out.push_back(feature_json(std::move(properties), "Polygon", json::array({std::move(ring)})));
  }
  for (const RallyPoint& point : fence.rally) {
    json at = json::array({point.at.lon, point.at.lat});
    if (point.alt_m) at.push_back(*point.alt_m);
    out.push_back(feature_json({{"rally", true}}, "Point", std::move(at)));
  }
  return out;
}

}  // namespace roverd::mission
