// The estimator's measurements: what each of them says, and what happens when it is not believed.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using base::seconds;
using std::chrono::milliseconds;

}  // namespace

template <int M>
bool Estimator::apply(const Observation<M>& o) noexcept {
  StateVector change;
  if (!update(belief_, o, change)) return false;
  history_.shift(change);
  return true;
}

// ---- heading -----------------------------------------------------------------------------------

void Estimator::set_heading(double yaw_rad, double sigma_rad) noexcept {
  StateVector change = StateVector::Zero();
  change(kYaw) = base::angle_diff_rad(belief_.x(kYaw), yaw_rad);
  reset_state(belief_, kYaw, base::wrap_rad(yaw_rad), sigma_rad);
  history_.shift(change);
  heading_known_ = true;
}

void Estimator::take(const base::Heading& heading) {
  if (!std::isfinite(heading.yaw_rad)) return reject();
  if (!in_order(last_heading_, heading.stamp)) return;
  const bool compass = heading.source == base::HeadingSource::Compass;
  const auto past = history_.at(heading.stamp - base::from_seconds(params_.compass_latency_s));
  const double turned_since = past ? base::angle_diff_rad(past->x(kYaw), belief_.x(kYaw)) : 0.0;
  const double sigma_rad =
      rad_from_deg(compass ? params_.compass_sigma_deg : params_.heading_sigma_deg);
  if (!heading_known_) {
    const double bias_rad = compass ? rad_from_deg(params_.compass_bias_sigma_deg) : 0.0;
    set_heading(heading.yaw_rad + turned_since, std::hypot(sigma_rad, bias_rad));
    if (compass) {
      // yaw = shown − bias: what one is too large the other is too small.
      reset_state(belief_, kBias, 0.0, bias_rad);
      belief_.P(kYaw, kBias) = belief_.P(kBias, kYaw) = -bias_rad * bias_rad;
    }
    last_heading_fused_ = heading.stamp;
    return;
  }
  const StateVector& at = past ? past->x : belief_.x;
  Observation<1> o;
  o.innovation(0) = base::wrap_rad(heading.yaw_rad - at(kYaw) - (compass ? at(kBias) : 0.0));
  o.H(0, kYaw) = 1.0;
  if (compass) o.H(0, kBias) = 1.0;
  o.R(0, 0) = sigma_rad * sigma_rad;
  o.gate = kGate1;
  if (standing_ && compass && has_moved_) {
    o.may_change.setZero();
    o.may_change(kBias) = 1.0;
  }
  if (apply(o)) {
    compass_off_since_.reset();
    last_heading_fused_ = heading.stamp;
    return;
  }
  reject();
  if (!compass_off_since_) compass_off_since_ = heading.stamp;
  if (heading.stamp - *compass_off_since_ < std::chrono::seconds(5)) return;
  // The iron around it changed, or the robot was turned by hand: learn the compass anew.
  const double open_rad = rad_from_deg(params_.compass_bias_sigma_deg);
  reset_state(belief_, kBias, base::angle_diff_rad(at(kYaw), heading.yaw_rad), open_rad);
  compass_off_since_.reset();
}

// ---- position ----------------------------------------------------------------------------------

bool Estimator::settled(const base::GnssFix& fix) noexcept {
  if (fix.fix != fix_type_) {
    fix_type_ = fix.fix;
    fix_type_since_ = fix.stamp;
  }
  return fix.stamp - fix_type_since_ >= std::chrono::seconds(3);
}

void Estimator::set_drift(const Drift& drift) noexcept {
  if (drift.sigma_m == drift_.sigma_m && drift.tau_s == drift_.tau_s) return;
  for (const StateIndex i : {kDriftE, kDriftN}) {
    if (drift.sigma_m == 0.0 || drift_.sigma_m == 0.0) {
      // What RTK fixed knows of the position stays; the offset of the new class is open.
      reset_state(belief_, i, 0.0, drift.sigma_m);
    } else {
      const double more = drift.sigma_m * drift.sigma_m - drift_.sigma_m * drift_.sigma_m;
      belief_.P(i, i) += std::max(0.0, more);
    }
  }
  drift_ = drift;
}

void Estimator::take(const base::GnssFix& fix) {
  if (!in_order(last_fix_, fix.stamp)) return;
  const bool is_settled = settled(fix);
  const auto quality = gnss_quality(fix, is_settled, params_.drift_scale);
  if (!quality) {
    if (fix.position && !base::is_valid(*fix.position)) reject();
    return;
  }
  if (fix.alt_msl_m && std::isfinite(*fix.alt_msl_m)) alt_msl_m_ = fix.alt_msl_m;
  if (!located_) {
    first_fix(fix, *quality);
    return;
  }
  set_drift(quality->drift);
  fuse_position(fix, *quality);
}

void Estimator::first_fix(const base::GnssFix& fix, const GnssQuality& q) {
  const bool reachable =
      frame_ && base::distance_bearing(frame_->origin(), *fix.position).distance_m <
                    base::LocalFrame::kReach_m;
  if (!reachable) frame_.emplace(next_frame_id_, *fix.position);
  drift_ = q.drift;
  reset_position(frame_->to_local(*fix.position), q);
  located_ = true;
  last_fused_ = fix.stamp;
}

void Estimator::reset_position(base::EnuPoint at, const GnssQuality& q) noexcept {
  const double drift_var = q.drift.sigma_m * q.drift.sigma_m;
  const double arm_m =
      heading_known_ ? 0.0 : std::hypot(params_.antenna_forward_m, params_.antenna_left_m);
  if (heading_known_) {
    const double c = std::cos(belief_.x(kYaw));
    const double s = std::sin(belief_.x(kYaw));
    at.east_m -= c * params_.antenna_forward_m - s * params_.antenna_left_m;
    at.north_m -= s * params_.antenna_forward_m + c * params_.antenna_left_m;
  }
  StateVector change = StateVector::Zero();
  change(kEast) = at.east_m - belief_.x(kEast);
  change(kNorth) = at.north_m - belief_.x(kNorth);
  reset_state(belief_, kEast, at.east_m, std::hypot(q.sigma_east_m, q.drift.sigma_m, arm_m));
  reset_state(belief_, kNorth, at.north_m, std::hypot(q.sigma_north_m, q.drift.sigma_m, arm_m));
  reset_state(belief_, kDriftE, 0.0, q.drift.sigma_m);
  reset_state(belief_, kDriftN, 0.0, q.drift.sigma_m);
  belief_.P(kEast, kDriftE) = belief_.P(kDriftE, kEast) = -drift_var;
  belief_.P(kNorth, kDriftN) = belief_.P(kDriftN, kNorth) = -drift_var;
  history_.shift(change);
}

void Estimator::fuse_position(const base::GnssFix& fix, const GnssQuality& q) noexcept {
  const auto past = history_.at(fix.stamp - base::from_seconds(params_.gnss_latency_s));
  const StateVector& at = past ? past->x : belief_.x;
  // E: ENU at the datum. B: body. A: antenna. p_EA = p_EB + R_EB · p_BA.
  const double c = std::cos(at(kYaw));
  const double s = std::sin(at(kYaw));
  const double arm_e = c * params_.antenna_forward_m - s * params_.antenna_left_m;
  const double arm_n = s * params_.antenna_forward_m + c * params_.antenna_left_m;
  const base::EnuPoint z = frame_->to_local(*fix.position);

  Observation<2> o;
  o.innovation << z.east_m - at(kEast) - at(kDriftE) - arm_e,
      z.north_m - at(kNorth) - at(kDriftN) - arm_n;
  o.H(0, kEast) = o.H(1, kNorth) = 1.0;
  if (q.drift.sigma_m > 0.0) o.H(0, kDriftE) = o.H(1, kDriftN) = 1.0;
  if (heading_known_) {
    o.H(0, kYaw) = -arm_n;
    o.H(1, kYaw) = arm_e;
  }
  o.R(0, 0) = q.sigma_east_m * q.sigma_east_m;
  o.R(1, 1) = q.sigma_north_m * q.sigma_north_m;
  o.gate = kGate2;
  if (standing_) {
    const bool hold_place = has_moved_ && q.drift.sigma_m > 0.0;
    o.may_change.setZero();
    o.may_change(kDriftE) = o.may_change(kDriftN) = 1.0;
    if (!hold_place) o.may_change(kEast) = o.may_change(kNorth) = 1.0;
  }
  if (apply(o)) {
    last_fused_ = fix.stamp;
    position_off_since_.reset();
    far_off_since_.reset();
    return;
  }
  reject();
  position_refused(fix, q, o.innovation.norm());
}

void Estimator::position_refused(const base::GnssFix& fix, const GnssQuality& q,
                                 double off_m) noexcept {
  if (!position_off_since_) position_off_since_ = fix.stamp;
  if (off_m <= 25.0) far_off_since_.reset();
  if (off_m > 25.0 && !far_off_since_) far_off_since_ = fix.stamp;
  const double off_s = seconds(fix.stamp - *position_off_since_);
  const bool far = far_off_since_ && fix.stamp - *far_off_since_ >= std::chrono::seconds(1);
  if (off_s >= 10.0 || far) {
    reset_position(frame_->to_local(*fix.position), q);
    position_off_since_.reset();
    far_off_since_.reset();
    last_fused_ = fix.stamp;
    ++resets_;
  } else if (off_s > 2.0) {
    // Doubt grows, slowly enough that a jump of 3 m is not believed within 5 s.
    belief_.P(kEast, kEast) += 0.01;
    belief_.P(kNorth, kNorth) += 0.01;
  }
}

// ---- velocity ----------------------------------------------------------------------------------

void Estimator::take(const base::GnssVelocity& velocity) {
  if (!std::isfinite(velocity.east_mps) || !std::isfinite(velocity.north_mps)) return reject();
  if (!in_order(last_velocity_, velocity.stamp)) return;
  velocity_ = velocity;
  if (!located_) return;
  const double sigma_mps = velocity_sigma_mps(fix_type_, velocity.sigma_mps);
  if (has_odometry(velocity.stamp)) {
    fuse_velocity(velocity, sigma_mps);
  } else {
    fuse_course(velocity, sigma_mps);
  }
}

/// A receiver alone, carried by something that drives forward: its course is the heading.
void Estimator::fuse_course(const base::GnssVelocity& velocity, double sigma_mps) noexcept {
  const double speed = std::hypot(velocity.east_mps, velocity.north_mps);
  if (speed < 3.0 * sigma_mps || speed < 0.3) return;
  const double course = std::atan2(velocity.north_mps, velocity.east_mps);
  const double sigma = std::hypot(sigma_mps / speed, rad_from_deg(5.0));
  if (!heading_known_) {
    set_heading(course, sigma);
    return;
  }
  Observation<1> o;
  o.innovation(0) = base::angle_diff_rad(belief_.x(kYaw), course);
  o.H(0, kYaw) = 1.0;
  o.R(0, 0) = sigma * sigma;
  apply(o);
}

void Estimator::fuse_velocity(const base::GnssVelocity& velocity, double sigma_mps) noexcept {
  const Time t = velocity.stamp - base::from_seconds(params_.gnss_latency_s);
  const auto at = history_.at(t);
  const auto before = history_.at(t - milliseconds(50));
  const auto after = history_.at(t + milliseconds(50));
  if (!at || !before || !after || before->stamp >= after->stamp) return;
  const double dt_s = seconds(after->stamp - before->stamp);
  const double v_odo = (after->ahead_m - before->ahead_m) / dt_s;
  const double w_odo = (after->turn_rad - before->turn_rad) / dt_s;
  const double v = at->x(kScale) * v_odo;
  const double w = at->x(kYawScale) * w_odo + at->x(kPull) * v_odo;
  if (std::abs(v) < 0.15) return;

  if (!heading_known_) {
    // Reversing, the body points the other way.
    const double course = std::atan2(velocity.north_mps, velocity.east_mps);
    const double facing = course + (v < 0.0 ? base::kPi : 0.0);
    const double turned_since = base::angle_diff_rad(at->x(kYaw), belief_.x(kYaw));
    const double speed = std::hypot(velocity.east_mps, velocity.north_mps);
    if (speed > 3.0 * sigma_mps) set_heading(facing + turned_since, sigma_mps / speed + 0.05);
    return;
  }
  const double c = std::cos(at->x(kYaw));
  const double s = std::sin(at->x(kYaw));
  const double arm_e = c * params_.antenna_forward_m - s * params_.antenna_left_m;
  const double arm_n = s * params_.antenna_forward_m + c * params_.antenna_left_m;
  Observation<2> o;
  o.innovation << velocity.east_mps - (v * c - w * arm_n), velocity.north_mps - (v * s + w * arm_e);
  o.H(0, kYaw) = -v * s - w * arm_e;
  o.H(1, kYaw) = v * c - w * arm_n;
  o.H(0, kScale) = v_odo * c;
  o.H(1, kScale) = v_odo * s;
  // While turning, an error of the latency shows as one of the direction.
  const double turning = 0.05 * std::abs(w * v);
  o.R(0, 0) = o.R(1, 1) = sigma_mps * sigma_mps + turning * turning;
  o.gate = kGate2;
  if (apply(o)) {
    velocity_off_since_.reset();
    return;
  }
  reject();
  velocity_refused(velocity, v, sigma_mps);
}

void Estimator::velocity_refused(const base::GnssVelocity& velocity, double ahead_mps,
                                 double sigma_mps) noexcept {
  const double speed = std::hypot(velocity.east_mps, velocity.north_mps);
  const bool moving = speed > std::max(0.2, 3.0 * sigma_mps) && std::abs(ahead_mps) > 0.2;
  if (!moving) {
    velocity_off_since_.reset();
    return;
  }
  if (!velocity_off_since_) velocity_off_since_ = velocity.stamp;
  if (velocity.stamp - *velocity_off_since_ < std::chrono::seconds(2)) return;
  // Two seconds of moving elsewhere than the heading says: the heading is wrong, not the receiver.
  const double course = std::atan2(velocity.north_mps, velocity.east_mps);
  set_heading(course + (ahead_mps < 0.0 ? base::kPi : 0.0), sigma_mps / speed + 0.05);
  reset_state(belief_, kBias, belief_.x(kBias), base::kPi);
  // What was driven with the wrong heading went to the wrong place.
  for (const StateIndex i : {kEast, kNorth}) {
    reset_state(belief_, i, belief_.x(i), 2.0 + std::sqrt(belief_.P(i, i)));
  }
  velocity_off_since_.reset();
  ++resets_;
}

}  // namespace roverd::nav
