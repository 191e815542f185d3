// The tracker while it follows: prediction, law, speed.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/profile.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {
namespace {

using base::angle_diff_rad;
using base::rad_from_deg;

constexpr double kTightest_1pm = 1.0 / 0.25;
const double kAstray_rad = rad_from_deg(60.0);
constexpr double kAstrayFor_s = 0.3;
constexpr double kRest_s = 0.2;
constexpr double kOnset_s = 0.2;       // until a turn has begun
constexpr double kUnturned_s = 0.1;    // wheels that are not yet where they should be
constexpr double kUnturned_m = 0.15;   // get there on so much of the way
constexpr double kUnproved = 0.5;      // of the braking that is planned with, for a stop
constexpr double kProof_mps = 0.4;     // so much slower, to see the brakes
constexpr double kProofTo_mps = 0.25;  // but no slower
constexpr double kProofFrom_mps = 0.45;
const double kAside_rad = rad_from_deg(5.0);  // of the course, that is no reason to be slower
const double kBehind_rad = rad_from_deg(150.0);

}  // namespace

/// What was sent so long ago; with the disturbance of now.
base::BodyTwist Tracker::sent_before(double age_s, double dt_s) const noexcept {
  const auto steps =
      std::min<std::size_t>(sent_.size() - 1, static_cast<std::size_t>(std::lround(age_s / dt_s)));
  return sent_[(sent_at_ + sent_.size() - steps) % sent_.size()];
}

/// Where the vehicle will be when a command of now begins to act. It moves along its course.
Vehicle Tracker::predict(const Vehicle& now, double dt_s) const noexcept {
  Vehicle v = now;
  if (dt_s <= 0.0) return v;
  const auto steps = std::min<std::size_t>(
      sent_.size(), static_cast<std::size_t>(std::lround(params_->track.delay_s / dt_s)));
  // A base that brakes a turn more slowly than told goes on with the rest of it for a while.
  const base::BodyTwist then = sent_before(params_->track.delay_s, dt_s);
  const double off_rad = course_off_rad(now, then.linear_mps < 0.0);
  double rest_radps = now.yaw_rate_radps - then.angular_radps - observer_.radps();
  const double keep = std::exp(-dt_s / kRest_s);
  for (std::size_t k = steps; k-- > 0;) {
    const base::BodyTwist& t = sent_[(sent_at_ + sent_.size() - k) % sent_.size()];
    const double rate = t.angular_radps + observer_.radps() + rest_radps;
    rest_radps *= keep;
    const double middle = v.yaw_rad + off_rad + 0.5 * rate * dt_s;
    v.at.east_m += t.linear_mps * dt_s * std::cos(middle);
    v.at.north_m += t.linear_mps * dt_s * std::sin(middle);
    v.yaw_rad += rate * dt_s;
  }
  v.yaw_rad = base::wrap_rad(v.yaw_rad);
  return v;
}

/// Mean curvature over the way on which a change of the turn rate takes effect, half of it ahead of
/// the place and half behind.
double Tracker::bend_ahead_1pm(const Projection& from, double speed_mps) const noexcept {
  const Leg& leg = leg_now();
  const double half_m = 0.5 * std::max(0.1, speed_mps * kOnset_s);
  const double begin_m = std::max(from.s_m - half_m, leg.start_m);
  const double end_m = from.s_m + half_m;  // beyond the leg it is straight
  return angle_diff_rad(path_->yaw_rad(leg, begin_m, from.segment),
                        path_->yaw_rad(leg, end_m, from.segment)) /
         (2.0 * half_m);
}

double Tracker::law_1pm(const Vehicle& soon, const Projection& on,
                        double speed_mps) const noexcept {
  const TrackLaw law = law_from(params_->track.law).value_or(TrackLaw::PathFrame);
  if (law == TrackLaw::PurePursuit) {
    const double look = lookahead_m(speed_mps, on.cross_m, params_->track);
    return arc_curvature_1pm(to_body(point_ahead(on, look), soon.at, soon.yaw_rad));
  }
  const BesidePath at{on.cross_m, angle_diff_rad(on.tangent_rad, soon.yaw_rad),
                      bend_ahead_1pm(on, speed_mps), speed_mps,
                      calm_of(soon.yaw_sigma_rad, rad_from_deg(params_->speed.heading_sigma_deg))};
  if (law == TrackLaw::Stanley)
    return stanley_1pm(at, params_->vehicle.wheelbase_m, params_->track);
  return path_frame_1pm(at, params_->track);
}

/// What the vehicle can do of the wanted curvature. A steered one cannot turn on the spot: with the
/// path's direction behind it, it goes round with full lock, and keeps to the side it has begun.
double Tracker::steer(double wanted_1pm, double heading_rad, double dt_s) noexcept {
  const VehicleParams& car = params_->vehicle;
  unturned_s_ = 0.0;
  if (!car.steered()) return std::clamp(wanted_1pm, -kTightest_1pm, kTightest_1pm);
  // Backwards the same wheels make the other curvature.
  const double side = leg_now().reverse ? -1.0 : 1.0;
  const double now_1pm = side * std::tan(wheel_rad_) / car.wheelbase_m;
  const double lock_rad = rad_from_deg(car.max_steering_deg);
  if (std::abs(heading_rad) > kBehind_rad) {
    const double lock_1pm = std::tan(lock_rad) / car.wheelbase_m;
    const bool begun = std::abs(now_1pm) > 0.5 * lock_1pm;
    wanted_1pm = std::copysign(lock_1pm, begun ? now_1pm : wanted_1pm);
  }
  const double wanted_rad =
      std::clamp(side * std::atan(car.wheelbase_m * wanted_1pm), -lock_rad, lock_rad);
  const double rate_radps = rad_from_deg(car.max_steering_rate_dps);
  wheel_rad_ += std::clamp(wanted_rad - wheel_rad_, -rate_radps * dt_s, rate_radps * dt_s);
  unturned_s_ = std::abs(wanted_rad - wheel_rad_) / rate_radps;
  return side * std::tan(wheel_rad_) / car.wheelbase_m;
}

SpeedLimit Tracker::profile(double s_m) const noexcept {
  const Leg& leg = leg_now();
  const std::size_t i = path_->segment_at(leg, s_m, segment_);
  const PathPoint& here = path_->points[i];
  const PathPoint& next = path_->points[i + 1];
  SpeedParams speed = params_->speed;
  speed.decel_mps2 = slope_decel_mps2(speed.decel_mps2, down_rad_, params_->slope);
  // Braking sets in gradually: as if so much later.
  const double delay = params_->track.delay_s + 0.5 * speed.decel_mps2 / speed.jerk_mps3;
  SpeedLimit limit{here.segment_mps, here.segment_reason};
  const bool end = i + 1 == leg.last;
  limit.cut(braking_mps(end ? 0.0 : next.speed_mps, next.s_m - s_m, speed, delay),
            end ? SpeedReason::Approach : next.reason);
  // The delay may reach over a corner that is nearer than its braking distance.
  const double decel = speed.decel_mps2 * (params_->prove_braking ? kUnproved : 1.0);
  limit.cut(stopping_mps(leg.end_m - s_m, decel, delay), SpeedReason::Approach);
  // Downhill, slower places farther ahead count too: the way was planned for the level.
  if (speed.decel_mps2 < params_->speed.decel_mps2) {
    const double reach_m = s_m + 0.5 * speed_mps_ * speed_mps_ / speed.decel_mps2 + 1.0;
    for (std::size_t k = i + 2; k < leg.last && path_->points[k].s_m < reach_m; ++k) {
      const PathPoint& far = path_->points[k];
      limit.cut(braking_mps(far.speed_mps, far.s_m - s_m, speed, delay), far.reason);
    }
  }
  return limit;
}

/// Where a stop is begun with brakes that are not known: a step down, harder than planned. Then it
/// rolls on at that speed to where braking begins by what was seen.
void Tracker::prove_braking(SpeedLimit& limit) noexcept {
  const double now = std::abs(speed_mps_);
  const bool begins = params_->prove_braking && limit.reason == SpeedReason::Approach &&
                      limit.mps < now && now > kProofFrom_mps;
  if (begins && !proof_mps_) proof_mps_ = std::max(kProofTo_mps, now - kProof_mps);
  if (proof_mps_) limit.cut(*proof_mps_, SpeedReason::Approach);
}

SpeedLimit Tracker::limits(const Vehicle& v, double limit_mps, double curvature_1pm,
                           double course_error_rad) noexcept {
  const SpeedParams& p = params_->speed;
  SpeedLimit limit = profile(s_m_);
  prove_braking(limit);
  const double sigma_limit = rad_from_deg(p.heading_sigma_deg);
  creeping_ = v.yaw_sigma_rad > (creeping_ ? 0.85 : 1.0) * sigma_limit;
  if (creeping_) limit.cut(p.creep_mps, SpeedReason::Creep);
  limit.cut(limit_mps, SpeedReason::Slow);
  const double lean = lean_rad(v.roll_rad, v.pitch_rad);
  limit.cut(slope_mps(lean, p.max_mps, p.creep_mps, params_->slope), SpeedReason::Slope);
  const double lateral_mps2 =
      slope_lateral_mps2(p.lateral_mps2, v.roll_rad, params_->vehicle, params_->slope);
  limit.cut(bend_mps(curvature_1pm, lateral_mps2), SpeedReason::Bend);
  limit.cut(p.max_yaw_rate_radps * v.yaw_scale / std::max(1e-6, std::abs(curvature_1pm)),
            SpeedReason::Turn);
  if (unturned_s_ > kUnturned_s) limit.cut(kUnturned_m / unturned_s_, SpeedReason::Steer);
  const double aside = std::abs(course_error_rad) - kAside_rad;
  if (aside > 0.0) limit.cut(limit.mps * heading_factor(aside), SpeedReason::Heading);
  limit.mps = std::max(limit.mps, p.min_mps);
  return limit;
}

/// The commanded speed's size after this step. What was planned brakes gently; a limit that came
/// suddenly brakes harder, but neither sets in at once.
double Tracker::speed_up_or_down(double limit_mps, double dt_s) noexcept {
  const SpeedParams& p = params_->speed;
  const double from = std::abs(speed_mps_);
  const double missing = limit_mps - from;
  const double step = p.jerk_mps3 * dt_s;
  // Eases out so that the limit is met without a kink: a² = 2·j·Δv.
  const double wanted = missing > 0.0
                            ? std::min(p.accel_mps2, std::sqrt(2.0 * p.jerk_mps3 * missing))
                            : -p.hold_decel_mps2;
  accel_mps2_ = std::clamp(accel_mps2_, -p.hold_decel_mps2, p.accel_mps2);
  accel_mps2_ += std::clamp(wanted - accel_mps2_, -step, step);
  double speed = from + accel_mps2_ * dt_s;
  if (missing <= 0.0) speed = std::min(from, std::max(speed, limit_mps));
  if (missing > 0.0) speed = std::clamp(speed, from, limit_mps);
  accel_mps2_ = (speed - from) / dt_s;
  return speed;
}

TrackOutput Tracker::track(const Vehicle& v, double limit_mps, double dt_s) noexcept {
  const Leg& leg = leg_now();
  const double reach = std::max(1.0, 2.0 * std::abs(v.speed_mps) * dt_s + 1.0);
  const Projection on = project(v.at, s_m_, reach);
  s_m_ = std::max(s_m_, on.s_m);
  segment_ = path_->segment_at(leg, s_m_, segment_);
  cross_track_m_ = leg.reverse ? -on.cross_m : on.cross_m;
  down_rad_ = leg.reverse ? v.pitch_rad : -v.pitch_rad;
  if (leg.end_m - s_m_ <= std::max(0.01, std::abs(v.speed_mps) * params_->track.delay_s)) {
    enter(TrackPhase::Stop);
    return stop(v, dt_s);
  }
  const base::BodyTwist then = sent_before(params_->track.delay_s, dt_s);
  observer_.step({v.speed_mps, v.yaw_rate_radps}, then.angular_radps, saturated_, params_->track,
                 dt_s);

  // Reversing is driving forward with the tail: same curvature, other end.
  Vehicle soon = predict(v, dt_s);
  // The way that counts is the one that it goes, not the one to which it points.
  soon.yaw_rad += course_off_rad(soon, leg.reverse);
  if (leg.reverse) soon.yaw_rad = base::wrap_rad(soon.yaw_rad + base::kPi);
  const double soon_m = std::abs(v.speed_mps) * params_->track.delay_s;
  const Projection ahead_on = project(soon.at, s_m_, reach + soon_m);
  const double speed = std::max(std::abs(speed_mps_), params_->speed.min_mps);
  const double heading = angle_diff_rad(ahead_on.tangent_rad, soon.yaw_rad);
  const double course = course_error_rad(
      ahead_on.cross_m, heading, settle_length_m(speed, params_->track), params_->track.damping);
  astray_s_ = std::abs(course) > std::max(kAstray_rad, leg.align_rad) ? astray_s_ + dt_s : 0.0;
  if (astray_s_ > kAstrayFor_s) {
    enter(TrackPhase::Settle);
    return settle(v, dt_s);
  }
  const double curvature = steer(law_1pm(soon, ahead_on, speed), heading, dt_s);
  return drive(v, limits(v, limit_mps, curvature, course), curvature, dt_s);
}

TrackOutput Tracker::drive(const Vehicle& v, SpeedLimit limit, double curvature_1pm,
                           double dt_s) noexcept {
  const double from = std::abs(speed_mps_);
  const double speed = speed_up_or_down(limit.mps, dt_s);
  if (speed > from && speed < limit.mps) limit.reason = SpeedReason::Accel;
  const double turn_up = params_->speed.yaw_accel_radps2 * dt_s;
  const double turn_down = params_->speed.yaw_decel_radps2 * dt_s;
  const double wanted = speed * curvature_1pm;
  const double rate = params_->vehicle.steered()
                          ? wanted  // the wheels' angle was limited, and the speed is
                          : slew(rate_radps_, wanted, turn_up, turn_down);
  return command(v, leg_now().reverse ? -speed : speed, rate, limit.reason);
}

}  // namespace roverd::nav
