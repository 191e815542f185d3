// Positions of the receiver: what a fix says, and what happens when it is not believed.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::Refusal;
using base::seconds;

constexpr base::Duration kAnchorClass = std::chrono::seconds(2);
constexpr base::Duration kApproach = std::chrono::seconds(20);
constexpr double kFar_m = 25.0;
constexpr double kSurprises = 6.0;  // sigmas, that a position is off
constexpr double kDoubtAfter_s = 2.0;
constexpr double kDoubtShiftAfter_s = 8.0;  // where a shift would be a person's question
constexpr double kResetAfter_s = 10.0;
constexpr double kToldFrom_m = 0.2;
constexpr double kSlips = 0.4;        // of the way since the last position, at most
constexpr double kSlipsFrom = 9.0;    // of y'S⁻¹y, so that it was not foreseen
constexpr double kDoubt_m2ps = 0.05;  // slow enough not to believe a jump of 3 m within 5 s

// Positions that seem to run away from the velocity (Votes::apart): from where on they weigh less,
// where they hardly weigh any more, and what they are worth then.
constexpr double kSuspect = 0.65;
constexpr double kSuspectAll = 0.8;
constexpr double kSuspect_m = 0.3;
// Likewise where they run off from tracks and gyro (Votes::off_course).
constexpr double kSuspectOff = 0.3;
constexpr double kSuspectOffAll = 0.5;

constexpr double kVague_m = 0.2;    // so uncertain, nothing shows a new fixed solution to be wrong
constexpr double kFixed_m = 0.02;   // 1 sigma of what scatters in an honest fixed solution
constexpr double kShaken_m = 0.35;  // of a fixed solution that comes and goes
// Positions that wander (WanderWatch): the time constant of reflections, and for so long, at most,
// nobody saw it.
constexpr double kWandersFor_s = 20.0;
constexpr double kUnseen_s = 5.0;

/// A fixed solution that comes and goes, or scatters, as what it is worth: a float one.
base::GnssFix as_float(base::GnssFix fix) noexcept {
  fix.fix = base::FixType::RtkFloat;
  fix.sigma_east_m = std::max(kShaken_m, fix.sigma_east_m.value_or(0.0));
  fix.sigma_north_m = std::max(kShaken_m, fix.sigma_north_m.value_or(0.0));
  return fix;
}

bool long_ago(const std::optional<base::WallTime>& utc) noexcept {
  using std::chrono::sys_days, std::chrono::year;
  return utc && *utc < sys_days{year{2015} / 1 / 1};
}

}  // namespace

/// The receiver's position in the robot's frame, moved by the anchor.
base::EnuPoint Estimator::local(const base::GnssFix& fix) const noexcept {
  const base::EnuPoint at = frame_->to_local(*fix.position);
  return health_.anchor ? at + health_.anchor->offset : at;
}

/// E: ENU at the datum. B: body. A: antenna. p_EA = p_EB + R_EB · p_BA, leaning included.
Estimator::Arm Estimator::arm(double yaw_rad) const noexcept {
  double forward_m = params_->antenna_forward_m;
  double left_m = params_->antenna_left_m;
  if (params_->antenna_up_m > 0.0) {
    if (const auto lean = tilt_.at(now_)) {
      // Nose up, the mast leans back; right side down, it leans to the right.
      forward_m -= params_->antenna_up_m * std::sin(lean->pitch_rad);
      left_m -= params_->antenna_up_m * std::sin(lean->roll_rad);
    }
  }
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {c * forward_m - s * left_m, s * forward_m + c * left_m};
}

void Estimator::take(const base::GnssFix& told) {
  Input& in = health_.position;
  if (!in_order(in, last_fix_, told.stamp)) return;
  if (told.fix == base::FixType::RtkFixed && fix_trust_.fix() != told.fix) {
    vague_ = !located_ || claimed_m(belief_) > kVague_m;
  }
  fix_trust_.take(told.fix, told.stamp);
  const base::GnssFix fix = worth(told);
  auto quality = gnss_quality(
      fix, fix_trust_.settled(),
      {params_->satellites_min, params_->hdop_max, params_->accuracy_max_m, params_->drift_scale});
  if (!quality) {
    if (quality.error()) refuse(in, *quality.error());
    return;
  }
  if (long_ago(fix.utc)) return refuse(in, Refusal::Date);
  if (frame_) receivers_.put(frame_->to_local(*fix.position), fix.stamp);
  if (receivers_.disagree()) return refuse(in, Refusal::Receivers);
  if (history_.forgotten(taken_at(fix))) return refuse(in, Refusal::Stamp);
  if (frame_) {
    wander_watch_.position(frame_->to_local(*fix.position), taken_at(fix));
    votes_.position({.t = taken_at(fix),
                     .at = frame_->to_local(*fix.position),
                     .sigma_m = std::max(quality->sigma_east_m, quality->sigma_north_m),
                     .drift_m = quality->drift.sigma_m,
                     .drift_s = quality->drift.tau_s},
                    static_cast<int>(fix.fix), fix.stamp);
  }
  // Only now: by what it claims it is judged, by what it is worth it is believed.
  if (fix.fix != base::FixType::RtkFixed && fix.fix != base::FixType::Single) widen(*quality);
  const auto late_s = arrival_.late_s(fix.stamp, fix.utc);
  if (!late_s) return refuse(in, Refusal::Stamp);
  late_s_ = *late_s;
  if (located_ && !health_.by_map && shifted(fix, *quality)) return refuse(in, Refusal::Jump);
  if (located_ && outvoted(base::Sense::Position, in)) return;
  if (fix.alt_msl_m && std::isfinite(*fix.alt_msl_m)) alt_msl_m_ = fix.alt_msl_m;
  if (!located_) {
    first_fix(fix, *quality);
    in.refused_since.reset();
    return;
  }
  if (beside_the_map(fix, *quality)) return;
  change_class(fix, *quality);
  lead_after_landmarks(fix, *quality);
  fuse_position(fix, *quality);
}

/// A fixed solution that shows that it stands under trees or beside walls counts as a float one,
/// whatever it claims.
base::GnssFix Estimator::worth(const base::GnssFix& told) noexcept {
  if (told.fix != base::FixType::RtkFixed || !told.position) return told;
  if (const auto past = located_ ? history_.at(taken_at(told)) : std::nullopt) {
    const Arm to_antenna = arm(past->x(kYaw));
    const base::EnuPoint at{past->x(kEast) + to_antenna.east_m,
                            past->x(kNorth) + to_antenna.north_m};
    noise_watch_.take(local(told) - at, std::max(kFixed_m, told.sigma_east_m.value_or(kFixed_m)),
                      told.stamp);
  }
  const bool fresh = vague_ && !fix_trust_.settled();
  const bool less = fresh || fix_trust_.shaken() || noise_watch_.noisy() || wander_watch_.wanders();
  return less ? as_float(told) : told;
}

/// What wanders faster than its claim allows is worth what it wanders; and so is a place that was
/// made of it before that was seen.
void Estimator::widen(GnssQuality& q) noexcept {
  const double rate_m2ps = wander_watch_.wanders() ? wander_watch_.rate_m2ps() : 0.0;
  const double sigma_m = std::sqrt(0.5 * kWandersFor_s * rate_m2ps);
  if (sigma_m <= q.drift.sigma_m) {
    if (rate_m2ps == 0.0) wandered_ = false;
    return;
  }
  q.drift = {sigma_m, kWandersFor_s};
  if (wandered_ || !located_) return;
  wandered_ = true;
  // The error that came into the place is the drift's own, and no second word against it.
  const double whole_m2 = sigma_m * sigma_m;
  const double in_it_m2 = proved() ? std::min(whole_m2, kUnseen_s * rate_m2ps) : whole_m2;
  for (const auto& [place, drift] : {std::pair{kEast, kDriftE}, std::pair{kNorth, kDriftN}}) {
    reset_state(belief_, drift, belief_.x(drift), sigma_m);
    belief_.P(place, place) += in_it_m2;
    belief_.P(place, drift) = belief_.P(drift, place) = -in_it_m2;
  }
}

/// @return true: the positions moved for good, and a person is asked which ones count.
bool Estimator::shifted(const base::GnssFix& fix, const GnssQuality& q) noexcept {
  const auto past = history_.at(taken_at(fix));
  if (!past || !heading_known_ || q.drift.sigma_m > 0.0 || !asks_about_shifts_) {
    if (!health_.base_shift || !asks_about_shifts_) shift_watch_.forget();
  } else {
    const Arm to_antenna = arm(past->x(kYaw));
    const base::EnuPoint at{past->x(kEast) + to_antenna.east_m,
                            past->x(kNorth) + to_antenna.north_m};
    const base::EnuPoint off = local(fix) - at;
    const double honest_m = kSurprises * std::hypot(claimed_m(belief_), q.sigma_east_m);
    const double far_m = std::hypot(off.east_m, off.north_m);
    shift_watch_.take(off, far_m > honest_m && far_m < kFar_m, counted_m_, fix.stamp);
  }
  const auto by = shift_watch_.shift();
  if (by && !health_.base_shift) health_.base_shift = {*by, shift_watch_.since()};
  if (by) health_.base_shift->offset = *by;
  if (!by && (!asks_about_shifts_ || shift_watch_.agrees())) health_.base_shift.reset();
  if (!health_.base_shift) return false;
  refused_m_ = std::hypot(health_.base_shift->offset.east_m, health_.base_shift->offset.north_m);
  if (!position_off_since_) position_off_since_ = fix.stamp;
  return true;
}

double Estimator::doubt_after_s(const GnssQuality& q) const noexcept {
  return asks_about_shifts_ && q.drift.sigma_m <= 0.0 ? kDoubtShiftAfter_s : kDoubtAfter_s;
}

/// A worse fix: the position stays, and the offset of the new class is open. A better one: the
/// position is as uncertain as it was, and moves there slowly.
void Estimator::change_class(const base::GnssFix& fix, const GnssQuality& q) noexcept {
  if (health_.anchor) {
    if (fix.fix == anchor_type_) anchor_off_since_.reset();
    if (fix.fix != anchor_type_ && !anchor_off_since_) anchor_off_since_ = fix.stamp;
    if (anchor_off_since_ && fix.stamp - *anchor_off_since_ >= kAnchorClass) drop_anchor();
  }
  drift_ = q.drift;
  if (fix.fix == fused_type_) return;
  if (fix.fix > fused_type_) {
    approaching_ = true;
    approach_mps_ = kApproach_mps;
    approach_until_ = fix.stamp + kApproach;
  }
  fused_type_ = fix.fix;
  // Reflections move every class alike: another word for them is no second one.
  if (wandered_ && fix.fix != base::FixType::RtkFixed) return;
  for (const StateIndex i : {kDriftE, kDriftN}) reset_state(belief_, i, 0.0, q.drift.sigma_m);
}

void Estimator::first_fix(const base::GnssFix& fix, const GnssQuality& q) {
  const bool reachable =
      frame_ && base::distance_bearing(frame_->origin(), *fix.position).distance_m <
                    base::LocalFrame::kReach_m;
  if (!reachable) frame_.emplace(next_frame_id_, *fix.position);
  drift_ = q.drift;
  fused_type_ = fix.fix;
  reset_position(local(fix), q);
  located_ = true;
  located_since_ = fix.stamp;
  proving_at_.reset();
  proving_s_ = 0.0;
  last_fused_ = fix.stamp;
  last_satellites_ = now_;
  free_m_ = 0.0;
  placed_ = false;
}

void Estimator::reset_position(base::EnuPoint at, const GnssQuality& q) noexcept {
  const double drift_var = q.drift.sigma_m * q.drift.sigma_m;
  const Arm to_antenna = arm(belief_.x(kYaw));
  const double arm_m = std::hypot(to_antenna.east_m, to_antenna.north_m);
  if (heading_known_) at = at - base::EnuPoint{to_antenna.east_m, to_antenna.north_m};
  const double unknown_m = heading_known_ ? 0.0 : arm_m;
  StateVector change = StateVector::Zero();
  change(kEast) = at.east_m - belief_.x(kEast);
  change(kNorth) = at.north_m - belief_.x(kNorth);
  reset_state(belief_, kEast, at.east_m, std::hypot(q.sigma_east_m, q.drift.sigma_m, unknown_m));
  reset_state(belief_, kNorth, at.north_m, std::hypot(q.sigma_north_m, q.drift.sigma_m, unknown_m));
  reset_state(belief_, kDriftE, 0.0, q.drift.sigma_m);
  reset_state(belief_, kDriftN, 0.0, q.drift.sigma_m);
  // What the drift is more than thought, the position is less.
  belief_.P(kEast, kDriftE) = belief_.P(kDriftE, kEast) = -drift_var;
  belief_.P(kNorth, kDriftN) = belief_.P(kDriftN, kNorth) = -drift_var;
  history_.shift(change);
}

/// What a fixed position lacks that seems to run away, before it is proved: odometry, gyro and
/// velocity lead meanwhile.
double Estimator::suspected_m(const GnssQuality& q) const noexcept {
  if (q.drift.sigma_m > 0.0) return 0.0;
  const double apart = votes_.out(base::Sense::Velocity) ? 0.0 : votes_.apart();
  const double part = std::clamp((apart - kSuspect) / (kSuspectAll - kSuspect), 0.0, 1.0);
  return kSuspect_m * std::max(part, suspected_course());
}

/// Of a receiver that seems to run off from tracks and gyro: 1 is all.
double Estimator::suspected_course() const noexcept {
  return std::clamp((votes_.off_course() - kSuspectOff) / (kSuspectOffAll - kSuspectOff), 0.0, 1.0);
}

void Estimator::fuse_position(const base::GnssFix& fix, const GnssQuality& q) noexcept {
  Input& in = health_.position;
  const auto past = history_.at(taken_at(fix));
  const StateVector& at = past ? past->x : belief_.x;
  const Arm to_antenna = arm(at(kYaw));
  const base::EnuPoint z = local(fix);

  Observation<2> o;
  o.innovation << z.east_m - at(kEast) - at(kDriftE) - to_antenna.east_m,
      z.north_m - at(kNorth) - at(kDriftN) - to_antenna.north_m;
  o.H(0, kEast) = o.H(1, kNorth) = 1.0;
  if (q.drift.sigma_m > 0.0) o.H(0, kDriftE) = o.H(1, kDriftN) = 1.0;
  if (heading_known_) {
    // What is believed now of yaw and slip is true of the way since then as well: an antenna that
    // trails behind.
    const double since_rad = past ? sums_.turned_rad - past->turned_rad : 0.0;
    const double then_rad = at(kYaw);
    const Eigen::Vector2d per_pivot{std::cos(then_rad) - std::cos(then_rad + since_rad),
                                    std::sin(then_rad) - std::sin(then_rad + since_rad)};
    const double whole_e = at(kEast) - belief_.x(kEast);
    const double whole_n = at(kNorth) - belief_.x(kNorth);
    o.H(0, kYaw) = -(to_antenna.north_m + whole_n);
    o.H(1, kYaw) = to_antenna.east_m + whole_e;
    o.H(0, kPivot) = -per_pivot.x();
    o.H(1, kPivot) = -per_pivot.y();
    // The turns' part of it is none that was driven.
    const double behind_e = whole_e + belief_.x(kPivot) * per_pivot.x();
    const double behind_n = whole_n + belief_.x(kPivot) * per_pivot.y();
    const double scale = belief_.x(kScale);
    o.H(0, kScale) = o.H(1, kCrab) = behind_e / scale;
    o.H(1, kScale) = behind_n / scale;
    o.H(0, kCrab) = -behind_n / scale;
    o.H(0, kSlideE) = o.H(1, kSlideN) = -std::hypot(behind_e, behind_n);
  }
  const double weak_m = suspected_m(q);
  o.R(0, 0) = q.sigma_east_m * q.sigma_east_m + weak_m * weak_m;
  o.R(1, 1) = q.sigma_north_m * q.sigma_north_m + weak_m * weak_m;
  o.gate = kGate2;
  const bool slowly = approaching_;
  if (slowly) approach(o);
  const bool late = slowly && !approaching_ && approach_mps_ < kApproach_mps;
  if (approaching_ && approach_mps_ < kApproach_mps) only_the_place(o);
  // What is weakened for another reason tells nothing of the ground.
  if (q.drift.sigma_m <= 0.0 && weak_m == 0.0 && !approaching_) watch_slip(o, at(kYaw), fix.stamp);
  if (standing_) {
    const bool hold = settled_in(located_since_) && q.drift.sigma_m > 0.0 && !approaching_;
    o.may_change.setZero();
    o.may_change(kDriftE) = o.may_change(kDriftN) = 1.0;
    if (!hold) o.may_change(kEast) = o.may_change(kNorth) = 1.0;
  }
  // Doubt has opened the gate, or the slow way took too long: what comes through moves the position
  // at once, and is told.
  std::optional<Belief> before;
  const bool doubted = doubted_m_ > 0.0;
  if (doubted || late ||
      (position_off_since_ && seconds(fix.stamp - *position_off_since_) > doubt_after_s(q))) {
    before = belief_;
  }
  if (apply(in, o)) {
    if (before) {
      const double moved_m =
          std::hypot(belief_.x(kEast) - before->x(kEast), belief_.x(kNorth) - before->x(kNorth));
      if (moved_m > kToldFrom_m) note_reset("position", *before);
    }
    in.refused_since.reset();
    count_as_proof(fix.stamp);
    if (fix.fix != base::FixType::Single) {
      coarse_walk_.found();
    } else if (last_fused_) {
      coarse_walk_.led(!standing_, std::min(1.0, seconds(fix.stamp - *last_fused_)),
                       q.drift.sigma_m);
    }
    last_fused_ = fix.stamp;
    last_satellites_ = now_;
    free_m_ = 0.0;
    placed_ = false;
    position_off_since_.reset();
    far_off_since_.reset();
    claimed_when_off_m_.reset();
    doubted_m_ = 0.0;
    return;
  }
  refuse(in, Refusal::Jump);
  position_refused(fix, q, o.innovation.norm());
}

/// What the innovation says of the ground. One that is too large for the filter, but not for a
/// robot that slipped on the way since the last position, opens the filter instead of being
/// refused.
void Estimator::watch_slip(const Observation<2>& o, double yaw_rad, Time stamp) noexcept {
  if (standing_ || !has_odometry(stamp) || !last_fused_) return;
  const Eigen::Vector2d along{std::cos(yaw_rad), std::sin(yaw_rad)};
  const Eigen::Vector2d aside{-along.y(), along.x()};
  Eigen::Matrix2d S = o.H * belief_.P * o.H.transpose() + o.R;
  const double dt_s = seconds(stamp - *last_fused_);
  const double nis = o.innovation.dot(S.inverse() * o.innovation);
  const double slipped_m = kSlips * free_m_;
  if (nis > kSlipsFrom && o.innovation.norm() < slipped_m + 3.0 * std::sqrt(o.R(0, 0))) {
    slip_watch_.burst();
    belief_.P(kEast, kEast) += 0.25 * slipped_m * slipped_m;
    belief_.P(kNorth, kNorth) += 0.25 * slipped_m * slipped_m;
    S = o.H * belief_.P * o.H.transpose() + o.R;
  }
  const double off_along = o.innovation.dot(along);
  const double off_aside = o.innovation.dot(aside);
  slip_watch_.take(off_along * off_along / along.dot(S * along),
                   off_aside * off_aside / aside.dot(S * aside), dt_s);
}

/// Weakens a fix so much that it moves the estimate no faster than it may. With y what is missing
/// and p the variance of it, the gain p/(p + R) must not exceed step/y.
void Estimator::approach(Observation<2>& o) noexcept {
  const double off_m = o.innovation.norm();
  const double floor_m = std::sqrt(std::max(o.R(0, 0), o.R(1, 1)));
  const bool another = approach_mps_ < kApproach_mps;  // source, not a better class of this one
  if (off_m < (another ? kArrived_m : 2.0 * floor_m + 0.03) || now_ > approach_until_) {
    approaching_ = false;
    return;
  }
  const double since_s = last_fused_ ? std::clamp(seconds(now_ - *last_fused_), 0.02, 0.5) : 0.2;
  const double step_m = approach_mps_ * since_s;
  const Eigen::Matrix2d p = o.H * belief_.P * o.H.transpose();
  const double variance = std::max(p(0, 0), p(1, 1));
  if (off_m <= step_m) return;
  const double least = variance * (off_m / step_m - 1.0);
  o.R(0, 0) = std::max(o.R(0, 0), least);
  o.R(1, 1) = std::max(o.R(1, 1), least);
}

void Estimator::position_refused(const base::GnssFix& fix, const GnssQuality& q,
                                 double off_m) noexcept {
  if (!position_off_since_) {
    position_off_since_ = fix.stamp;
    claimed_when_off_m_ = claimed_m(belief_);
  }
  refused_m_ = off_m;
  if (off_m <= kFar_m) far_off_since_.reset();
  if (off_m > kFar_m && !far_off_since_) far_off_since_ = fix.stamp;
  const double off_s = seconds(fix.stamp - *position_off_since_);
  const bool far = far_off_since_ && fix.stamp - *far_off_since_ >= std::chrono::seconds(1);
  if (off_s >= kResetAfter_s || far) {
    const Belief before = belief_;
    reset_position(local(fix), q);
    note_reset("position", before);
    position_off_since_.reset();
    far_off_since_.reset();
    claimed_when_off_m_.reset();
    doubted_m_ = 0.0;
    health_.position.refused_since.reset();
    last_fused_ = fix.stamp;
    last_satellites_ = now_;
    free_m_ = 0.0;
    placed_ = false;
  } else if (off_s > doubt_after_s(q)) {
    const double more = kDoubt_m2ps * 0.2;
    belief_.P(kEast, kEast) += more;
    belief_.P(kNorth, kNorth) += more;
  }
}

}  // namespace roverd::nav
