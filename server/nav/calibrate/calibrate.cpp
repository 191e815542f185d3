#include "nav/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/behave/ground.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

using base::CalibrationKind;

constexpr double kLegSpot_m = 6.0;  // of a straight, where it turns on the spot
constexpr double kLegSteered_m = 10.0;
constexpr double kMost_mps = 0.8;  // of straights
constexpr double kMostSteered_mps = 1.2;
constexpr double kAside_m = 0.6;        // off the line, besides the body
constexpr double kWiderThanLock = 1.3;  // bends, so that the lock is not what is measured
constexpr double kSlow_radps = 0.35;    // turns for the compass
constexpr double kRest_s = 1.0;
constexpr double kLongRest_s = 2.0;
constexpr double kLate_s = 0.4;    // until it brakes, besides the delay that is set
constexpr double kHalf = 0.5;      // of the set brakes
constexpr double kBendIn_s = 1.0;  // until the wheels are at the bend's angle
constexpr double kStopLimit_s = 8.0;
// Weaving: two waves of the turn rate, one of the speed.
// Gentle: a heavy load halves what tracks can follow.
constexpr double kWave_hz = 0.35;
constexpr double kQuickWave_hz = 0.6;
constexpr double kWave_radps = 0.08;
constexpr double kQuickWave_radps = 0.015;
constexpr double kWaveOfRate = 0.5;  // of what the wheels can follow
constexpr double kQuickWaveOfRate = 0.15;
constexpr double kWaveIn_s = 1.0;
constexpr double kSpeedWave = 0.3;  // of the speed
constexpr double kRateMost_radps = 0.35;
constexpr double kDamping = 0.9;

double settle_m(double mps, bool steered) noexcept {
  return steered ? 2.0 + 1.2 * mps : 0.9 + 0.9 * mps;
}

double stop_way_m(const PathParams& set, double part) noexcept {
  const double v = calibration_mps(set);
  return v * (set.track.delay_s + kLate_s) + 0.5 * v * v / (part * set.speed.decel_mps2);
}

double leg_m(const PathParams& set) noexcept {
  return set.vehicle.steered() ? kLegSteered_m : kLegSpot_m;
}

double bend_radius_m(const PathParams& set) noexcept {
  return kWiderThanLock * min_radius_m(set.vehicle);
}

}  // namespace

double calibration_mps(const PathParams& set) noexcept {
  const double most = set.vehicle.steered() ? kMostSteered_mps : kMost_mps;
  return std::min({most, set.speed.max_mps, set.vehicle.max_speed_mps});
}

base::CalibrationSpace calibration_space(CalibrationKind kind, const PathParams& set) noexcept {
  const double body_m = set.vehicle.reach_m() + kAside_m;
  const bool steered = set.vehicle.steered();
  if (kind == CalibrationKind::Compass && !steered) return {body_m, body_m, body_m, body_m};
  if (!steered) {
    const double stop_m = stop_way_m(set, kHalf);
    return {leg_m(set) + stop_m + body_m, stop_m + body_m, body_m, body_m};
  }
  // Going into a bend takes a way of its own.
  const double r_m = bend_radius_m(set) + calibration_mps(set) * kBendIn_s;
  const double side_m = 2.0 * r_m + body_m;
  if (kind == CalibrationKind::Compass) return {r_m + body_m, r_m + body_m, side_m, side_m};
  const double stop_m = stop_way_m(set, kHalf);
  return {leg_m(set) + stop_m + r_m + body_m, stop_m + r_m + body_m, side_m, side_m};
}

double calibration_seconds(CalibrationKind kind, const PathParams& set) {
  Calibrate figure{set};
  figure.begin(kind, {}, {}, set);
  return figure.left_s();
}

void Calibrate::add(Op op) noexcept {
  if (count_ < kMostOps) ops_[count_++] = op;
}

void Calibrate::plan(CalibrationKind kind) noexcept {
  count_ = at_ = 0;
  const bool steered = set_.vehicle.steered();
  const double half = base::kPi;
  add({Do::Rest, kLongRest_s});
  if (kind == CalibrationKind::Compass) {
    for (const double round : {2.0 * half, -2.0 * half}) {
      add({steered ? Do::Bend : Do::Turn, round});
      add({Do::Rest, kLongRest_s});
    }
    return;
  }
  const bool weaves = kind != CalibrationKind::Antennas;
  const std::array<double, 6> sides = steered ? std::array{half, half, -half, -half, 0.0, 0.0}
                                              : std::array{half, -half, -half, half, half, -half};
  const std::size_t legs = steered || !weaves ? 4 : 6;
  for (std::size_t i = 0; i < legs; ++i) {
    const Wave wave = !weaves ? Wave::None : i == 3 ? Wave::Speed : Wave::Turn;
    add({Do::Straight, 0.0, i % 2 == 1, wave});
    add({Do::Rest, kRest_s});
    add({steered ? Do::Bend : Do::Turn, sides[i]});
  }
  add({Do::Rest, kRest_s});
}

void Calibrate::begin(CalibrationKind kind, const Vehicle& v, const CalibrationBefore& before,
                      const PathParams& set) {
  kind_ = kind;
  set_ = set;
  space_ = calibration_space(kind, set);
  tells_speed_ = before.tells_speed;
  state_ = State::Running;
  reason_.clear();
  ++id_;
  start_ = v.at;
  yaw_rad_ = v.yaw_rad;
  far_m_ = leg_m(set);
  stop_m_ = stop_way_m(set, 1.0) - kLate_s * calibration_mps(set);
  radius_m_ = bend_radius_m(set);
  plan(kind);
  meter_.begin(kind, before, set);
  fresh_ = true;
  speed_mps_ = rate_radps_ = clock_s_ = still_s_ = 0.0;
  rotation_.reset();
}

void Calibrate::end(std::string why) {
  if (state_ != State::Running) return;
  state_ = State::Ended;
  reason_ = std::move(why);
}

TrackOutput Calibrate::fail(std::string why) {
  state_ = State::Failed;
  reason_ = std::move(why);
  return {};
}

void Calibrate::next() noexcept {
  ++at_;
  fresh_ = true;
  clock_s_ = still_s_ = wave_s_ = 0.0;
  if (at_ >= count_) state_ = State::Done;
}

double Calibrate::seconds_of(const Op& op) const noexcept {
  const double v = calibration_mps(set_);
  switch (op.what) {
    case Do::Rest:
      return op.value + 0.3;
    case Do::Straight:
      return far_m_ / v + v / set_.speed.accel_mps2 + 0.5;
    case Do::Turn:
      return std::abs(op.value) /
                 (kind_ == CalibrationKind::Compass ? kSlow_radps : set_.pivot.max_rate_radps) +
             1.5;
    case Do::Bend:
      return std::abs(op.value) * radius_m_ / v + 1.5;
  }
  return 0.0;
}

double Calibrate::left_s() const noexcept {
  if (state_ != State::Running) return 0.0;
  double sum = 0.0;
  for (std::size_t i = at_; i < count_; ++i) sum += seconds_of(ops_[i]);
  return std::max(0.0, sum - std::min(clock_s_, seconds_of(ops_[at_])));
}

/// Its body, in what was told before.
bool Calibrate::inside(const Vehicle& v) const noexcept {
  const BodyPoint p = to_body(v.at, start_, yaw_rad_);
  const double body_m = set_.vehicle.reach_m();
  return p.x_m < space_.ahead_m - body_m && p.x_m > body_m - space_.behind_m &&
         p.y_m < space_.left_m - body_m && p.y_m > body_m - space_.right_m;
}

TrackOutput Calibrate::step(const Vehicle& v, double limit_mps, double dt_s) {
  if (state_ != State::Running) return {};
  if (limit_mps < calibration_mps(set_) - 0.01) {
    return fail("something slows the robot: what it measured is worth nothing");
  }
  if (!inside(v)) return fail("it left the space that the figure needs");
  if (too_steep_to_turn(v, set_.slope)) return fail("the ground leans too much to measure on it");
  clock_s_ += dt_s;
  const Op& op = ops_[at_];
  if (clock_s_ > 3.0 * seconds_of(op) + kStopLimit_s) {
    return fail("the robot does not do what it is told in the time it should take");
  }
  switch (op.what) {
    case Do::Rest:
      still_s_ = stands(v) ? still_s_ + dt_s : 0.0;
      return rest();
    case Do::Straight:
      return straight(v, dt_s);
    case Do::Turn:
      return turn(v, dt_s);
    case Do::Bend:
      return bend(v, dt_s);
  }
  return {};
}

TrackOutput Calibrate::rest() {
  if (still_s_ < ops_[at_].value) return {{}, SpeedReason::Standing};
  const bool after_straight = at_ > 0 && ops_[at_ - 1].what == Do::Straight;
  if (after_straight || at_ + 1 == count_) meter_.stretch_ends(after_straight);
  if (at_ == 0 || after_straight) meter_.stretch_begins();
  next();
  return {{}, SpeedReason::Standing};
}

TrackOutput Calibrate::straight(const Vehicle& v, double dt_s) {
  const Op& op = ops_[at_];
  const double wanted = calibration_mps(set_);
  const bool steered = set_.vehicle.steered();
  if (fresh_) {
    fresh_ = false;
    stopping_ = false;
    // A bend's end is rolling; a turn on the spot ends on the line.
    from_ = steered ? v.at : start_;
    ramping_ = std::abs(v.speed_mps) < 0.05;
    if (ramping_) speed_mps_ = 0.0;
    if (ramping_)
      meter_.ramp_begins(wanted / v.odometry_scale, set_.speed.accel_mps2 / v.odometry_scale);
    meter_.straight_begins();
  }
  const BodyPoint p = to_body(v.at, start_, yaw_rad_);
  const double left_m = op.back ? p.x_m : far_m_ - p.x_m;
  if (!stopping_ && left_m <= stop_m_) {
    stopping_ = true;
    stop_from_ = v.at;
    meter_.stop_begins();
  }
  if (stopping_ && (tells_speed_ || speed_mps_ == 0.0)) {
    meter_.weaves(false);
    speed_mps_ = rate_radps_ = 0.0;
    still_s_ = stands(v) ? still_s_ + dt_s : 0.0;
    if (still_s_ > 0.3) stopped(v);
    return {{}, SpeedReason::Stopping};
  }
  // One that tells nothing of its speed is where it was told to go: gently, as it was set up for.
  speed_mps_ = stopping_ ? slew(speed_mps_, 0.0, 0.0, set_.speed.decel_mps2 * dt_s)
                         : slew(speed_mps_, wanted, set_.speed.accel_mps2 * dt_s,
                                set_.speed.accel_mps2 * dt_s);
  const double line_rad = base::wrap_rad(yaw_rad_ + (op.back ? base::kPi : 0.0));
  const BodyPoint off = to_body(v.at, from_, line_rad);
  const double l = settle_m(wanted, steered);
  const double heading = base::angle_diff_rad(line_rad, v.yaw_rad);
  double rate = -speed_mps_ * (off.y_m / (l * l) + 2.0 * kDamping / l * std::sin(heading));
  double speed = speed_mps_;
  const bool at_speed = std::abs(v.speed_mps) > 0.8 * wanted;
  if (at_speed && ramping_) {
    ramping_ = false;
    meter_.ramp_ends();
  }
  meter_.weaves(op.wave == Wave::Turn && !stopping_ && wave_s_ > kWaveIn_s);
  if (op.wave != Wave::None && !stopping_ && speed_mps_ >= wanted) {
    wave_s_ += dt_s;
    // A speed that changes is a turn as well: one after the other.
    if (op.wave == Wave::Turn) rate += std::min(1.0, wave_s_ / kWaveIn_s) * wave_radps();
    if (op.wave == Wave::Speed) {
      const double t = 2.0 * base::kPi * wave_s_;
      speed -= 0.5 * kSpeedWave * wanted * (1.0 - std::cos(kWave_hz * t));
    }
  }
  rate = std::clamp(rate, -kRateMost_radps, kRateMost_radps);
  return {track_twist(v, speed, rate, *path_), SpeedReason::Item};
}

/// No faster than steered wheels follow: what they cannot is no delay.
double Calibrate::wave_radps() const noexcept {
  double slow = kWave_radps;
  double quick = kQuickWave_radps;
  const double t = 2.0 * base::kPi * wave_s_;
  if (set_.vehicle.steered()) {
    const double turn_1ps2 = base::rad_from_deg(set_.vehicle.max_steering_rate_dps) *
                             calibration_mps(set_) / set_.vehicle.wheelbase_m / (2.0 * base::kPi);
    slow = std::min(slow, kWaveOfRate * turn_1ps2 / kWave_hz);
    quick = std::min(quick, kQuickWaveOfRate * turn_1ps2 / kQuickWave_hz);
  }
  return slow * std::cos(kWave_hz * t) + quick * std::cos(kQuickWave_hz * t);
}

void Calibrate::stopped(const Vehicle& v) noexcept {
  meter_.stop_ends();
  const double way_m = base::distance_m(stop_from_, v.at);
  stop_m_ = std::clamp(way_m, 0.05, stop_way_m(set_, kHalf));
  next();
}

TrackOutput Calibrate::turn(const Vehicle& v, double dt_s) {
  if (fresh_) {
    fresh_ = false;
    const bool compass = kind_ == CalibrationKind::Compass;
    // Its figure's headings, not what was missed of the last one.
    const double target = base::wrap_rad(v.yaw_rad + ops_[at_].value);
    const double line = base::deg_from_rad(std::abs(base::angle_diff_rad(target, yaw_rad_))) < 90.0
                            ? yaw_rad_
                            : base::wrap_rad(yaw_rad_ + base::kPi);
    const double more = compass ? 0.0 : base::angle_diff_rad(target, line);
    rotation_.by(ops_[at_].value + more, compass ? kSlow_radps : set_.pivot.max_rate_radps);
  }
  const TrackOutput out = rotation_.step(v, *path_, dt_s);
  if (rotation_.state() == RotateInPlace::State::Failed) {
    return fail("a turn on the spot did not come to its end");
  }
  if (rotation_.state() == RotateInPlace::State::Done) next();
  return out;
}

TrackOutput Calibrate::bend(const Vehicle& v, double dt_s) {
  const double angle = ops_[at_].value;
  if (fresh_) {
    fresh_ = false;
    bent_rad_ = 0.0;
    bent_yaw_rad_ = v.yaw_rad;
    if (std::abs(v.speed_mps) < 0.05) speed_mps_ = 0.0;
    rate_radps_ = 0.0;
  }
  bent_rad_ += base::angle_diff_rad(bent_yaw_rad_, v.yaw_rad);
  bent_yaw_rad_ = v.yaw_rad;
  const double wanted =
      std::min(calibration_mps(set_), 0.8 * std::sqrt(set_.speed.lateral_mps2 * radius_m_));
  speed_mps_ = slew(speed_mps_, wanted, set_.speed.accel_mps2 * dt_s, set_.speed.accel_mps2 * dt_s);
  const double most = std::copysign(wanted / radius_m_, angle);
  rate_radps_ = slew(rate_radps_, most, std::abs(most) / kBendIn_s * dt_s, std::abs(most) * dt_s);
  // What is on its way still turns it.
  const double coming = std::abs(v.yaw_rate_radps) * (set_.track.delay_s + 0.5 * kBendIn_s);
  if (std::copysign(1.0, angle) * (angle - bent_rad_) <= coming) {
    next();
    return {track_twist(v, speed_mps_, 0.0, *path_), SpeedReason::Bend};
  }
  return {track_twist(v, speed_mps_, rate_radps_ * speed_mps_ / wanted, *path_), SpeedReason::Bend};
}

base::CalibrationState Calibrate::tell() const {
  base::CalibrationState out;
  out.id = id_;
  out.kind = kind_;
  out.space = space_;
  out.from = start_;
  out.from_yaw_rad = yaw_rad_;
  out.reason = reason_;
  switch (state_) {
    case State::Idle:
      return out;
    case State::Running:
      out.phase = base::CalibrationPhase::Running;
      break;
    case State::Done:
      out.phase = base::CalibrationPhase::Done;
      break;
    case State::Failed:
      out.phase = base::CalibrationPhase::Failed;
      break;
    case State::Ended:
      out.phase = base::CalibrationPhase::Aborted;
      break;
  }
  constexpr std::array<std::string_view, 4> kWords{"stands", "straight", "turn", "circle"};
  if (at_ < count_) out.step = kWords[static_cast<std::size_t>(ops_[at_].what)];
  out.steps = static_cast<int>(count_);
  out.steps_done = static_cast<int>(std::min(at_, count_));
  double all = 0.0;
  for (std::size_t i = 0; i < count_; ++i) all += seconds_of(ops_[i]);
  out.left_s = left_s();
  const double share = all > 0.0 ? 1.0 - out.left_s / all : 0.0;
  out.share = state_ == State::Done ? 1.0 : state_ == State::Running ? share : 0.0;
  out.count = meter_.tell(out.values);
  return out;
}

}  // namespace roverd::nav
