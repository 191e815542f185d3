#pragma once
// Where the steering really stands when it is told to stand straight.
//
// The driver sees two angles: what it told and what the controller reports. Their difference while
// the car drives straight and steadily is the actuator's zero, and this removes it. A sensor that
// is itself off shows nothing here, and a controller that reports nothing even less: there only the
// way over ground tells. The robot's estimator learns it from position and course as the curvature
// that stays while the wheels stand straight (nav: pull_1pm, told in GET /vehicle), and the tracker
// steers against it. What is removed here leaves nothing to learn there. Pure.

#include <algorithm>
#include <cmath>

namespace roverd::ackermann {

class SteeringZero {
 public:
  static constexpr double kSlow_mps = 0.3;      ///< slower, the tyres hold the wheels
  static constexpr double kStraight_rad = 0.1;  ///< farther out, the linkage is not linear
  static constexpr double kSettled_s = 0.5;     ///< the wheel follows the command by then
  static constexpr double kFollows_s = 0.25;    ///< the wheel is so much later than the command
  static constexpr double kSteady_rad = 0.03;   ///< and is no farther behind it
  static constexpr double kFirst_s = 1.0;       ///< time constant at first,
  static constexpr double kTime_s = 3.0;        ///< and when it has been learned for as long

  explicit SteeringZero(double max_rad) : max_rad_(max_rad) {}

  /// @param told_rad wheel angle wanted. @param seen_rad reported. dt_s since the last call.
  void add(double speed_mps, double told_rad, double seen_rad, double dt_s) noexcept {
    if (!(dt_s > 0.0)) return;
    // A tracker's command trembles with every position: the wheel averages it, and so does this.
    followed_rad_ += (told_rad - followed_rad_) * std::min(1.0, dt_s / kFollows_s);
    const bool straight = std::abs(speed_mps) > kSlow_mps && std::abs(told_rad) < kStraight_rad &&
                          std::abs(told_rad - followed_rad_) < kSteady_rad;
    steady_s_ = straight ? steady_s_ + dt_s : 0.0;
    if (steady_s_ < kSettled_s) return;
    const double step = std::min(1.0, dt_s / std::clamp(learned_s_, kFirst_s, kTime_s));
    learned_s_ += dt_s;
    zero_rad_ = std::clamp(zero_rad_ + step * (followed_rad_ - seen_rad), -max_rad_, max_rad_);
  }

  /// To be added to what is sent, beside the parameter.
  double zero_rad() const noexcept { return zero_rad_; }

 private:
  double max_rad_;
  double zero_rad_ = 0.0;
  double followed_rad_ = 0.0;  ///< where the wheel should stand by now
  double steady_s_ = 0.0;
  double learned_s_ = 0.0;
};

}  // namespace roverd::ackermann
