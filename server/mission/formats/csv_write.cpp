// Plans as tables of positions: see csv_file.cpp.

#include <cmath>
#include <vector>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "mission/formats/file_formats.hpp"
#include "mission/formats/track_points.hpp"
#include "mission/text.hpp"

namespace roverd::mission {

namespace {

using base::TangentPlane;

/// Where `at` lies, as place_locally reads it.
base::EnuPoint follower_point(const TangentPlane& plane, LatLon origin, LatLon at) {
  constexpr double kSurely_m = 9'900.0;
  constexpr double kNear_deg = 1.0;
  if (std::abs(at.lat - origin.lat) < kNear_deg) {
    const base::EnuPoint local = plane.to_local(at);
    const double far_m = std::hypot(local.east_m, local.north_m);
    const double lon_deg = std::abs(std::remainder(at.lon - origin.lon, 360.0));
    // Near the poles all longitudes are near each other, elsewhere the far side of the earth looks
    // near.
    const bool this_side = lon_deg < 90.0 || std::abs(origin.lat) > 89.0;
    if (this_side && far_m <= kSurely_m) return local;
    if (this_side && far_m <= base::LocalFrame::kReach_m &&
        base::distance_bearing(origin, at).distance_m <= base::LocalFrame::kReach_m) {
      return local;
    }
  }
  const auto way = base::distance_bearing(origin, at);
  const double bearing_rad = base::rad_from_deg(way.bearing_deg);
  return {way.distance_m * std::sin(bearing_rad), way.distance_m * std::cos(bearing_rad)};
}

std::optional<LatLon> origin_of(const Plan& plan) {
  if (plan.home) return plan.home->at;
  for (const Item& item : plan.items) {
    if (const auto at = place_of(item)) return at;
  }
  return std::nullopt;
}

}  // namespace

std::string write_csv(const Plan& plan, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, true}, rows);
  const auto positions = positions_of(plan);
  std::string out = "lat,lon,alt,speed\n";
  for (const Waypoint& point : positions) {
    constexpr int kDecimals = 9;
    out += fixed_number(point.at.lat, kDecimals) + ',' + fixed_number(point.at.lon, kDecimals);
    out += ',';
    if (point.alt_m) append_number(out, *point.alt_m);
    out += ',';
    if (point.speed_mps) append_number(out, *point.speed_mps);
    out += '\n';
  }
  return out;
}

std::string write_follower(const Plan& plan, std::vector<FileRow>& rows) {
  report_left_out(plan, {true, true}, rows);
  const auto positions = positions_of(plan);
  std::string out;
  std::vector<base::EnuPoint> points;
  std::vector<const Waypoint*> waypoints;
  if (const auto origin = origin_of(plan)) {
    constexpr int kDecimals = 9;
    out += "# origin " + fixed_number(origin->lat, kDecimals) + ' ' +
           fixed_number(origin->lon, kDecimals) + '\n';
    const TangentPlane plane(*origin);
    for (const Waypoint& point : positions) {
      points.push_back(follower_point(plane, *origin, point.at));
      waypoints.push_back(&point);
    }
  }
  out += "x,y,z,yaw,velocity\n";
  double yaw_rad = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 < points.size()) {  // the last one looks where the way came from
      const base::EnuPoint way = points[i + 1] - points[i];
      if (std::hypot(way.east_m, way.north_m) > 0.0) yaw_rad = std::atan2(way.north_m, way.east_m);
    }
    append_number(out, points[i].east_m);
    out += ',';
    append_number(out, points[i].north_m);
    out += ',';
    if (waypoints[i]->alt_m) append_number(out, *waypoints[i]->alt_m);
    out += ',';
    append_number(out, yaw_rad);
    out += ',';
    if (waypoints[i]->speed_mps) append_number(out, *waypoints[i]->speed_mps);
    out += '\n';
  }
  return out;
}

}  // namespace roverd::mission
