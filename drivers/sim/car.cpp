#include "sim/car.hpp"

namespace roverd::sim {
namespace {

constexpr double kCarGravity_mps2 = 9.81;
constexpr double kCarEfficiency = 0.8;

}  // namespace

void Car::step(const DriveParams& d, const CarParams& c, Wanted wanted, bool brake, double dt_s) {
  const double before_mps = speed_mps_;
  if (brake) {
    const double step = d.estop_decel_mps2 * dt_s;
    delay_.clear();
    lagged_mps_ = driven_mps_ = speed_mps_ = slew(speed_mps_, 0.0, step, step);
    steer(c, {}, dt_s);
  } else {
    if (wanted.wheel_rad) *wanted.wheel_rad -= c.servo_rad;
    const Wanted now = delay_.step(wanted, d.delay_s, dt_s);
    lagged_mps_ += (now.speed_mps - lagged_mps_) * lag_share(d.lag_s, dt_s);
    driven_mps_ = slew(driven_mps_, lagged_mps_, d.accel_mps2 * dt_s, d.decel_mps2 * dt_s);
    if (now.speed_mps == 0.0 && std::abs(driven_mps_) < kStandLinear_mps) {
      driven_mps_ = lagged_mps_ = 0.0;
    }
    speed_mps_ = unstick(speed_mps_, driven_mps_, d.stick_mps);
    steer(c, now.wheel_rad, dt_s);
  }
  const double v = speed_mps_ * std::max(0.0, 1.0 - d.slip - (d.slip_left + d.slip_right) / 2.0);
  ground_ = {{v, v * std::tan(wheel_rad_) / c.wheelbase_m}, 0.0};
  const double force_n = d.mass_kg * ((speed_mps_ - before_mps) / dt_s +
                                      (speed_mps_ == 0.0 ? 0.0 : std::copysign(1.0, speed_mps_)) *
                                          d.rolling_resistance * kCarGravity_mps2);
  power_w_ = std::max(0.0, force_n * speed_mps_) / kCarEfficiency;
}

void Car::steer(const CarParams& c, std::optional<double> wanted_rad, double dt_s) {
  if (wanted_rad) {
    const double most = c.wheel_rate_radps * dt_s;
    const double way = (std::clamp(*wanted_rad, -c.max_wheel_rad, c.max_wheel_rad) - motor_rad_) *
                       lag_share(c.wheel_lag_s, dt_s);
    motor_rad_ += std::clamp(way, -most, most);
  }
  wheel_rad_ = motor_rad_ - c.linkage_rad;
}

void Car::halt() noexcept {
  delay_.clear();
  lagged_mps_ = driven_mps_ = speed_mps_ = power_w_ = 0.0;
  ground_ = {};
}

}  // namespace roverd::sim
