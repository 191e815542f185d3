// Tracks and gyro: what carries the belief on between two words from outside.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using base::Refusal;
using base::seconds;
using std::chrono::milliseconds;

constexpr base::Duration kStandsAfter = milliseconds(500);
constexpr double kStill_m = 0.0015;  // two counts of a millimetre odometer
constexpr double kCrept_m = 0.0004;  // less than one of them, by one track
constexpr double kCreep_s = 2.0;
constexpr double kFastest_mps = 15.0;  // more is a damaged count, not a motion
constexpr double kMaxGap_s = 2.0;      // of odometry that may still be carried over
// A gyro that stands: within this of its bias, or at least as even and as slow as the second pair.
const double kGyroStill_radps = rad_from_deg(1.5);
const double kGyroEven_radps = rad_from_deg(0.3);
const double kGyroBiasMost_radps = rad_from_deg(5.0);
constexpr double kGyroFastest_radps = 8.0;
constexpr double kAccelMost_mps2 = 160.0;
// What a base was told and does otherwise: it sets off late, and is faster or slower (1 sigma).
constexpr double kAssumedShare = 0.2;
// How the ground gives way, per √m: the scale, and the slide on a level and on a slope.
constexpr double kScaleNoise_1sm = 6e-4;
constexpr double kSlideNoise_1sm = 2e-3;
constexpr double kSlideNoisePerGrade_1sm = 0.1;
constexpr double kLevelGrade = 0.035;   // an inertial unit is not mounted better than that
constexpr double kUnknownGrade = 0.03;  // nothing tells how the ground leans
constexpr double kCompare_s = 0.2;      // of travel, before gyro and tracks are compared

bool finite(const base::BodyVector& v, double most) noexcept {
  const double size = std::hypot(v.forward, v.left, v.up);
  return std::isfinite(size) && size <= most;
}

}  // namespace

// ---- gyro --------------------------------------------------------------------------------------

void Estimator::take(const base::Inertial& inertial) {
  Input& in = health_.inertial;
  const bool rate_ok = !inertial.rate_radps || finite(*inertial.rate_radps, kGyroFastest_radps);
  const bool accel_ok = !inertial.accel_mps2 || finite(*inertial.accel_mps2, kAccelMost_mps2);
  if (!rate_ok || !accel_ok) return refuse(in, Refusal::NotFinite);
  if (!in_order(in, last_inertial_, inertial.stamp)) return;
  // A gyro that lies about a turn must not turn the lean as well, nor what was made of it.
  const bool by_tracks = !inertial.rate_radps || votes_.out(base::Sense::Gyro);
  const double up_radps = by_tracks ? belief_.x(kYawScale) * tracks_.angular_radps
                                    : inertial.rate_radps->up - belief_.x(kGyroBias);
  tilt_.put(inertial, belief_.x(kScale) * tracks_.linear_mps, up_radps);
  if (!inertial.rate_radps) return;
  const double turn_radps = tilt_.heading_radps(*inertial.rate_radps, inertial.stamp);
  gyro_.put(inertial.stamp, turn_radps);
  votes_.gyro(turn_radps - belief_.x(kGyroBias), inertial.rate_radps->up, inertial.stamp);
  if (!outvoted(base::Sense::Gyro, in)) in.refused_since.reset();
}

void Estimator::take(const base::Attitude& attitude) {
  if (!std::isfinite(attitude.roll_rad) || !std::isfinite(attitude.pitch_rad)) {
    return refuse(health_.inertial, Refusal::NotFinite);
  }
  // It would be believed until then, and whatever comes meanwhile be older.
  if (attitude.stamp > now_ + kFuture) return refuse(health_.inertial, Refusal::Stamp);
  tilt_.put(attitude);
}

/// Small beside its bias; or, with the tracks still for two seconds, so even that nobody turns it.
bool Estimator::gyro_stands(Time stamp) const noexcept {
  const auto lately = gyro_.spread(stamp - milliseconds(100));
  if (!lately) return true;  // it says nothing
  const double doubt = 3.0 * std::sqrt(belief_.P(kGyroBias, kGyroBias));
  if (std::abs(lately->mean_radps - belief_.x(kGyroBias)) < kGyroStill_radps + doubt) return true;
  const auto long_time = gyro_.spread(stamp - milliseconds(500));
  return long_time && long_time->deviation_radps < kGyroEven_radps &&
         std::abs(long_time->mean_radps) < kGyroBiasMost_radps;
}

/// At rest a gyro shows its bias. While a track's count says that it may have moved, it may not.
void Estimator::learn_gyro_bias(Time stamp) noexcept {
  if (std::abs(crept_.ahead_m) + std::abs(crept_.half_m) > kCrept_m) return;
  const bool out = votes_.out(base::Sense::Gyro);
  if ((!gyro_used_ && !out) || stamp - bias_learned_at_ < kStandsAfter) return;
  bias_learned_at_ = stamp;
  const auto seen = gyro_.spread(stamp - kStandsAfter);
  if (!seen || (out && std::abs(seen->mean_radps) > kGyroBiasMost_radps)) return;
  Observation<1> o;
  o.innovation(0) = seen->mean_radps - belief_.x(kGyroBias);
  o.H(0, kGyroBias) = 1.0;
  o.R(0, 0) = std::pow(rad_from_deg(0.03), 2) + std::pow(0.2 * seen->deviation_radps, 2);
  o.may_change.setZero();
  o.may_change(kGyroBias) = 1.0;
  apply(health_.inertial, o);
}

/// What the tracks make of a turn, as the gyro sees it: it is steered by, and what the yaw rate is
/// taken from when the gyro falls silent.
void Estimator::learn_tracks(const Travel& t) noexcept {
  if (!t.gyro_rad) {
    untold_ = {};
    untold_turned_rad_ = 0.0;
    return;
  }
  untold_.ahead_m += t.ahead_m;
  untold_.turn_rad += t.turn_rad;
  untold_.dt_s += t.dt_s;
  untold_turned_rad_ += *t.gyro_rad - belief_.x(kGyroBias) * t.dt_s;
  if (untold_.dt_s < kCompare_s) return;
  const Travel all = untold_;
  const double turned_rad = untold_turned_rad_;
  untold_ = {};
  untold_turned_rad_ = 0.0;
  if (std::abs(all.ahead_m) + std::abs(all.turn_rad) < 0.02) return;
  Observation<1> o;
  o.innovation(0) =
      turned_rad - belief_.x(kYawScale) * all.turn_rad - belief_.x(kPull) * all.ahead_m;
  o.H(0, kYawScale) = all.turn_rad;
  o.H(0, kPull) = all.ahead_m;
  const double spread = rad_from_deg(0.5) + 0.1 * std::abs(all.turn_rad);
  o.R(0, 0) = spread * spread;
  o.may_change.setZero();
  o.may_change(kYawScale) = o.may_change(kPull) = 1.0;
  apply(health_.odometry, o);
}

// ---- tracks ------------------------------------------------------------------------------------

void Estimator::take(const base::WheelTravel& travel) {
  Input& in = health_.odometry;
  if (!std::isfinite(travel.left_m) || !std::isfinite(travel.right_m)) {
    return refuse(in, Refusal::NotFinite);
  }
  const auto before = last_travel_;
  if (!in_order(in, last_travel_, travel.stamp)) return;
  const double dt_s = before ? seconds(travel.stamp - *before) : 0.02;
  const double reach_m = kFastest_mps * dt_s + 0.1;
  if (dt_s > kMaxGap_s || std::abs(travel.left_m) > reach_m || std::abs(travel.right_m) > reach_m) {
    return refuse(in, Refusal::Impossible);
  }
  const Travel t{0.5 * (travel.left_m + travel.right_m),
                 (travel.right_m - travel.left_m) / params_->track_width_m, dt_s};
  votes_.tracks(t.ahead_m, t.turn_rad, travel.stamp);
  if (outvoted(base::Sense::Tracks, in)) return;
  in.refused_since.reset();
  step(t, travel.stamp);
  if (!last_motion_ || travel.stamp - *last_motion_ > kOdometryGone) {
    tracks_ = {t.ahead_m / dt_s, t.turn_rad / dt_s};
  }
}

void Estimator::take(const base::BaseMotion& motion) {
  Input& in = health_.odometry;
  if (!std::isfinite(motion.twist.linear_mps) || !std::isfinite(motion.twist.angular_radps)) {
    return refuse(in, Refusal::NotFinite);
  }
  const auto before = last_motion_;
  if (!in_order(in, last_motion_, motion.stamp)) return;
  const bool travel_is_fresh = last_travel_ && motion.stamp - *last_travel_ < kOdometryGone;
  const double dt_s = before ? std::min(seconds(motion.stamp - *before), 0.2) : 0.0;
  const Travel t{motion.twist.linear_mps * dt_s, motion.twist.angular_radps * dt_s, dt_s};
  // What the base was told is no witness of what it does.
  if (motion.assumed) {
    votes_.told_to(t.ahead_m, t.turn_rad);
  } else if (!travel_is_fresh) {
    votes_.tracks(t.ahead_m, t.turn_rad, motion.stamp);
  }
  if (outvoted(base::Sense::Tracks, in)) return;
  tracks_ = motion.twist;
  if (travel_is_fresh || !before) {
    if (!travel_is_fresh) tracks_at_ = motion.stamp;
    return;
  }
  step(t, motion.stamp);
  if (motion.assumed) doubt_assumed(dt_s);
}

/// A firm floor's, and more of it on a slope and where the positions saw it give way.
Slip Estimator::slip() const noexcept {
  const auto lean = tilt_.at(now_);
  const double grade = lean ? std::hypot(std::tan(lean->roll_rad), std::tan(lean->pitch_rad)) : 0.0;
  const double slope = lean ? std::max(0.0, grade - kLevelGrade) : kUnknownGrade;
  const bool antennas = last_antennas_ && now_ - *last_antennas_ < kGnssGone;
  Slip s;
  s.scale_noise = kScaleNoise_1sm * slip_watch_.along();
  s.slide_noise = (kSlideNoise_1sm + kSlideNoisePerGrade_1sm * slope) * slip_watch_.aside();
  s.crab_sigma = antennas ? kCrabSeen : kCrabUnseen;
  return s;
}

/// A speed that nobody measured is wrong for long, not from moment to moment: what it adds up to
/// grows with the time since the last position. d(sigma² t²) = 2 sigma² t dt
void Estimator::doubt_assumed(double dt_s) noexcept {
  if (!last_fused_) return;
  const double sigma_mps = kAssumedShare * belief_.x(kScale) * tracks_.linear_mps;
  const double blind_s = std::max(0.0, seconds(now_ - *last_fused_));
  const double more = 2.0 * sigma_mps * sigma_mps * blind_s * dt_s;
  belief_.P(kEast, kEast) += more;
  belief_.P(kNorth, kNorth) += more;
}

/// Currents act on a compass through iron that remembers them for a while.
void Estimator::take(const base::MotorState& motor) {
  if (!motor.current_a || !std::isfinite(*motor.current_a)) return;
  if (motor.motor != params_->left_motor && motor.motor != params_->right_motor) return;
  Current& side = motor.motor == params_->left_motor ? left_ : right_;
  const double dt_s = side.stamp ? std::max(0.0, seconds(motor.stamp - *side.stamp)) : 0.0;
  const double lag_s = params_->compass_current_lag_s;
  side.ampere += (*motor.current_a - side.ampere) * dt_s / std::max(1e-3, lag_s + dt_s);
  side.stamp = motor.stamp;
}

void Estimator::step(const Travel& travel, Time stamp) noexcept {
  Travel t = travel;
  const Time whole = stamp - base::from_seconds(t.dt_s);
  const bool near = filter_at_ && *filter_at_ <= stamp && stamp - *filter_at_ < milliseconds(400);
  t.gyro_rad = gyro_.turned_rad(near ? *filter_at_ : whole, stamp);
  const bool out = votes_.out(base::Sense::Gyro);
  if (out) t.gyro_rad.reset();
  if (t.gyro_rad) gyro_used_ = true;
  if (!t.gyro_rad && (out || !gyro_.fresh(stamp))) gyro_used_ = false;

  tracks_at_ = stamp;
  watch_standing(t, stamp);
  const double yaw_before = belief_.x(kYaw);
  predict(belief_, t, slip(), drift_, standing_ && t.ahead_m == 0.0 && t.turn_rad == 0.0);
  sums_.ahead_m += t.ahead_m;
  sums_.turned_rad += base::angle_diff_rad(yaw_before, belief_.x(kYaw));
  free_m_ += std::abs(belief_.x(kScale) * t.ahead_m);
  counted_m_ += std::abs(t.ahead_m);
  if (standing_) {
    learn_gyro_bias(stamp);
  } else {
    learn_tracks(t);
    const double rate = std::abs(base::angle_diff_rad(yaw_before, belief_.x(kYaw))) / t.dt_s;
    if (rate > 0.3 && std::abs(t.ahead_m) < 0.15 * t.dt_s) pivot_at_ = stamp;
  }
  remember(stamp);
}

void Estimator::remember(Time stamp) noexcept {
  filter_at_ = stamp;
  sums_.stamp = stamp;
  sums_.x = belief_.x;
  history_.push(sums_);
}

void Estimator::watch_standing(const Travel& t, Time stamp) noexcept {
  const double half_m = 0.5 * t.turn_rad * params_->track_width_m;
  // A creep is a fraction of a count in each step: it adds up, and what jitters does not.
  const double fades = std::max(0.0, 1.0 - t.dt_s / kCreep_s);
  crept_.ahead_m = crept_.ahead_m * fades + t.ahead_m;
  crept_.half_m = crept_.half_m * fades + half_m;
  const bool tracks = std::abs(crept_.ahead_m) + std::abs(crept_.half_m) > kStill_m;
  if (tracks) crept_ = {};
  const bool out = votes_.out(base::Sense::Gyro);
  const bool turned = !tracks && !out && !gyro_stands(stamp);  // by hand
  if (tracks || turned) moved_at_ = stamp;
  standing_ = !tracks && !turned && stamp - moved_at_ >= kStandsAfter;
  if (tracks) has_moved_ = true;
}

}  // namespace roverd::nav
