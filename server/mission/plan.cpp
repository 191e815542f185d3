#include "mission/plan.hpp"

#include <array>
#include <cmath>

#include "base/tangent_plane.hpp"
#include "mission/circle.hpp"

namespace roverd::mission {

std::string_view type_name(const Item& item) noexcept {
  // In the order of the variant.
  static constexpr std::array<std::string_view, std::variant_size_v<Item>> kNames{
      "waypoint",  "local", "move", "turn",        "wait",   "speed",  "row",    "wall",
      "landmarks", "dock",  "jump", "return_home", "action", "loiter", "circle", "map_point"};
  return item.valueless_by_exception() ? std::string_view{} : kNames[item.index()];
}

std::optional<LatLon> place_of(const Item& item) noexcept {
  if (const auto* waypoint = std::get_if<Waypoint>(&item)) return waypoint->at;
  if (const auto* loiter = std::get_if<Loiter>(&item)) return loiter->at();
  if (const auto* circle = std::get_if<Circle>(&item)) return circle->at;
  return std::nullopt;
}

LatLon place_on_earth(const base::MapLies& lies, const MapPoint& point) noexcept {
  const double c = std::cos(lies.yaw_rad);
  const double s = std::sin(lies.yaw_rad);
  return base::TangentPlane(lies.at).to_global(
      {c * point.x_m - s * point.y_m, s * point.x_m + c * point.y_m});
}

double length_m(const Plan& plan) noexcept {
  double sum_m = 0.0;
  std::optional<LatLon> before;
  const MapPoint* in_map = nullptr;  // the item before it
  const auto go = [&](LatLon to) {
    if (before) sum_m += base::distance_bearing(*before, to).distance_m;
    before = to;
  };
  for (const Item& item : plan.items) {
    if (const auto* point = std::get_if<MapPoint>(&item)) {
      if (in_map != nullptr)
        sum_m += std::hypot(point->x_m - in_map->x_m, point->y_m - in_map->y_m);
      in_map = point;
      before.reset();
      continue;
    }
    if (place_of(item)) in_map = nullptr;
    if (const auto* circle = std::get_if<Circle>(&item)) {
      const base::TangentPlane plane(circle->at);
      const CircleWay round =
          circle_way(*circle, {}, before ? std::optional(plane.to_local(*before)) : std::nullopt);
      go(plane.to_global(round.entry()));
      sum_m += round.length_m();
      before = plane.to_global(round.end());
    } else if (const auto at = place_of(item)) {
      go(*at);
    }
  }
  return sum_m;
}

Plan laid_on_earth(Plan plan, const base::MapLies& lies) {
  for (Item& item : plan.items) {
    const auto* point = std::get_if<MapPoint>(&item);
    if (point == nullptr) continue;
    Waypoint laid;
    laid.at = place_on_earth(lies, *point);
    laid.speed_mps = point->speed_mps;
    laid.radius_m = point->radius_m;
    laid.hold_s = point->hold_s;
    laid.reverse = point->reverse;
    item = laid;
  }
  plan.frame.reset();
  return plan;
}

}  // namespace roverd::mission
