#include "nav/track/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kSameLane = -0.5;  // cosine of the largest turn within what is looked at at once

using base::angle_diff_rad;
using base::rad_from_deg;

constexpr double kStill_mps = 0.03;
constexpr double kStill_radps = 0.06;
constexpr double kStillFor_s = 0.1;
constexpr double kTurned_radps = 0.15;
constexpr double kTurnedFor_s = 0.1;
const double kArcInstead_rad = rad_from_deg(50.0);
constexpr double kNear_m = 0.3;  // closer to the path, its direction counts, not the way to it

bool finite(const Vehicle& v) noexcept {
  return std::isfinite(v.at.east_m) && std::isfinite(v.at.north_m) && std::isfinite(v.yaw_rad) &&
         std::isfinite(v.yaw_sigma_rad) && std::isfinite(v.speed_mps) &&
         std::isfinite(v.yaw_rate_radps) && std::isfinite(v.odometry_scale) &&
         std::isfinite(v.roll_rad) && std::isfinite(v.pitch_rad) && std::isfinite(v.yaw_scale) &&
         std::isfinite(v.pull_1pm) && v.odometry_scale > 0.0 && v.yaw_scale > 0.0 &&
         std::isfinite(v.crab) && std::isfinite(v.slide.east_m) && std::isfinite(v.slide.north_m);
}

}  // namespace

double course_off_rad(const Vehicle& v, bool reverse) noexcept {
  const double tail = reverse ? -1.0 : 1.0;
  const double c = tail * std::cos(v.yaw_rad);
  const double s = tail * std::sin(v.yaw_rad);
  const double ahead = v.odometry_scale + c * v.slide.east_m + s * v.slide.north_m;
  const double left = v.crab - s * v.slide.east_m + c * v.slide.north_m;
  return std::clamp(std::atan2(left, std::max(0.2, ahead)), -0.5, 0.5);
}

void Tracker::enter(TrackPhase phase) noexcept {
  phase_ = phase;
  still_s_ = astray_s_ = turning_s_ = 0.0;
  too_steep_ = false;
  if (phase != TrackPhase::Track) proof_mps_.reset();
  if (phase != TrackPhase::Track) accel_mps2_ = 0.0;
}

void Tracker::begin(const Path& path, std::size_t leg, double s_m) noexcept {
  const bool stands = phase_ == TrackPhase::Done;  // seen at this tick: no need to see it again
  path_ = &path;
  leg_ = leg;
  if (leg_ >= path.legs.size()) {
    enter(TrackPhase::Done);
    return;
  }
  s_m_ = std::clamp(s_m, leg_now().start_m, leg_now().end_m);
  segment_ = path.segment_at(leg_now(), s_m_, leg_now().first);
  cross_track_m_ = 0.0;
  enter(TrackPhase::Settle);
  if (stands) still_s_ = kStillFor_s;
}

void Tracker::begin_turn(double yaw_rad) noexcept {
  path_ = nullptr;
  leg_ = 0;
  turn_to_rad_ = yaw_rad;
  const bool can = turning_on_the_spot(params_->vehicle) && std::isfinite(yaw_rad);
  enter(can ? TrackPhase::Settle : TrackPhase::Done);
}

void Tracker::reset() noexcept {
  path_ = nullptr;
  enter(TrackPhase::Idle);
  speed_mps_ = rate_radps_ = wheel_rad_ = 0.0;
  saturated_ = false;
  observer_.reset();
  sent_.fill({});
}

void Tracker::move_to(const Path& path, std::size_t leg, double s_m) noexcept {
  const bool done = phase_ == TrackPhase::Done || phase_ == TrackPhase::Stop;
  const bool same_leg = path_ != nullptr && leg == leg_;
  if (leg >= path.legs.size() || !same_leg || done) return begin(path, leg, s_m);
  path_ = &path;
  s_m_ = std::clamp(s_m, leg_now().start_m, leg_now().end_m);
  segment_ = path.segment_at(leg_now(), s_m_, leg_now().first);
}

TrackOutput Tracker::step(const Vehicle& vehicle, double limit_mps, double dt_s) noexcept {
  TrackOutput out;
  const bool usable = finite(vehicle) && dt_s > 0.0 && !std::isnan(limit_mps);
  const TrackPhase phase = usable ? phase_ : TrackPhase::Idle;
  switch (phase) {
    case TrackPhase::Idle:
    case TrackPhase::Done:
      speed_mps_ = rate_radps_ = 0.0;
      break;
    case TrackPhase::Settle:
      out = settle(vehicle, dt_s);
      break;
    case TrackPhase::Pivot:
      out = pivot(vehicle, dt_s);
      break;
    case TrackPhase::Track:
      out = track(vehicle, limit_mps, dt_s);
      break;
    case TrackPhase::Stop:
      out = stop(vehicle, dt_s);
      break;
    case TrackPhase::Turn:
      out = turn(vehicle, dt_s);
      break;
  }
  const bool moves = out.command.linear_mps != 0.0 || out.command.angular_radps != 0.0;
  const bool counter = moves && phase_ == TrackPhase::Track;
  sent_at_ = (sent_at_ + 1) % sent_.size();
  sent_[sent_at_] = {speed_mps_, rate_radps_ - (counter ? observer_.radps() : 0.0)};
  return out;
}

bool Tracker::still(const Vehicle& v, double dt_s) noexcept {
  const bool now = speed_mps_ == 0.0 && rate_radps_ == 0.0 && std::abs(v.speed_mps) < kStill_mps &&
                   std::abs(v.yaw_rate_radps) < kStill_radps;
  still_s_ = now ? still_s_ + dt_s : 0.0;
  return still_s_ >= kStillFor_s;
}

Tracker::Projection Tracker::project(EnuPoint at, double s_m, double ahead_m) const noexcept {
  const Leg& leg = leg_now();
  const double from_m = std::max(leg.start_m, s_m - 0.3);
  const double to_m = std::min(leg.end_m, s_m + ahead_m);
  Projection best;
  double best_m = 1e300;
  const std::size_t here = path_->segment_at(leg, s_m, segment_);
  const EnuPoint way = path_->points[here + 1].at - path_->points[here].at;
  const double way_m = std::hypot(way.east_m, way.north_m);
  for (std::size_t i = path_->segment_at(leg, from_m, segment_); i < leg.last; ++i) {
    const PathPoint& a = path_->points[i];
    const PathPoint& b = path_->points[i + 1];
    if (a.s_m > to_m) break;
    const double length = b.s_m - a.s_m;
    const EnuPoint d = b.at - a.at;
    // Behind a turn that is still to come: the lane beside this one.
    const double same = d.east_m * way.east_m + d.north_m * way.north_m;
    if (i > here && same < kSameLane * length * way_m) continue;
    const EnuPoint p = at - a.at;
    const double c = d.east_m / length;
    const double s = d.north_m / length;
    const double along = std::clamp(c * p.east_m + s * p.north_m, std::max(0.0, from_m - a.s_m),
                                    std::max(0.0, std::min(length, to_m - a.s_m)));
    const double off_m = std::hypot(p.east_m - along * c, p.north_m - along * s);
    if (off_m < best_m) {
      best_m = off_m;
      const double bend = a.curvature_1pm * (along - 0.5 * length);
      best = {a.s_m + along, c * p.north_m - s * p.east_m, std::atan2(s, c) + bend, i};
    }
  }
  return best;
}

/// Beyond the leg's end its last direction goes on.
EnuPoint Tracker::point_ahead(const Projection& from, double by_m) const noexcept {
  const Leg& leg = leg_now();
  const double s_m = from.s_m + by_m;
  const std::size_t i = path_->segment_at(leg, s_m, from.segment);
  const PathPoint& a = path_->points[i];
  const PathPoint& b = path_->points[i + 1];
  const double part = (s_m - a.s_m) / (b.s_m - a.s_m);
  return {a.at.east_m + part * (b.at.east_m - a.at.east_m),
          a.at.north_m + part * (b.at.north_m - a.at.north_m)};
}

/// How far the vehicle must turn to drive on; reversing, its tail points along the path.
double Tracker::facing_error(const Vehicle& v, const Projection& on) const noexcept {
  double wanted = on.tangent_rad;
  if (std::abs(on.cross_m) > kNear_m) {
    const EnuPoint d = point_ahead(on, lookahead_m(0.0, on.cross_m, params_->track)) - v.at;
    wanted = std::atan2(d.north_m, d.east_m);
  }
  if (leg_now().reverse) wanted += base::kPi;
  return angle_diff_rad(v.yaw_rad + course_off_rad(v, leg_now().reverse), wanted);
}

TrackOutput Tracker::command(const Vehicle& v, double speed_mps, double rate_radps,
                             SpeedReason reason) noexcept {
  speed_mps_ = speed_mps;
  rate_radps_ = rate_radps;
  saturated_ = false;
  base::BodyTwist t;
  if (speed_mps == 0.0 && rate_radps == 0.0) return {t, reason};
  const double counter = phase_ == TrackPhase::Track ? observer_.radps() : 0.0;
  t.linear_mps = speed_mps / v.odometry_scale;
  t.angular_radps = (rate_radps - counter - v.pull_1pm * t.linear_mps) / v.yaw_scale;
  const double most = params_->speed.max_yaw_rate_radps;
  if (std::abs(t.angular_radps) > most) {
    const double part = most / std::abs(t.angular_radps);
    t.linear_mps *= part;
    t.angular_radps *= part;
    speed_mps_ *= part;
    rate_radps_ *= part;
    saturated_ = true;
    if (speed_mps != 0.0) reason = SpeedReason::Turn;
  }
  return {t, reason};
}

bool too_steep_to_turn(const Vehicle& v, const SlopeParams& p) noexcept {
  return lean_rad(v.roll_rad, v.pitch_rad) > rad_from_deg(p.pivot_deg);
}

/// On a slope that is too steep for it, a slight turn is driven as an arc instead.
bool Tracker::slight(const Vehicle& v, double error_rad) const noexcept {
  return too_steep_to_turn(v, params_->slope) && std::abs(error_rad) < kArcInstead_rad;
}

/// Turning on the spot it would lean to each side in turn, and slide.
bool Tracker::may_pivot(const Vehicle& v) noexcept {
  too_steep_ = too_steep_to_turn(v, params_->slope);
  return !too_steep_;
}

TrackOutput Tracker::settle(const Vehicle& v, double dt_s) noexcept {
  const double step = params_->speed.hold_decel_mps2 * dt_s;
  const double turn_step = params_->pivot.slew_radps2 * dt_s;
  if (still(v, dt_s)) {
    if (path_ == nullptr) {
      if (may_pivot(v)) enter(TrackPhase::Turn);
      return command(v, 0.0, 0.0, SpeedReason::Stopping);
    }
    const Projection on = project(v.at, s_m_, 1.0);
    cross_track_m_ = leg_now().reverse ? -on.cross_m : on.cross_m;
    const double error_rad = facing_error(v, on);
    const bool away = std::abs(error_rad) > leg_now().align_rad;
    if (!away || slight(v, error_rad)) {
      enter(TrackPhase::Track);
    } else if (may_pivot(v)) {
      enter(TrackPhase::Pivot);
    }
  }
  return command(v, slew(speed_mps_, 0.0, step, step), slew(rate_radps_, 0.0, turn_step, turn_step),
                 SpeedReason::Stopping);
}

TrackOutput Tracker::pivot(const Vehicle& v, double dt_s) noexcept {
  const Vehicle soon = predict(v, dt_s);
  const Projection on = project(v.at, s_m_, 1.0);
  const TrackOutput out = turn_by(facing_error(v, on), facing_error(soon, on), v, dt_s);
  if (still_s_ >= kTurnedFor_s) enter(TrackPhase::Track);
  return out;
}

TrackOutput Tracker::turn(const Vehicle& v, double dt_s) noexcept {
  const Vehicle soon = predict(v, dt_s);
  const TrackOutput out = turn_by(angle_diff_rad(v.yaw_rad, turn_to_rad_),
                                  angle_diff_rad(soon.yaw_rad, turn_to_rad_), v, dt_s);
  if (still_s_ >= kTurnedFor_s && rate_radps_ == 0.0 && std::abs(v.yaw_rate_radps) < kStill_radps) {
    enter(TrackPhase::Done);
  }
  return out;
}

/// One step of a turn on the spot. still_s_ tells for how long it is there.
TrackOutput Tracker::turn_by(double error_rad, double error_soon_rad, const Vehicle& v,
                             double dt_s) noexcept {
  turning_s_ += dt_s;
  const double done = rad_from_deg(params_->pivot.done_deg);
  const bool there = std::abs(error_rad) < done && std::abs(v.yaw_rate_radps) < kTurned_radps;
  still_s_ = there ? still_s_ + dt_s : 0.0;
  double wanted = std::abs(error_soon_rad) < 0.5 * done
                      ? 0.0
                      : pivot_rate_radps(error_soon_rad, params_->pivot);
  // It brakes by itself; turning back before it stands is for a turn that went too far.
  if (wanted * v.yaw_rate_radps < 0.0 && std::abs(v.yaw_rate_radps) > kStill_radps) wanted = 0.0;
  const double step = params_->pivot.slew_radps2 * dt_s;
  return command(v, 0.0, slew(rate_radps_, wanted, step, step), SpeedReason::Pivot);
}

TrackOutput Tracker::stop(const Vehicle& v, double dt_s) noexcept {
  const Projection on = project(v.at, s_m_, 1.0);
  s_m_ = std::max(s_m_, on.s_m);
  cross_track_m_ = leg_now().reverse ? -on.cross_m : on.cross_m;
  const TrackOutput out = command(v, 0.0, 0.0, SpeedReason::Approach);
  if (still(v, dt_s)) {
    if (leg_now().end_m - s_m_ > params_->track.arrive_m) {
      enter(TrackPhase::Track);
    } else if (leg_now().end_yaw_rad && !may_pivot(v)) {
      return out;
    } else if (leg_now().end_yaw_rad) {
      turn_to_rad_ = *leg_now().end_yaw_rad;
      enter(TrackPhase::Turn);
    } else {
      enter(TrackPhase::Done);
    }
  }
  return out;
}

}  // namespace roverd::nav
