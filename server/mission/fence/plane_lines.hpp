#pragma once
// Straight lines in a plane, for areas and their checks. Pure.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/geo.hpp"

namespace roverd::mission {

using base::EnuPoint;

/// Two points nearer than this are one.
inline constexpr double kSame_m = 1e-6;

inline EnuPoint along(EnuPoint a, EnuPoint b, double share) noexcept {
  return {a.east_m + share * (b.east_m - a.east_m), a.north_m + share * (b.north_m - a.north_m)};
}

inline double cross(EnuPoint u, EnuPoint v) noexcept {
  return u.east_m * v.north_m - u.north_m * v.east_m;
}
inline double dot(EnuPoint u, EnuPoint v) noexcept {
  return u.east_m * v.east_m + u.north_m * v.north_m;
}

/// From a point to the nearest one of the line from a to b.
inline double distance_to_side_m(EnuPoint p, EnuPoint a, EnuPoint b) noexcept {
  const EnuPoint ab = b - a;
  const double square = dot(ab, ab);
  const double share = square > 0.0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
  return base::distance_m(p, along(a, b, share));
}

/// Where, as a share of a→b, it meets c→d; the first such place if they lie on one line.
inline std::optional<double> meeting(EnuPoint a, EnuPoint b, EnuPoint c, EnuPoint d) noexcept {
  const EnuPoint ab = b - a;
  const EnuPoint cd = d - c;
  const EnuPoint ac = c - a;
  const double area = cross(ab, cd);
  const double scale = std::sqrt(dot(ab, ab) * dot(cd, cd));
  constexpr double kParallel = 1e-12;
  if (std::abs(area) > kParallel * scale) {
    const double s = cross(ac, cd) / area;
    const double t = cross(ac, ab) / area;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) return s;
    return std::nullopt;
  }
  std::optional<double> first;
  const auto offer = [&](double share) { first = std::min(first.value_or(share), share); };
  if (distance_to_side_m(a, c, d) < kSame_m) offer(0.0);
  if (distance_to_side_m(b, c, d) < kSame_m) offer(1.0);
  const double square = dot(ab, ab);
  for (const EnuPoint end : {c, d}) {
    if (square > 0.0 && distance_to_side_m(end, a, b) < kSame_m) {
      offer(std::clamp(dot(end - a, ab) / square, 0.0, 1.0));
    }
  }
  return first;
}

}  // namespace roverd::mission
