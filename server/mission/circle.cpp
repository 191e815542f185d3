#include "mission/circle.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::mission {
namespace {

constexpr double kOn_m = 0.2;  // nearer to the circle than this there is no tangent to drive
constexpr double kCentre_m = 0.01;

}  // namespace

EnuPoint CircleWay::at(double along_rad) const noexcept {
  const double angle = from_rad + along_rad;
  return {centre.east_m + radius_m * std::cos(angle), centre.north_m + radius_m * std::sin(angle)};
}

double CircleWay::length_m() const noexcept {
  return radius_m * std::abs(sweep_rad);
}

CircleWay circle_way(const Circle& circle, EnuPoint centre,
                     std::optional<EnuPoint> before) noexcept {
  CircleWay way;
  way.centre = centre;
  way.radius_m = circle.radius_m;
  const double side = circle.clockwise ? -1.0 : 1.0;
  way.sweep_rad = side * 2.0 * base::kPi * circle.whole_turns();
  way.from_rad = base::kPi / 2.0;
  if (!before) return way;
  const EnuPoint out = *before - centre;
  const double far_m = std::hypot(out.east_m, out.north_m);
  if (far_m > kCentre_m) way.from_rad = std::atan2(out.north_m, out.east_m);
  if (far_m < circle.radius_m + kOn_m) return way;
  way.from_rad = base::wrap_rad(way.from_rad + side * std::acos(circle.radius_m / far_m));
  way.tangent = true;
  return way;
}

std::size_t stations_of(const Circle& circle) noexcept {
  constexpr double kNearly = 1e-6;  // turns of a third and the like
  const double each = std::max(0, circle.stations.value_or(0));
  return static_cast<std::size_t>(std::floor(each * circle.whole_turns() + kNearly));
}

}  // namespace roverd::mission
