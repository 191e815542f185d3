#pragma once
// A car: one speed, one steering angle.
//
//   wanted speed ─▶ delay ─▶ lag ─▶ limits ─▶ wheel speed ─▶ slip ──┐
//   wanted angle ─▶ delay ─▶ lag ─▶ rate, lock ─▶ motor ─▶ linkage ─┴▶ bicycle ─▶ true twist
//                                                    └─▶ the sensor sees this
//
// Bicycle model about the rear axle's middle: ω = v·tan(δ)/L.

#include <optional>

#include "sim/motion.hpp"
#include "sim/params.hpp"

namespace roverd::sim {

class Car {
 public:
  struct Wanted {
    double speed_mps = 0.0;
    std::optional<double> wheel_rad;  ///< empty: the steering motor stays where it is
  };

  /// @param brake the e-stop: brakes at once, whatever is wanted.
  void step(const DriveParams& d, const CarParams& c, Wanted wanted, bool brake, double dt_s);

  /// Somebody else moves it: this only counts.
  void follow(double speed_mps, std::optional<double> wheel_rad) noexcept {
    speed_mps_ = lagged_mps_ = driven_mps_ = speed_mps;
    if (wheel_rad) motor_rad_ = wheel_rad_ = *wheel_rad;
  }

  GroundMotion ground() const noexcept { return ground_; }
  double wheel_speed_mps() const noexcept { return speed_mps_; }
  double seen_rad() const noexcept { return motor_rad_; }   ///< by the sensor at the motor
  double wheel_rad() const noexcept { return wheel_rad_; }  ///< where the wheels really stand
  double power_w() const noexcept { return power_w_; }

  /// At once and without memory; the wheels stay.
  void halt() noexcept;

 private:
  void steer(const CarParams& c, std::optional<double> wanted_rad, double dt_s);

  Delay<Wanted> delay_;
  double lagged_mps_ = 0.0;
  double driven_mps_ = 0.0;  ///< after the limits
  double speed_mps_ = 0.0;   ///< of the wheels
  double motor_rad_ = 0.0;
  double wheel_rad_ = 0.0;
  double power_w_ = 0.0;
  GroundMotion ground_;
};

}  // namespace roverd::sim
