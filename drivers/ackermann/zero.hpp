#pragma once
// Where the steering really stands when it is told to stand straight.
//
// The driver sees two angles: what it told and what the controller reports. Their difference while
// the car drives straight and steadily is the actuator's zero, and this removes it. A sensor that
// is itself off shows nothing here, and a controller that reports nothing even less: there only the
// way over ground tells. The robot's estimator learns it from position and course as the curvature
// that stays while the wheels stand straight (nav: pull_1pm, told in GET /vehicle), and the tracker
// steers against it. What is removed here leaves nothing to learn there.
//
// In bends a linkage is not linear: what differs there beyond the zero is removed too, for each
// side by itself, and says nothing of the straight. Pure.

#include <algorithm>
#include <array>
#include <cmath>

namespace roverd::ackermann {

class SteeringZero {
 public:
  static constexpr double kSlow_mps = 0.3;      ///< slower, the tyres hold the wheels
  static constexpr double kStraight_rad = 0.1;  ///< farther out, the linkage is not linear
  static constexpr double kZero_rad = 0.05;     ///< from here to there what bends have fades in
  static constexpr double kSettled_s = 0.5;     ///< the wheel follows the command by then
  static constexpr double kFollows_s = 0.25;    ///< the wheel is so much later than the command
  static constexpr double kSteady_rad = 0.03;   ///< and is no farther behind it
  static constexpr double kFirst_s = 1.0;       ///< time constant at first,
  static constexpr double kTime_s = 3.0;        ///< and when it has been learned for as long
  static constexpr double kBend_s = 1.5;        ///< of what a bend has

  explicit SteeringZero(double max_rad) : max_rad_(max_rad) {}

  /// @param told_rad wheel angle wanted. @param seen_rad reported. dt_s since the last call.
  void add(double speed_mps, double told_rad, double seen_rad, double dt_s) noexcept {
    if (!(dt_s > 0.0)) return;
    // A tracker's command trembles with every position: the wheel averages it, and so does this.
    followed_rad_ += (told_rad - followed_rad_) * std::min(1.0, dt_s / kFollows_s);
    const bool straight = std::abs(told_rad) < kStraight_rad;
    const bool steady =
        std::abs(speed_mps) > kSlow_mps && std::abs(told_rad - followed_rad_) < kSteady_rad;
    steady_s_ = steady && straight == straight_ ? steady_s_ + dt_s : 0.0;
    straight_ = straight;
    if (steady_s_ < kSettled_s) return;
    const double off_rad = followed_rad_ - seen_rad;
    if (straight) {
      const double step = std::min(1.0, dt_s / std::clamp(learned_s_, kFirst_s, kTime_s));
      learned_s_ += dt_s;
      zero_rad_ = std::clamp(zero_rad_ + step * off_rad, -max_rad_, max_rad_);
    } else {
      double& bend_rad = bend_rad_[told_rad > 0.0];
      bend_rad += std::min(1.0, dt_s / kBend_s) * off_rad;
      bend_rad = std::clamp(bend_rad, -max_rad_ - zero_rad_, max_rad_ - zero_rad_);
    }
  }

  /// To be added to what is sent, beside the parameter, for a wheel that shall stand so.
  double at_rad(double wheel_rad) const noexcept {
    const double out = (std::abs(wheel_rad) - kZero_rad) / (kStraight_rad - kZero_rad);
    const double bend_rad = std::clamp(out, 0.0, 1.0) * bend_rad_[wheel_rad > 0.0];
    // The zero may have moved since the bend was learned; the gate lets no more through.
    return std::clamp(zero_rad_ + bend_rad, -max_rad_, max_rad_);
  }
  /// Of it, what holds straight ahead.
  double zero_rad() const noexcept { return zero_rad_; }

 private:
  double max_rad_;
  double zero_rad_ = 0.0;
  std::array<double, 2> bend_rad_{};  ///< to the right, to the left: beyond the zero
  bool straight_ = true;
  double followed_rad_ = 0.0;  ///< where the wheel should stand by now
  double steady_s_ = 0.0;
  double learned_s_ = 0.0;
};

}  // namespace roverd::ackermann
