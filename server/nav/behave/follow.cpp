#include "nav/behave/follow.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {
namespace {

constexpr double kPredict_s = 1.0;
constexpr double kCourse_mps = 0.3;  ///< slower, and the course is not known
constexpr double kTrackStep_m = 0.3;
constexpr double kOnTrack_m = 5.0;  ///< a target farther ahead is followed where it went
constexpr double kJump_m = 2.0;     ///< less is no jump, however short the time
constexpr double kPlace_m = 0.3;    ///< with an offset: near enough to the place beside the target
constexpr double kGain_1ps = 0.5;

double speed_of(EnuPoint v) noexcept {
  return std::hypot(v.east_m, v.north_m);
}

}  // namespace

std::string Follow::take(const FollowTarget& t, const FollowOffset& offset) {
  const double passed_s = target_ ? base::seconds(t.stamp - target_->stamp) : 0.0;
  const bool old = !target_ || passed_s > modes_->follow_hold_s;
  if (!old) {
    if (passed_s <= 0.0) return "it is not newer than the last one";
    const EnuPoint expected{target_->at.east_m + velocity_.east_m * passed_s,
                            target_->at.north_m + velocity_.north_m * passed_s};
    const double off_m = base::distance_m(t.at, expected);
    if (off_m > kJump_m && off_m / passed_s > modes_->follow_jump_mps) {
      return "it jumped by " + std::to_string(std::lround(off_m)) + " m";
    }
  }
  if (t.velocity_mps) {
    velocity_ = *t.velocity_mps;
  } else if (old) {
    velocity_ = {};
  } else {
    const double part = std::clamp(passed_s / 0.5, 0.1, 1.0);
    const EnuPoint way = t.at - target_->at;
    velocity_.east_m += part * (way.east_m / passed_s - velocity_.east_m);
    velocity_.north_m += part * (way.north_m / passed_s - velocity_.north_m);
  }
  if (old) track_.clear();
  if (speed_of(velocity_) > kCourse_mps)
    course_rad_ = std::atan2(velocity_.north_m, velocity_.east_m);
  target_ = t;
  offset_ = offset;
  return {};
}

std::string Follow::refusal(EnuPoint here, base::Time now) const {
  if (!target_) return "no target has told where it is: PUT /vehicle/target";
  const double age_s = base::seconds(now - target_->stamp);
  if (age_s > modes_->follow_brake_s) {
    return "the target was last heard " + std::to_string(std::lround(age_s)) + " s ago";
  }
  const double far_m = base::distance_m(here, target_->at);
  if (far_m > modes_->follow_max_m) {
    return "the target is " + std::to_string(std::lround(far_m)) + " m away; at most " +
           std::to_string(std::lround(modes_->follow_max_m)) + " m are followed";
  }
  return {};
}

void Follow::reset() noexcept {
  state_ = State::Waiting;
  reason_.clear();
  track_.clear();
  speed_mps_ = rate_radps_ = 0.0;
  pivots_ = false;
}

EnuPoint Follow::predicted(base::Time now) const noexcept {
  const double ahead_s = std::clamp(base::seconds(now - target_->stamp), 0.0, kPredict_s);
  return {target_->at.east_m + velocity_.east_m * ahead_s,
          target_->at.north_m + velocity_.north_m * ahead_s};
}

EnuPoint Follow::aim(base::Time now) const noexcept {
  EnuPoint p = predicted(now);
  switch (offset_.frame) {
    case FollowOffset::Frame::None:
      break;
    case FollowOffset::Frame::North:
      p = p + EnuPoint{offset_.a_m, offset_.b_m};
      break;
    case FollowOffset::Frame::Course: {
      const double c = std::cos(course_rad_);
      const double s = std::sin(course_rad_);
      p = p + EnuPoint{offset_.a_m * c - offset_.b_m * s, offset_.a_m * s + offset_.b_m * c};
      break;
    }
  }
  return p;
}

void Follow::lay_track(EnuPoint at) {
  if (!track_.empty() && base::distance_m(track_.back(), at) < kTrackStep_m) return;
  if (track_.size() >= kTrack) track_.erase(track_.begin());
  track_.push_back(at);
}

/// The point to steer to, and the length of the way to the aim.
EnuPoint Follow::ahead(const Vehicle& v, EnuPoint at, double look_m, double& gap_m) {
  const double straight_m = base::distance_m(v.at, at);
  // What the robot has passed is done with: everything before the nearest point.
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < track_.size(); ++i) {
    if (base::distance_m(track_[i], v.at) < base::distance_m(track_[nearest], v.at)) nearest = i;
  }
  track_.erase(track_.begin(), track_.begin() + static_cast<std::ptrdiff_t>(nearest));
  if (straight_m <= kOnTrack_m || track_.size() < 2) {
    gap_m = straight_m;
    return at;
  }
  EnuPoint from = v.at;
  EnuPoint target = at;
  bool found = false;
  gap_m = 0.0;
  for (std::size_t i = 0; i <= track_.size(); ++i) {
    const EnuPoint to = i < track_.size() ? track_[i] : at;
    gap_m += base::distance_m(from, to);
    if (!found && base::distance_m(v.at, to) >= look_m) {
      target = to;
      found = true;
    }
    from = to;
  }
  return target;
}

TrackOutput Follow::stand(double dt_s) noexcept {
  const double down = path_->speed.hold_decel_mps2 * dt_s;
  speed_mps_ = slew(speed_mps_, 0.0, down, down);
  const double change = path_->speed.yaw_accel_radps2 * dt_s;
  rate_radps_ = slew(rate_radps_, 0.0, change, change);
  return {{}, speed_mps_ > 0.0 ? SpeedReason::Stopping : SpeedReason::Standing};
}

TrackOutput Follow::command(const Vehicle& v, EnuPoint to, double wanted_mps,
                            double dt_s) noexcept {
  const SpeedParams& p = path_->speed;
  // Where it will be when this begins to act.
  const double T = path_->track.delay_s;
  Vehicle soon = v;
  soon.yaw_rad = base::wrap_rad(v.yaw_rad + rate_radps_ * T);
  soon.at.east_m += speed_mps_ * T * std::cos(v.yaw_rad + 0.5 * rate_radps_ * T);
  soon.at.north_m += speed_mps_ * T * std::sin(v.yaw_rad + 0.5 * rate_radps_ * T);
  const BodyPoint target = to_body(to, soon.at, soon.yaw_rad);
  const double bearing = std::atan2(target.y_m, target.x_m);
  const double begins = base::rad_from_deg(path_->pivot.angle_deg);
  const bool spot =
      !path_->vehicle.steered() && std::abs(bearing) > (pivots_ ? 0.25 * begins : begins);
  pivots_ = spot;
  SpeedReason reason = SpeedReason::Item;
  if (spot) {
    wanted_mps = 0.0;
    reason = SpeedReason::Pivot;
  } else {
    const double curvature = arc_curvature_1pm(target);
    const double bend = bend_mps(curvature, p.lateral_mps2);
    const double turn = p.max_yaw_rate_radps / std::max(1e-6, std::abs(curvature));
    if (std::min(bend, turn) < wanted_mps) {
      wanted_mps = std::min(bend, turn);
      reason = SpeedReason::Bend;
    }
  }
  speed_mps_ = slew(speed_mps_, wanted_mps, p.accel_mps2 * dt_s, p.hold_decel_mps2 * dt_s);
  double rate = 0.0;
  if (spot) {
    rate = speed_mps_ > 0.05 ? 0.0 : pivot_rate_radps(bearing, path_->pivot);
  } else if (path_->vehicle.steered() && target.x_m < 0.0) {
    const double lock =
        std::tan(base::rad_from_deg(path_->vehicle.max_steering_deg)) / path_->vehicle.wheelbase_m;
    rate = std::copysign(lock, target.y_m) * speed_mps_;
  } else {
    rate = arc_curvature_1pm(target) * speed_mps_;
  }
  const double change = p.yaw_accel_radps2 * dt_s;
  rate_radps_ = slew(rate_radps_, rate, change, change);
  return {track_twist(v, speed_mps_, rate_radps_, *path_), reason};
}

TrackOutput Follow::step(const Vehicle& v, double limit_mps, base::Time now, double dt_s) {
  if (state_ == State::Lost || !target_) return stand(dt_s);
  const double age_s = base::seconds(now - target_->stamp);
  const EnuPoint at = predicted(now);
  const double near_m = base::distance_m(v.at, at);
  if (age_s > modes_->follow_hold_s || near_m > modes_->follow_max_m) {
    state_ = State::Lost;
    reason_ = age_s > modes_->follow_hold_s
                  ? "no target heard for " + std::to_string(std::lround(age_s)) + " s"
                  : "the target is " + std::to_string(std::lround(near_m)) + " m away";
    return stand(dt_s);
  }
  state_ = age_s > modes_->follow_brake_s ? State::Braking : State::Following;
  const EnuPoint place = aim(now);
  lay_track(place);
  double gap_m = 0.0;
  const double look_m =
      std::max(path_->track.lookahead_min_m, path_->track.lookahead_time_s * std::abs(v.speed_mps));
  const EnuPoint to = ahead(v, place, look_m, gap_m);
  const bool beside = offset_.frame != FollowOffset::Frame::None;
  const double wanted_gap =
      beside ? kPlace_m : modes_->follow_gap_m + modes_->follow_gap_s * std::abs(v.speed_mps);
  const double along = near_m > 0.0
                           ? std::max(0.0, (velocity_.east_m * (place.east_m - v.at.east_m) +
                                            velocity_.north_m * (place.north_m - v.at.north_m)) /
                                               std::max(0.1, base::distance_m(v.at, place)))
                           : 0.0;
  double wanted = along + kGain_1ps * (gap_m - wanted_gap);
  wanted = std::min({wanted, path_->speed.max_mps, limit_mps});
  const bool too_near = near_m < modes_->follow_stop_m;
  if (too_near || state_ == State::Braking || wanted < 0.5 * path_->speed.min_mps) wanted = 0.0;
  if (wanted <= 0.0) {
    TrackOutput out = stand(dt_s);
    out.command = track_twist(v, speed_mps_, rate_radps_, *path_);
    return out;
  }
  return command(v, to, wanted, dt_s);
}

double Follow::distance_m(EnuPoint here) const noexcept {
  return target_ ? base::distance_m(here, target_->at) : 0.0;
}

}  // namespace roverd::nav
