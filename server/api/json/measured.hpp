#pragma once
// Measured numbers as JSON: with the digits that mean something, which also keep a message near one
// kilobyte; an unknown one is null, never a made-up zero. Pure.

#include <algorithm>
#include <cmath>
#include <optional>

#include "api/message.hpp"
#include "base/angle.hpp"
#include "base/time.hpp"

namespace roverd::api {

inline constexpr double kPlaces2 = 1e2;
inline constexpr double kPlaces3 = 1e3;
inline constexpr double kPlaces8 = 1e8;
inline constexpr double kPlaces9 = 1e9;

inline Json rounded(double value, double places) {
  if (!std::isfinite(value)) return nullptr;
  const double out = std::round(value * places) / places;
  return out == 0.0 ? 0.0 : out;  // no "-0.0"
}
inline Json rounded(const std::optional<double>& value, double places) {
  return value ? rounded(*value, places) : Json(nullptr);
}

inline Json degrees(double rad) {
  return rounded(base::deg_from_rad(rad), kPlaces2);
}
inline Json degrees(const std::optional<double>& rad) {
  return rad ? degrees(*rad) : Json(nullptr);
}

/// The group's age and whether it is stale.
inline void set_age(Json& group, const std::optional<base::Time>& stamp, base::Time now,
                    double stale_after_s) {
  const double age_s = stamp ? std::max(0.0, base::seconds(now - *stamp)) : 0.0;
  group["age_s"] = stamp ? rounded(age_s, kPlaces3) : Json(nullptr);
  group["stale"] = !stamp || age_s > stale_after_s;
}

template <class T>
std::optional<base::Time> stamp_of(const std::optional<T>& value) {
  return value ? std::optional(value->stamp) : std::nullopt;
}

}  // namespace roverd::api
