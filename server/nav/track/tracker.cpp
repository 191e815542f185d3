#include "nav/track/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::angle_diff_rad;
using base::rad_from_deg;

constexpr double kStill_mps = 0.03;
constexpr double kStill_radps = 0.06;
constexpr double kStillFor_s = 0.1;
constexpr double kTightest_1pm = 1.0 / 0.25;
constexpr double kNear_m = 0.3;  // closer to the path, its direction counts, not that of a target
const double kAstray_rad = rad_from_deg(60.0);
constexpr double kAstrayFor_s = 0.3;

}  // namespace

void Tracker::begin(const Path& path, std::size_t leg, double s_m) noexcept {
  path_ = &path;
  leg_ = leg;
  if (leg_ >= path.legs.size()) {
    phase_ = TrackPhase::Done;
    return;
  }
  s_m_ = std::clamp(s_m, leg_now().start_m, leg_now().end_m);
  segment_ = path.segment_at(leg_now(), s_m_, leg_now().first);
  cross_track_m_ = 0.0;
  still_s_ = astray_s_ = 0.0;
  phase_ = TrackPhase::Settle;
}

void Tracker::reset() noexcept {
  path_ = nullptr;
  phase_ = TrackPhase::Idle;
  speed_mps_ = rate_radps_ = curvature_1pm_ = 0.0;
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
  switch (phase_) {
    case TrackPhase::Idle:
    case TrackPhase::Done:
      out = command(vehicle, 0.0, 0.0, SpeedReason::Standing);
      break;
    case TrackPhase::Settle:
      out = settle(vehicle, dt_s);
      break;
    case TrackPhase::Pivot:
      out = pivot(vehicle, dt_s);
      break;
    case TrackPhase::Follow:
      out = follow(vehicle, limit_mps, dt_s);
      break;
    case TrackPhase::Stop:
      out = stop(vehicle, dt_s);
      break;
  }
  sent_at_ = (sent_at_ + 1) % sent_.size();
  sent_[sent_at_] = {speed_mps_, rate_radps_};
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
  for (std::size_t i = path_->segment_at(leg, from_m, segment_); i < leg.last; ++i) {
    const PathPoint& a = path_->points[i];
    const PathPoint& b = path_->points[i + 1];
    if (a.s_m > to_m) break;
    const double length = b.s_m - a.s_m;
    const EnuPoint d = b.at - a.at;
    const EnuPoint p = at - a.at;
    const double c = d.east_m / length;
    const double s = d.north_m / length;
    const double along = std::clamp(c * p.east_m + s * p.north_m, std::max(0.0, from_m - a.s_m),
                                    std::min(length, to_m - a.s_m));
    const double off_m = std::hypot(p.east_m - along * c, p.north_m - along * s);
    if (off_m < best_m) {
      best_m = off_m;
      best = {a.s_m + along, c * p.north_m - s * p.east_m, std::atan2(s, c), i};
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

/// Where the vehicle will be when a command of now begins to act.
Vehicle Tracker::predict(const Vehicle& now, double dt_s) const noexcept {
  Vehicle v = now;
  if (dt_s <= 0.0) return v;
  const auto steps = std::min<std::size_t>(
      sent_.size(), static_cast<std::size_t>(std::lround(params_.track.delay_s / dt_s)));
  for (std::size_t k = steps; k-- > 0;) {
    const base::BodyTwist& t = sent_[(sent_at_ + sent_.size() - k) % sent_.size()];
    const double middle = v.yaw_rad + 0.5 * t.angular_radps * dt_s;
    v.at.east_m += t.linear_mps * dt_s * std::cos(middle);
    v.at.north_m += t.linear_mps * dt_s * std::sin(middle);
    v.yaw_rad += t.angular_radps * dt_s;
  }
  v.yaw_rad = base::wrap_rad(v.yaw_rad);
  return v;
}

/// How far the vehicle must turn to drive on; reversing, its tail points along the path.
double Tracker::facing_error(const Vehicle& v, const Projection& on) const noexcept {
  double wanted = on.tangent_rad;
  if (std::abs(on.cross_m) > kNear_m) {
    const EnuPoint d = point_ahead(on, lookahead_m(0.0, on.cross_m, params_.track)) - v.at;
    wanted = std::atan2(d.north_m, d.east_m);
  }
  if (leg_now().reverse) wanted += base::kPi;
  return angle_diff_rad(v.yaw_rad, wanted);
}

TrackOutput Tracker::command(const Vehicle& v, double speed_mps, double rate_radps,
                             SpeedReason reason) noexcept {
  speed_mps_ = speed_mps;
  rate_radps_ = rate_radps;
  base::BodyTwist t;
  if (speed_mps == 0.0 && rate_radps == 0.0) return {t, reason};
  t.linear_mps = speed_mps / v.odometry_scale;
  t.angular_radps = (rate_radps - v.pull_1pm * t.linear_mps) / v.yaw_scale;
  const double most = params_.speed.max_yaw_rate_radps;
  if (std::abs(t.angular_radps) > most) {
    const double part = most / std::abs(t.angular_radps);
    t.linear_mps *= part;
    t.angular_radps *= part;
    speed_mps_ *= part;
    rate_radps_ *= part;
    if (speed_mps != 0.0) reason = SpeedReason::Turn;
  }
  return {t, reason};
}

TrackOutput Tracker::settle(const Vehicle& v, double dt_s) noexcept {
  const double step = params_.speed.hold_decel_mps2 * dt_s;
  const double turn_step = params_.pivot.slew_radps2 * dt_s;
  if (still(v, dt_s)) {
    const Projection on = project(v.at, s_m_, 1.0);
    cross_track_m_ = leg_now().reverse ? -on.cross_m : on.cross_m;
    still_s_ = 0.0;
    phase_ = std::abs(facing_error(v, on)) > leg_now().align_rad ? TrackPhase::Pivot
                                                                 : TrackPhase::Follow;
  }
  return command(v, slew(speed_mps_, 0.0, step, step), slew(rate_radps_, 0.0, turn_step, turn_step),
                 SpeedReason::Stopping);
}

TrackOutput Tracker::pivot(const Vehicle& v, double dt_s) noexcept {
  const Vehicle soon = predict(v, dt_s);
  const Projection on = project(v.at, s_m_, 1.0);
  const double error = facing_error(v, on);
  const double error_soon = facing_error(soon, on);
  const double done = rad_from_deg(params_.pivot.done_deg);
  const bool there = std::abs(error) < done && std::abs(v.yaw_rate_radps) < 0.15;
  still_s_ = there ? still_s_ + dt_s : 0.0;
  if (still_s_ >= 0.2) {
    still_s_ = 0.0;
    phase_ = TrackPhase::Follow;
    return command(v, 0.0, 0.0, SpeedReason::Pivot);
  }
  const double wanted =
      std::abs(error_soon) < 0.5 * done ? 0.0 : pivot_rate_radps(error_soon, params_.pivot);
  const double step = params_.pivot.slew_radps2 * dt_s;
  return command(v, 0.0, slew(rate_radps_, wanted, step, step), SpeedReason::Pivot);
}

SpeedLimit Tracker::profile(double s_m) const noexcept {
  const Leg& leg = leg_now();
  const std::size_t i = path_->segment_at(leg, s_m, segment_);
  const PathPoint& here = path_->points[i];
  const PathPoint& next = path_->points[i + 1];
  const double delay = params_.track.delay_s;
  SpeedLimit limit{here.segment_mps, here.segment_reason};
  const bool end = i + 1 == leg.last;
  limit.cut(braking_mps(end ? 0.0 : next.speed_mps, next.s_m - s_m, params_.speed, delay),
            end ? SpeedReason::Approach : next.reason);
  // The delay may reach over a corner that is nearer than its braking distance.
  limit.cut(stopping_mps(leg.end_m - s_m, params_.speed.decel_mps2, delay), SpeedReason::Approach);
  return limit;
}

/// What the vehicle can do of the wanted curvature. A steered one cannot turn on the spot: with the
/// target behind it, it goes round with full lock, to the side on which the target lies.
double Tracker::steer(double wanted_1pm, BodyPoint target, double dt_s) noexcept {
  const VehicleParams& car = params_.vehicle;
  if (!car.steered()) return std::clamp(wanted_1pm, -kTightest_1pm, kTightest_1pm);
  const double lock = std::tan(rad_from_deg(car.max_steering_deg)) / car.wheelbase_m;
  if (target.x_m < 0.0) wanted_1pm = std::copysign(lock, target.y_m);
  // d tan(δ)/dt is at least dδ/dt: cautious near full lock.
  const double step = rad_from_deg(car.max_steering_rate_dps) / car.wheelbase_m * dt_s;
  wanted_1pm = std::clamp(wanted_1pm, -lock, lock);
  curvature_1pm_ += std::clamp(wanted_1pm - curvature_1pm_, -step, step);
  return curvature_1pm_;
}

TrackOutput Tracker::follow(const Vehicle& v, double limit_mps, double dt_s) noexcept {
  const Leg& leg = leg_now();
  const SpeedParams& p = params_.speed;
  const double reach = std::max(1.0, 2.0 * std::abs(v.speed_mps) * dt_s + 1.0);
  const Projection on = project(v.at, s_m_, reach);
  s_m_ = std::max(s_m_, on.s_m);
  segment_ = path_->segment_at(leg, s_m_, segment_);
  cross_track_m_ = leg.reverse ? -on.cross_m : on.cross_m;
  const double left_m = leg.end_m - s_m_;
  if (left_m <= std::max(0.01, std::abs(v.speed_mps) * params_.track.delay_s)) {
    phase_ = TrackPhase::Stop;
    still_s_ = 0.0;
    return stop(v, dt_s);
  }

  // Reversing is driving forward with the tail: same curvature, other end.
  Vehicle soon = predict(v, dt_s);
  if (leg.reverse) soon.yaw_rad = base::wrap_rad(soon.yaw_rad + base::kPi);
  const Projection ahead_on = project(soon.at, s_m_, reach);
  const double look = lookahead_m(v.speed_mps, ahead_on.cross_m, params_.track);
  const BodyPoint target = to_body(point_ahead(ahead_on, look), soon.at, soon.yaw_rad);
  const double bearing = std::atan2(target.y_m, target.x_m);
  astray_s_ = std::abs(bearing) > std::max(kAstray_rad, leg.align_rad) ? astray_s_ + dt_s : 0.0;
  if (astray_s_ > kAstrayFor_s) {
    astray_s_ = 0.0;
    still_s_ = 0.0;
    phase_ = TrackPhase::Settle;
    return settle(v, dt_s);
  }
  const double curvature = steer(arc_curvature_1pm(target), target, dt_s);

  SpeedLimit limit = profile(s_m_);
  const double sigma_limit = rad_from_deg(p.heading_sigma_deg);
  creeping_ = v.yaw_sigma_rad > (creeping_ ? 0.85 : 1.0) * sigma_limit;
  if (creeping_) limit.cut(p.creep_mps, SpeedReason::Creep);
  limit.cut(limit_mps, SpeedReason::Slow);
  limit.cut(bend_mps(curvature, p.lateral_mps2), SpeedReason::Bend);
  limit.cut(p.max_yaw_rate_radps * v.yaw_scale / std::max(1e-6, std::abs(curvature)),
            SpeedReason::Turn);
  limit.cut(limit.mps * heading_factor(bearing),
            std::abs(bearing) > rad_from_deg(10.0) ? SpeedReason::Heading : limit.reason);
  limit.mps = std::max(limit.mps, p.min_mps);
  const double from = std::abs(speed_mps_);
  // What was planned brakes gently; a limit that came suddenly brakes at once, but not harder.
  const double speed = slew(from, limit.mps, p.accel_mps2 * dt_s, p.hold_decel_mps2 * dt_s);
  if (speed > from && speed < limit.mps) limit.reason = SpeedReason::Accel;
  const double signed_speed = leg.reverse ? -speed : speed;
  const double turn_step = p.yaw_accel_radps2 * dt_s;
  const double wanted = speed * curvature;
  const double rate = params_.vehicle.steered()
                          ? wanted  // the wheels' angle was limited, and the speed is
                          : slew(rate_radps_, wanted, turn_step, turn_step);
  return command(v, signed_speed, rate, limit.reason);
}

TrackOutput Tracker::stop(const Vehicle& v, double dt_s) noexcept {
  const Projection on = project(v.at, s_m_, 1.0);
  s_m_ = std::max(s_m_, on.s_m);
  cross_track_m_ = leg_now().reverse ? -on.cross_m : on.cross_m;
  const TrackOutput out = command(v, 0.0, 0.0, SpeedReason::Approach);
  if (still(v, dt_s)) {
    still_s_ = 0.0;
    phase_ =
        leg_now().end_m - s_m_ <= params_.track.arrive_m ? TrackPhase::Done : TrackPhase::Follow;
  }
  return out;
}

}  // namespace roverd::nav
