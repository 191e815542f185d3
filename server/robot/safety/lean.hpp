#pragma once
// How far the body leans, whichever way, and since when it leans too far. Control thread.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angle.hpp"
#include "base/measurements.hpp"

namespace roverd::robot {

/// Between the body's up and the vertical, [0, 180].
inline double lean_deg(const base::Attitude& a) noexcept {
  const double up = std::cos(a.roll_rad) * std::cos(a.pitch_rad);
  return base::deg_from_rad(std::acos(std::clamp(up, -1.0, 1.0)));
}

class LeanWatch {
 public:
  /// A stone under a track is no slope.
  static constexpr double kLasts_s = 0.3;

  /// Once a tick. @param attitude empty: nothing tells how it leans
  void step(const std::optional<base::Attitude>& attitude, double most_deg,
            base::Time now) noexcept {
    const bool too_far = attitude && lean_deg(*attitude) > most_deg;
    if (!too_far) since_.reset();
    if (too_far && !since_) since_ = now;
  }
  const std::optional<base::Time>& since() const noexcept { return since_; }

 private:
  std::optional<base::Time> since_;
};

}  // namespace roverd::robot
