#include "nav/behave/rotate_in_place.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {

void RotateInPlace::begin(double rate_radps) noexcept {
  state_ = State::Brake;
  counting_ = false;
  most_radps_ = rate_radps;
  rate_radps_ = still_s_ = time_s_ = limit_s_ = 0.0;
  sent_.fill(0.0);
}

void RotateInPlace::to(double yaw_rad, double rate_radps) noexcept {
  begin(rate_radps);
  absolute_ = true;
  goal_rad_ = yaw_rad;
}

void RotateInPlace::by(double angle_rad, double rate_radps) noexcept {
  begin(rate_radps);
  absolute_ = false;
  left_rad_ = angle_rad;
}

/// What was turned since the last step. An absolute goal takes up what the estimate has learned
/// meanwhile, and keeps its side.
void RotateInPlace::count(const Vehicle& v) noexcept {
  if (!counting_) {
    counting_ = true;
    if (absolute_) left_rad_ = base::angle_diff_rad(v.yaw_rad, goal_rad_);
  } else if (absolute_) {
    const double off = base::angle_diff_rad(v.yaw_rad, goal_rad_);
    const double was = left_rad_ - base::angle_diff_rad(yaw_rad_, v.yaw_rad);
    left_rad_ = off + 2.0 * base::kPi * std::round((was - off) / (2.0 * base::kPi));
  } else {
    left_rad_ -= base::angle_diff_rad(yaw_rad_, v.yaw_rad);
  }
  yaw_rad_ = v.yaw_rad;
}

TrackOutput RotateInPlace::step(const Vehicle& v, const PathParams& p, double dt_s) noexcept {
  if (state_ == State::Idle || state_ == State::Done || state_ == State::Failed) {
    return {{}, SpeedReason::Standing};
  }
  count(v);
  if (state_ == State::Brake) {
    still_s_ = stands(v) ? still_s_ + dt_s : 0.0;
    if (still_s_ < 0.1) return {{}, SpeedReason::Stopping};
    still_s_ = 0.0;
    state_ = State::Turn;
    limit_s_ = 5.0 + 3.0 * std::abs(left_rad_) / std::max(0.01, most_radps_);
  }
  time_s_ += dt_s;
  if (time_s_ > limit_s_) {
    state_ = State::Failed;
    return {{}, SpeedReason::Standing};
  }
  const double done = base::rad_from_deg(p.pivot.done_deg);
  const bool there = std::abs(left_rad_) < done && std::abs(v.yaw_rate_radps) < 0.15;
  still_s_ = there ? still_s_ + dt_s : 0.0;
  if (still_s_ >= 0.2) {
    state_ = State::Done;
    return {{}, SpeedReason::Standing};
  }
  double left = left_rad_;
  const auto ticks =
      std::min(sent_.size(), static_cast<std::size_t>(std::lround(p.track.delay_s / dt_s)));
  for (std::size_t k = 0; k < ticks; ++k) {
    left -= sent_[(sent_at_ + sent_.size() - k) % sent_.size()] * dt_s;
  }
  PivotParams pivot = p.pivot;
  pivot.max_rate_radps = std::min({pivot.max_rate_radps, most_radps_, p.speed.max_yaw_rate_radps});
  const double wanted = std::abs(left) < 0.5 * done ? 0.0 : pivot_rate_radps(left, pivot);
  const double change = pivot.slew_radps2 * dt_s;
  rate_radps_ = slew(rate_radps_, wanted, change, change);
  sent_at_ = (sent_at_ + 1) % sent_.size();
  sent_[sent_at_] = rate_radps_;
  return {track_twist(v, 0.0, rate_radps_, p), SpeedReason::Pivot};
}

}  // namespace roverd::nav
