#include "nav/behave/sticks.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {
namespace {

constexpr double kMiddle_radps = 0.03;  ///< a stick that asks for less is in its middle
constexpr double kMostMissing_radps = 0.3;

}  // namespace

void Sticks::begin(StickMode mode, const Vehicle& v) noexcept {
  mode_ = mode;
  yaw_rad_ = v.yaw_rad;
  holding_ = false;
  missing_radps_ = speed_mps_ = rate_radps_ = 0.0;
}

TrackOutput Sticks::step(const base::BodyTwist& asked, const base::BodyTwist& full,
                         const Vehicle& v, double limit_mps, double dt_s) noexcept {
  base::BodyTwist stick = asked;
  stick.linear_mps = std::clamp(stick.linear_mps, -limit_mps, limit_mps);
  if (stick.linear_mps == 0.0 && stick.angular_radps == 0.0) {
    holding_ = false;
    missing_radps_ = speed_mps_ = rate_radps_ = 0.0;
    return {{}, SpeedReason::Standing};
  }
  switch (mode_) {
    case StickMode::Acro:
      return acro(stick, v, dt_s);
    case StickMode::Steering:
      return steering(stick, v, dt_s);
    case StickMode::Simple:
      return simple(stick, full, v, dt_s);
  }
  return {};
}

TrackOutput Sticks::acro(const base::BodyTwist& stick, const Vehicle& v, double dt_s) noexcept {
  const double most = path_->speed.max_yaw_rate_radps;
  const double wanted = std::clamp(stick.angular_radps, -most, most);
  const double off = wanted - v.yaw_rate_radps;
  const bool full = std::abs(wanted + missing_radps_) >= most && off * wanted > 0.0;
  if (!full) {
    missing_radps_ = std::clamp(missing_radps_ + modes_->rate_gain * off * dt_s,
                                -kMostMissing_radps, kMostMissing_radps);
  }
  return {track_twist(v, stick.linear_mps, wanted + missing_radps_, *path_), SpeedReason::Item};
}

TrackOutput Sticks::steering(const base::BodyTwist& stick, const Vehicle& v, double dt_s) noexcept {
  const double side = path_->speed.lateral_mps2 / std::max(0.1, std::abs(stick.linear_mps));
  const double most = std::min(path_->speed.max_yaw_rate_radps, side);
  double wanted = 0.0;
  if (std::abs(stick.angular_radps) > kMiddle_radps) {
    holding_ = false;
    wanted = std::clamp(stick.angular_radps, -most, most);
  } else {
    // The turn runs out first; the heading is held from where that is.
    if (!holding_ && std::abs(v.yaw_rate_radps) < 0.1) {
      holding_ = true;
      yaw_rad_ = v.yaw_rad;
    }
    if (holding_) {
      const double soon = v.yaw_rad + rate_radps_ * path_->track.delay_s;
      wanted = std::clamp(
          heading_rate_radps(base::angle_diff_rad(soon, yaw_rad_), modes_->heading_gain, *path_),
          -most, most);
    }
  }
  const double change = path_->speed.yaw_accel_radps2 * dt_s;
  rate_radps_ = slew(rate_radps_, wanted, change, change);
  const bool limited = std::abs(stick.angular_radps) > side;
  return {track_twist(v, stick.linear_mps, rate_radps_, *path_),
          limited ? SpeedReason::Turn : SpeedReason::Item};
}

TrackOutput Sticks::simple(const base::BodyTwist& stick, const base::BodyTwist& full,
                           const Vehicle& v, double dt_s) noexcept {
  const double forward = stick.linear_mps / std::max(0.01, full.linear_mps);
  const double left = stick.angular_radps / std::max(0.01, full.angular_radps);
  const double share = std::min(1.0, std::hypot(forward, left));
  const double to = base::wrap_rad(yaw_rad_ + std::atan2(left, forward));
  const double soon = v.yaw_rad + rate_radps_ * path_->track.delay_s;
  const double error = base::angle_diff_rad(soon, to);
  const bool spot =
      !path_->vehicle.steered() && std::abs(error) > base::rad_from_deg(path_->pivot.angle_deg);
  const SpeedParams& p = path_->speed;
  const double most = share * std::min(full.linear_mps, p.max_mps);
  const double wanted = spot ? 0.0 : most * heading_factor(error);
  speed_mps_ = slew(speed_mps_, wanted, p.accel_mps2 * dt_s, p.hold_decel_mps2 * dt_s);
  const double side = spot ? p.max_yaw_rate_radps : p.lateral_mps2 / std::max(0.1, speed_mps_);
  const double rate =
      std::clamp(heading_rate_radps(error, modes_->heading_gain, *path_), -side, side);
  const double change = p.yaw_accel_radps2 * dt_s;
  rate_radps_ = slew(rate_radps_, rate, change, change);
  return {track_twist(v, speed_mps_, rate_radps_, *path_),
          spot ? SpeedReason::Pivot : SpeedReason::Item};
}

}  // namespace roverd::nav
