#pragma once
// Which points may be left out of a line, one after another (source: nav/track/outline.hpp). Pure.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/geo.hpp"

namespace roverd::nav {

using base::EnuPoint;

/// The directions from one point that pass all points since within the tolerance.
class Sleeve {
 public:
  explicit Sleeve(EnuPoint from) : from_(from) {}

  /// @return false: no direction passes this one as well, or it lies back
  bool take(EnuPoint to, double within_m) {
    const double east = to.east_m - from_.east_m;
    const double north = to.north_m - from_.north_m;
    const double away = std::hypot(east, north);
    if (!open_ && away <= within_m) return true;  // none yet is farther than makes a difference
    if (away < farthest_m_) return false;
    farthest_m_ = away;
    if (away <= within_m) return true;
    const double yaw = std::atan2(north, east);
    const double half = std::asin(within_m / away);
    if (!open_) {
      open_ = true;
      middle_ = yaw;
      low_ = -half;
      high_ = half;
      return true;
    }
    const double turn = base::wrap_rad(yaw - middle_);
    const bool passes = turn >= low_ && turn <= high_;
    low_ = std::max(low_, turn - half);
    high_ = std::min(high_, turn + half);
    return passes;
  }

 private:
  EnuPoint from_;
  double farthest_m_ = 0.0;
  bool open_ = false;
  double middle_ = 0.0;
  double low_ = 0.0;  ///< from the middle
  double high_ = 0.0;
};

/// The same of a value over a growing distance: the slopes from one point that pass all since.
class SlopeSleeve {
 public:
  SlopeSleeve(double from_m, double value) : from_m_(from_m), value_(value) {}

  /// @param low, high what the line may be at `to_m`, around `value`
  /// @return false: no slope passes this one as well
  bool take(double to_m, double value, double low, double high) noexcept {
    const double ds = to_m - from_m_;
    if (!(ds > 0.0)) return value == value_;
    const double slope = (value - value_) / ds;
    const bool passes = slope >= low_ && slope <= high_;
    low_ = std::max(low_, (low - value_) / ds);
    high_ = std::min(high_, (high - value_) / ds);
    return passes;
  }

 private:
  double from_m_;
  double value_;
  double low_ = -1e300;
  double high_ = 1e300;
};

}  // namespace roverd::nav
