#include "sim/tracks.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::sim {
namespace {

constexpr double kGravity_mps2 = 9.81;
constexpr double kMotorEfficiency = 0.8;
constexpr double kSlipWanderTau_s = 3.0;
/// True yaw rate at which the tracks' sideways friction is nearly whole.
constexpr double kFullScrub_radps = 0.15;

double sign(double value) {
  return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}

}  // namespace

void Tracks::step(const DriveParams& p, base::BodyTwist wanted, bool brake, double dt_s) {
  const double half_m = p.track_width_m / 2.0;
  if (brake) {
    const double step = p.estop_decel_mps2 * dt_s;
    const double left = slew(left_.track_mps, 0.0, step, step);
    const double right = slew(right_.track_mps, 0.0, step, step);
    delay_.clear();
    driven_ = {(left + right) / 2.0, (right - left) / p.track_width_m};
    lagged_ = driven_;
    set_tracks(p, left, right, dt_s);
    return;
  }
  const base::BodyTwist target = delay_.step(wanted, p.delay_s, dt_s);
  const double share = lag_share(p.lag_s, dt_s);
  lagged_.linear_mps += (target.linear_mps - lagged_.linear_mps) * share;
  lagged_.angular_radps += (target.angular_radps - lagged_.angular_radps) * share;

  double& v = driven_.linear_mps;
  double& w = driven_.angular_radps;
  v = slew(v, lagged_.linear_mps, p.accel_mps2 * dt_s, p.decel_mps2 * dt_s);
  w = slew(w, lagged_.angular_radps, p.turn_accel_radps2 * dt_s, p.turn_decel_radps2 * dt_s);
  if (target.linear_mps == 0.0 && std::abs(v) < kStandLinear_mps) v = lagged_.linear_mps = 0.0;
  if (target.angular_radps == 0.0 && std::abs(w) < kStandAngular_radps) {
    w = lagged_.angular_radps = 0.0;
  }
  set_tracks(p, unstick(left_.track_mps, v - w * half_m, p.stick_mps),
             unstick(right_.track_mps, v + w * half_m, p.stick_mps), dt_s);
}

void Tracks::count(const DriveParams& p, double left_mps, double right_mps, double dt_s) {
  left_.travel_m += (left_mps + left_.track_mps) / 2.0 * dt_s;
  right_.travel_m += (right_mps + right_.track_mps) / 2.0 * dt_s;
  left_.track_mps = left_mps;
  right_.track_mps = right_mps;
  measured_ = {(left_mps + right_mps) / 2.0, (right_mps - left_mps) / p.track_width_m};
}

void Tracks::follow(const DriveParams& p, double left_mps, double right_mps, double dt_s) {
  count(p, left_mps, right_mps, dt_s);
  delay_.clear();
  lagged_ = driven_ = measured_;
}

void Tracks::set_tracks(const DriveParams& p, double left_mps, double right_mps, double dt_s) {
  const double left_mps2 = (left_mps - left_.track_mps) / dt_s;
  const double right_mps2 = (right_mps - right_.track_mps) / dt_s;
  count(p, left_mps, right_mps, dt_s);

  const double wander_left = p.slip_wander * left_slip_.step(dt_s, kSlipWanderTau_s);
  const double wander_right = p.slip_wander * right_slip_.step(dt_s, kSlipWanderTau_s);
  const double over_left =
      left_mps * std::max(0.0, 1.0 - p.slip - p.side_difference / 2.0 - wander_left - p.slip_left);
  const double over_right = right_mps * std::max(0.0, 1.0 - p.slip + p.side_difference / 2.0 -
                                                          wander_right - p.slip_right);
  const double w = (over_right - over_left) / (p.track_width_m * p.turn_loss);
  // The point `pivot_centre_m` ahead does not move sideways; the origin behind it does.
  ground_ = {{(over_left + over_right) / 2.0, w}, -w * p.pivot_centre_m};
  load(p, left_mps2, right_mps2);
}

/// Rolling, inertia and scrubbing: M = μ·m·g·L/4 for tracks that turn on the spot with even
/// pressure. Source: J. Y. Wong, Theory of Ground Vehicles, skid steering.
void Tracks::load(const DriveParams& p, double left_mps2, double right_mps2) {
  const double weight_n = p.mass_kg * kGravity_mps2;
  const double scrub_nm = p.scrub_friction * weight_n * p.contact_length_m / 4.0 *
                          std::tanh(ground_.twist.angular_radps / kFullScrub_radps);
  const double scrub_n = scrub_nm / p.track_width_m;
  const auto drive = [&](MotorState& motor, double accel_mps2, double turn_n) {
    const double force_n = p.rolling_resistance * weight_n / 2.0 * sign(motor.track_mps) +
                           p.mass_kg / 2.0 * accel_mps2 + turn_n;
    motor.current_a = force_n / p.newton_per_ampere;
    motor.power_w = std::max(0.0, force_n * motor.track_mps) / kMotorEfficiency;
  };
  drive(left_, left_mps2, -scrub_n);
  drive(right_, right_mps2, scrub_n);
}

void Tracks::halt() noexcept {
  delay_.clear();
  lagged_ = driven_ = measured_ = {};
  left_.track_mps = right_.track_mps = 0.0;
  ground_ = {};
}

}  // namespace roverd::sim
