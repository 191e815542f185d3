#pragma once
// The points of one sight were measured one after the other: this brings them to the body's pose at
// one moment, along the odometry, so that a turning robot bends no wall.

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/sight.hpp"
#include "base/time.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::chart {

class Carrier {
 public:
  /// @param odometry outlives it @param begin the sight's stamp @param reference X_OB at the moment
  /// to which everything is brought
  Carrier(const sense::PoseHistory& odometry, base::Time begin, const sense::Pose2& reference)
      : odometry_(odometry), begin_(begin), back_(inverse(reference)) {}

  /// X_RB of B at begin + after_s, R being B at the reference; one pose for each 2 ms, in which the
  /// body hardly moves. Empty: the odometry does not reach it.
  std::optional<sense::Pose2> at(double after_s) {
    constexpr double kKnot_s = 0.002;
    const double knot = std::floor(after_s / kKnot_s);
    if (!known_ || knot != knot_) {
      knot_ = knot;
      const auto pose = odometry_.at(begin_ + base::from_seconds((knot + 0.5) * kKnot_s));
      known_ = pose.has_value();
      if (pose) carried_ = back_ * *pose;
    }
    if (!known_) return std::nullopt;
    return carried_;
  }

 private:
  const sense::PoseHistory& odometry_;
  base::Time begin_;
  sense::Pose2 back_;
  sense::Pose2 carried_;
  double knot_ = 0.0;
  bool known_ = false;
};

/// When the last point was measured, seconds after the sight's stamp. Pure.
inline double last_s(const base::Sight& sight) noexcept {
  double last = 0.0;
  for (const base::SightPoint& p : sight.points) {
    if (p.after_s > last && p.after_s < 2.0F) last = p.after_s;
  }
  return last;
}

}  // namespace roverd::nav::chart
