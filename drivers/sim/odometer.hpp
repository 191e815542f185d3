#pragma once
// What the base tells of its tracks: the truth, or less. Only the telling is wrong, never the
// motion.

#include "base/geo.hpp"
#include "sim/radio.hpp"

namespace roverd::sim {

class Odometer {
 public:
  /// Once a step. @param left_m, right_m travel of either track since power-up. @param measured
  /// what a healthy base tells
  void step(const Faults& f, double left_m, double right_m, base::BodyTwist measured,
            double track_width_m) noexcept {
    const double left_share = f.odometry_left_stuck ? 0.0 : f.odometry_share;
    if (!f.odometry_frozen) {
      left_m_ += left_share * (left_m - true_left_m_);
      right_m_ += f.odometry_share * (right_m - true_right_m_);
    }
    true_left_m_ = left_m;
    true_right_m_ = right_m;
    if (f.odometry_share == 1.0 && !f.odometry_left_stuck) {
      twist_ = measured;
      return;
    }
    const double half_m = track_width_m / 2.0;
    const double left_mps = left_share * (measured.linear_mps - measured.angular_radps * half_m);
    const double right_mps =
        f.odometry_share * (measured.linear_mps + measured.angular_radps * half_m);
    twist_ = {(left_mps + right_mps) / 2.0, (right_mps - left_mps) / track_width_m};
  }

  double left_m() const noexcept { return left_m_; }
  double right_m() const noexcept { return right_m_; }
  base::BodyTwist twist() const noexcept { return twist_; }

 private:
  double left_m_ = 0.0;
  double right_m_ = 0.0;
  double true_left_m_ = 0.0;
  double true_right_m_ = 0.0;
  base::BodyTwist twist_;
};

}  // namespace roverd::sim
