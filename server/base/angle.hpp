#pragma once
// The one place that converts between compass headings and mathematical yaw, and that wraps angles.
//
//   N   heading 0, yaw +π/2      yaw:     rad, counter-clockwise from east, (−π, π]
//   └─ E  heading 90, yaw 0      heading: deg, clockwise from true north, [0, 360)

#include <cmath>
#include <numbers>

namespace roverd::base {

inline constexpr double kPi = std::numbers::pi;

constexpr double rad_from_deg(double deg) noexcept {
  return deg * (kPi / 180.0);
}
constexpr double deg_from_rad(double rad) noexcept {
  return rad * (180.0 / kPi);
}

/// Wrapped to (−π, π]; a half turn is +π from both sides. NaN and infinity give NaN.
inline double wrap_rad(double angle_rad) noexcept {
  const double r = std::remainder(angle_rad, 2.0 * kPi);
  return r <= -kPi ? kPi : r;
}

/// to − from, wrapped to (−π, π]. NaN in, NaN out.
inline double angle_diff_rad(double from_rad, double to_rad) noexcept {
  return wrap_rad(to_rad - from_rad);
}

/// @param heading_deg any finite compass angle. @return yaw in (−π, π].
inline double yaw_from_heading(double heading_deg) noexcept {
  return wrap_rad(rad_from_deg(90.0 - heading_deg));
}

/// @param yaw_rad any finite angle. @return compass heading in [0, 360).
inline double heading_from_yaw(double yaw_rad) noexcept {
  double h = std::fmod(90.0 - deg_from_rad(yaw_rad), 360.0);
  if (h < 0.0) h += 360.0;
  return h >= 360.0 ? 0.0 : h;  // a tiny negative angle rounds up to 360
}

}  // namespace roverd::base
