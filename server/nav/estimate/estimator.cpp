#include "nav/estimate/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using base::seconds;
using std::chrono::milliseconds;

constexpr base::Duration kFuture = milliseconds(50);
constexpr base::Duration kOdometryGone = milliseconds(300);
constexpr base::Duration kGnssGone = milliseconds(2000);
constexpr base::Duration kStandsAfter = milliseconds(500);
constexpr double kStill_m = 0.0015;   // two counts of a millimetre odometer
constexpr double kFastest_mps = 4.0;  // more is a damaged count, not a motion
constexpr double kMaxGap_s = 2.0;     // of odometry that may still be carried over
// Without odometry: how wrong the receiver's velocity is, how fast it grows old, and how fast a
// robot may be of which nothing is known (1 sigma).
constexpr double kCoastSpeed_mps = 0.15;
constexpr double kCoastAccel_mps2 = 0.5;
constexpr double kBlindSpeed_mps = 1.0;

}  // namespace

Estimator::Estimator(const EstimateParams& params) : params_(params) {
  belief_.x(kScale) = 1.0;
  belief_.x(kYawScale) = params.yaw_scale;
  reset_state(belief_, kYaw, 0.0, base::kPi);
  reset_state(belief_, kBias, 0.0, rad_from_deg(params.compass_bias_sigma_deg));
  reset_state(belief_, kScale, 1.0, params.odometry_scale_sigma);
  reset_state(belief_, kYawScale, params.yaw_scale, params.yaw_scale_sigma);
  reset_state(belief_, kPull, 0.0, params.pull_sigma_1pm);
}

void Estimator::use_frame(const base::LocalFrame& frame) noexcept {
  if (!located_) frame_ = frame;
}

void Estimator::take(const base::Measurement& m, Time now) noexcept {
  now_ = now;
  std::visit(
      [this](const auto& value) {
        if constexpr (requires { this->take(value); }) this->take(value);
      },
      m);
}

bool Estimator::in_order(std::optional<Time>& last, Time stamp) noexcept {
  if (stamp > now_ + kFuture || (last && stamp <= *last)) {
    reject();
    return false;
  }
  last = stamp;
  return true;
}

bool Estimator::has_odometry(Time at) const noexcept {
  return tracks_at_ && at - *tracks_at_ < kOdometryGone;
}

// ---- tracks ------------------------------------------------------------------------------------

void Estimator::take(const base::WheelTravel& travel) {
  if (!std::isfinite(travel.left_m) || !std::isfinite(travel.right_m)) return reject();
  const auto before = last_travel_;
  if (!in_order(last_travel_, travel.stamp)) return;
  const double dt_s = before ? seconds(travel.stamp - *before) : 0.02;
  const double reach_m = kFastest_mps * dt_s + 0.1;
  if (dt_s > kMaxGap_s || std::abs(travel.left_m) > reach_m || std::abs(travel.right_m) > reach_m) {
    return reject();
  }
  const Travel t{0.5 * (travel.left_m + travel.right_m),
                 (travel.right_m - travel.left_m) / params_.track_width_m, dt_s};
  step(t, travel.stamp);
  if (!last_motion_ || travel.stamp - *last_motion_ > kOdometryGone) {
    tracks_ = {t.ahead_m / dt_s, t.turn_rad / dt_s};
  }
}

void Estimator::take(const base::BaseMotion& motion) {
  if (!std::isfinite(motion.twist.linear_mps) || !std::isfinite(motion.twist.angular_radps)) {
    return reject();
  }
  const auto before = last_motion_;
  if (!in_order(last_motion_, motion.stamp)) return;
  tracks_ = motion.twist;
  const bool travel_is_fresh = last_travel_ && motion.stamp - *last_travel_ < kOdometryGone;
  if (travel_is_fresh || !before) {
    if (!travel_is_fresh) tracks_at_ = motion.stamp;
    return;
  }
  const double dt_s = std::min(seconds(motion.stamp - *before), 0.2);
  step({motion.twist.linear_mps * dt_s, motion.twist.angular_radps * dt_s, dt_s}, motion.stamp);
}

void Estimator::step(const Travel& travel, Time stamp) noexcept {
  tracks_at_ = stamp;
  sums_.ahead_m += travel.ahead_m;
  sums_.turn_rad += travel.turn_rad;
  const double half_m = 0.5 * travel.turn_rad * params_.track_width_m;
  if (std::abs(travel.ahead_m) + std::abs(half_m) > kStill_m) moved_at_ = stamp;
  watch_standing(stamp);
  if (located_) {
    predict(belief_, travel, drift_, standing_ && travel.ahead_m == 0.0 && travel.turn_rad == 0.0);
  } else if (heading_known_) {
    belief_.x(kYaw) = base::wrap_rad(belief_.x(kYaw) + belief_.x(kYawScale) * travel.turn_rad);
  }
  filter_at_ = stamp;
  sums_.stamp = stamp;
  sums_.x = belief_.x;
  history_.push(sums_);
}

void Estimator::watch_standing(Time stamp) noexcept {
  standing_ = stamp - moved_at_ >= kStandsAfter;
  if (!standing_) has_moved_ = true;
}

// ---- time --------------------------------------------------------------------------------------

void Estimator::advance(Time now) noexcept {
  now_ = now;
  if (!filter_at_) filter_at_ = now;
  if (has_odometry(now)) return;
  standing_ = false;
  const double dt_s = seconds(now - *filter_at_);
  if (dt_s <= 0.0) return;
  if (located_) {
    predict_coasting(belief_, coast(now), dt_s, drift_);
  }
  tracks_ = {};
  filter_at_ = now;
  sums_.stamp = now;
  sums_.x = belief_.x;
  history_.push(sums_);
}

/// The last velocity over ground, which is worth less every moment; without any it may stand or
/// drive, nobody knows.
Coast Estimator::coast(Time now) const noexcept {
  Coast c;
  c.sigma_mps = kBlindSpeed_mps;
  const double age_s = velocity_ ? seconds(now - velocity_->stamp) : 1e9;
  if (age_s < seconds(kGnssGone)) {
    c.velocity_mps = {velocity_->east_mps, velocity_->north_mps};
    c.sigma_mps = std::min(kCoastSpeed_mps + kCoastAccel_mps2 * age_s, kBlindSpeed_mps);
  }
  const auto known = std::max(tracks_at_, last_fused_);
  c.blind_s = known ? std::max(0.0, seconds(now - *known)) : 0.0;
  return c;
}

std::optional<base::Pose> Estimator::pose(Time now) const {
  if (!located_ || !frame_ || !filter_at_) return std::nullopt;
  base::Pose p;
  const bool odometry = has_odometry(now);
  const bool gnss = last_fused_ && now - *last_fused_ < kGnssGone;
  const bool velocity = velocity_ && now - velocity_->stamp < kGnssGone;
  // Carried on from something fresh it is of now; from nothing it grows old.
  const auto velocity_at = velocity_ ? std::optional(velocity_->stamp) : std::nullopt;
  const auto last_word = std::max({tracks_at_, last_fused_, velocity_at});
  p.stamp = odometry || gnss || velocity ? now : last_word.value_or(now);
  p.yaw_rad = belief_.x(kYaw);
  p.at = {belief_.x(kEast), belief_.x(kNorth)};
  if (odometry) {
    const double speed_mps = belief_.x(kScale) * tracks_.linear_mps;
    const double yaw_rate_radps =
        belief_.x(kYawScale) * tracks_.angular_radps + belief_.x(kPull) * tracks_.linear_mps;
    const double dt_s = std::clamp(seconds(now - *filter_at_), 0.0, 0.2);
    const double middle_rad = p.yaw_rad + 0.5 * yaw_rate_radps * dt_s;
    p.at.east_m += speed_mps * dt_s * std::cos(middle_rad);
    p.at.north_m += speed_mps * dt_s * std::sin(middle_rad);
    p.yaw_rad = base::wrap_rad(p.yaw_rad + yaw_rate_radps * dt_s);
    p.speed_mps = speed_mps;
    p.yaw_rate_radps = yaw_rate_radps;
  } else if (velocity) {
    p.speed_mps = std::hypot(velocity_->east_mps, velocity_->north_mps);
  }
  p.global = frame_->to_global(p.at);
  const double a = belief_.P(kEast, kEast);
  const double b = belief_.P(kNorth, kNorth);
  const double c = belief_.P(kEast, kNorth);
  p.horizontal_sigma_m = std::sqrt(std::max(0.0, 0.5 * (a + b) + std::hypot(0.5 * (a - b), c)));
  p.yaw_sigma_rad = heading_known_ ? std::sqrt(std::max(0.0, belief_.P(kYaw, kYaw))) : base::kPi;
  p.alt_msl_m = alt_msl_m_;
  p.source = !odometry ? "gnss" : gnss ? "gnss+odometry" : "odometry";
  return p;
}

base::EstimatorHealth Estimator::health() const noexcept {
  return {belief_.x(kBias), belief_.x(kScale), belief_.x(kPull), rejected_, resets_};
}

}  // namespace roverd::nav
