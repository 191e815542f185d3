// The place in a map: what the matcher says, who leads, satellites or map, and how the lead changes
// without a jump.

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::Refusal;
using base::seconds;

constexpr base::Duration kPlaceTooOld = std::chrono::seconds(1);
constexpr base::Duration kPlaceFresh = std::chrono::seconds(2);
constexpr base::Duration kSatellitesFresh = std::chrono::milliseconds(1500);
constexpr double kLead_mps = 0.06;    // so fast the estimate goes to another source: with the last
                                      // step less than 0.1 m/s
constexpr double kTogether_s = 1.0;   // matches within it are wrong in the same way
constexpr double kAgree_m = 1.0;      // satellites and map mean one place
constexpr double kLostDoubt_m = 5.0;  // whoever was carried may be anywhere
constexpr double kTold_m = 0.2;
constexpr base::Duration kSetAnewAfter = std::chrono::seconds(1);
constexpr int kSetAnewFixes = 5;
constexpr base::Duration kAgainAndAgain = std::chrono::seconds(1);  // from refusal to refusal
// No map is surer than its cells and its scanner.
constexpr double kMapFloor_m = 0.015;
constexpr double kMapFloor_rad = 0.009;
constexpr double kTap_m = 3.0;  // that a person may be off

bool sound(const base::PlaceFix& fix) noexcept {
  const auto& c = fix.covariance;
  for (const double value : c) {
    if (!std::isfinite(value)) return false;
  }
  return base::is_valid(fix.at) && base::is_valid(fix.anchor) && std::isfinite(fix.yaw_rad) &&
         std::isfinite(fix.anchor_sigma_m) && fix.anchor_sigma_m >= 0.0 &&
         std::isfinite(fix.anchor_yaw_sigma_rad) && fix.anchor_yaw_sigma_rad >= 0.0 && c[0] > 0.0 &&
         c[2] > 0.0 && c[5] > 0.0 && c[0] * c[2] > c[1] * c[1];
}

Eigen::Matrix2d place_covariance(const base::PlaceFix& fix) noexcept {
  Eigen::Matrix2d r;
  r << fix.covariance[0], fix.covariance[1], fix.covariance[1], fix.covariance[2];
  constexpr double kLeast = kMapFloor_m * kMapFloor_m;
  r(0, 0) = std::max(r(0, 0), kLeast);
  r(1, 1) = std::max(r(1, 1), kLeast);
  return r;
}

/// Of its heading on the earth: what the match errs by, and what the map lies askew by.
double yaw_variance(const base::PlaceFix& fix) noexcept {
  const double askew = fix.anchor_yaw_sigma_rad * fix.anchor_yaw_sigma_rad;
  return std::max(fix.covariance[5], kMapFloor_rad * kMapFloor_rad) + askew;
}

}  // namespace

bool Estimator::map_is_fresh() const noexcept {
  return last_by_map_ && now_ - *last_by_map_ < kPlaceFresh;
}

/// The map's own error, which no number of matches takes away.
double Estimator::map_floor_m() const noexcept {
  return health_.by_map ? kMapFloor_m : 0.0;
}
double Estimator::map_floor_rad() const noexcept {
  return health_.by_map && map_is_fresh() ? std::hypot(kMapFloor_rad, map_yaw_sigma_rad_) : 0.0;
}

/// Satellites that need no help: fixed, heard of just now, and since a person said where it stands.
bool Estimator::satellites_lead() const noexcept {
  return !health_.by_map && !placed_ && drift_.sigma_m <= 0.0 && last_satellites_ &&
         now_ - *last_satellites_ < kSatellitesFresh;
}

void Estimator::take(const base::PlaceState& told) {
  watch_denial(told);
  if (!told.fix) return;
  Input& in = health_.place;
  base::PlaceFix fix = *told.fix;
  if (!sound(fix)) return refuse(in, Refusal::NotFinite);
  if (!in_order(in, last_place_, told.stamp)) return;
  if (now_ - told.stamp > kPlaceTooOld || history_.forgotten(told.stamp)) {
    return refuse(in, Refusal::Stamp);
  }
  if (!frame_) frame_.emplace(next_frame_id_, fix.anchor);
  if (base::distance_bearing(frame_->origin(), fix.at).distance_m > base::LocalFrame::kReach_m) {
    return refuse(in, Refusal::Impossible);
  }
  ask_north(fix);
  if (fix.map != map_) {
    map_ = fix.map;
    health_.map_offset = {};
    map_offset_.begin(fix.anchor_sigma_m);
    map_found_ = fix.found;
  }
  if (!located_ || !heading_known_) return first_place(fix, told.stamp);
  if (satellites_lead()) return follow_satellites(fix, told.stamp);
  fuse_place(fix, told.stamp);
}

/// Which way north is by a person's word nobody asks indoors. From the first satellites on it is no
/// surer than the word, and so is the heading that was believed by it.
void Estimator::ask_north(base::PlaceFix& fix) noexcept {
  const bool same = fix.map == map_;
  const bool heard = (beside_ && now_ - beside_->at < kPlaceFresh) ||
                     (last_satellites_ && now_ - *last_satellites_ < kPlaceFresh);
  north_asked_ = (same && north_asked_) || heard;
  north_said_rad_ = fix.north_said ? fix.anchor_yaw_sigma_rad : 0.0;
  if (fix.north_said && !north_asked_) fix.anchor_yaw_sigma_rad = 0.0;
  const double more =
      fix.anchor_yaw_sigma_rad * fix.anchor_yaw_sigma_rad - map_yaw_sigma_rad_ * map_yaw_sigma_rad_;
  if (same && health_.by_map && more > 0.0) belief_.P(kYaw, kYaw) += more;
  map_yaw_sigma_rad_ = fix.anchor_yaw_sigma_rad;
}

/// A person's word, and what the map said itself, are outweighed by what is seen; what satellites
/// or known places have told since are not: where they see it, there may be no map.
void Estimator::watch_denial(const base::PlaceState& told) noexcept {
  const bool lost = told.phase == base::PlacePhase::Lost;
  if (!told.denied && !lost) {
    denial_counted_ = false;
    return;
  }
  if (denial_counted_ || !located_ || !(health_.by_map || placed_)) return;
  denial_counted_ = true;
  doubt_position(kLostDoubt_m);
}

/// From a moment to now. What was driven since then went by the heading of then.
/// @param yaw_rad which way it pointed then, as is known by now
Estimator::Since Estimator::driven_since(const StateVector& then, double yaw_rad) const noexcept {
  const double askew = base::angle_diff_rad(then(kYaw), yaw_rad);
  const Eigen::Vector2d way{belief_.x(kEast) - then(kEast), belief_.x(kNorth) - then(kNorth)};
  const Eigen::Vector2d turned = Eigen::Rotation2Dd(askew) * way;
  return {{turned.x(), turned.y()}, base::angle_diff_rad(then(kYaw), belief_.x(kYaw))};
}

void Estimator::first_place(const base::PlaceFix& fix, Time stamp) noexcept {
  const Belief before = belief_;
  const Eigen::Matrix2d r = place_covariance(fix);
  const auto past = history_.at(stamp);
  const StateVector at = past ? past->x : belief_.x;
  const base::EnuPoint seen = frame_->to_local(fix.at);
  const Since since = driven_since(at, heading_known_ ? at(kYaw) : fix.yaw_rad);
  if (located_) {  // so its heading is not known: not by a place that is not its own
    const Eigen::Vector2d off{seen.east_m + health_.map_offset.east_m - at(kEast),
                              seen.north_m + health_.map_offset.north_m - at(kNorth)};
    const Eigen::Matrix2d S = belief_.P.block<2, 2>(kEast, kEast) + map_offset_.covariance() + r;
    const bool near = off.dot(S.inverse() * off) <= kGate2 || (placed_ && off.norm() < kTap_m);
    if (!near) return place_refused(fix, stamp, {off(0), off(1)});
  }
  if (!heading_known_) {
    set_heading(fix.yaw_rad + since.turned_rad, std::sqrt(yaw_variance(fix)));
    note_reset("map", before);
  }
  if (located_) return;  // its place is the next one's matter
  move(seen + since.way, std::sqrt(std::max(r(0, 0), r(1, 1))));
  located_since_ = now_;
  located_ = true;
  lead_by_map(stamp);
  lead_until_.reset();
}

/// The map is not needed: what it says beside the satellites is what its anchor is off by, and will
/// be taken from it when they are gone.
void Estimator::follow_satellites(const base::PlaceFix& fix, Time stamp) noexcept {
  const auto past = history_.at(stamp);
  const StateVector& at = past ? past->x : belief_.x;
  const base::EnuPoint z = frame_->to_local(fix.at);
  const base::EnuPoint off{at(kEast) - z.east_m, at(kNorth) - z.north_m};
  const double far_m = base::distance_m(off, health_.map_offset);
  if (far_m > kAgree_m + 3.0 * map_offset_.sigma_m()) {
    forget_refused();
    return refuse(health_.place, Refusal::Jump);
  }
  // Along what the map shows only: a bare corridor says nothing of the way along it.
  const Eigen::Matrix2d r = place_covariance(fix) + belief_.P.block<2, 2>(kEast, kEast);
  const double since_s = offset_learned_at_
                             ? std::clamp(seconds(now_ - *offset_learned_at_), 0.02, kTogether_s)
                             : kTogether_s;
  offset_learned_at_ = now_;
  const Eigen::Matrix2d gain = map_offset_.learn(r * (kTogether_s / since_s));
  base::EnuPoint& offset = health_.map_offset;
  const Eigen::Vector2d by =
      gain * Eigen::Vector2d{off.east_m - offset.east_m, off.north_m - offset.north_m};
  offset = {offset.east_m + by(0), offset.north_m + by(1)};
  forget_refused();
  health_.place.refused_since.reset();
}

void Estimator::lead_by_map(Time stamp) noexcept {
  health_.by_map = true;
  last_by_map_ = now_;
  coarse_walk_.found();
  last_fused_ = stamp;
  free_m_ = 0.0;
  placed_ = false;
  approaching_ = false;
  forget_refused();
  position_off_since_.reset();
  far_off_since_.reset();
  claimed_when_off_m_.reset();
  doubted_m_ = 0.0;
  health_.place.refused_since.reset();
}

void Estimator::fuse_place(const base::PlaceFix& fix, Time stamp) noexcept {
  const auto past = history_.at(stamp);
  const StateVector& at = past ? past->x : belief_.x;
  const bool changes = !health_.by_map;
  const double since_s = last_by_map_ ? std::clamp(seconds(now_ - *last_by_map_), 0.02, 1.0) : 1.0;
  const base::EnuPoint z = frame_->to_local(fix.at) + health_.map_offset;
  Observation<2> o;
  o.innovation << z.east_m - at(kEast), z.north_m - at(kNorth);
  o.H(0, kEast) = o.H(1, kNorth) = 1.0;
  o.R = place_covariance(fix);
  o.gate = kGate2;
  const double off_m = o.innovation.norm();
  if (placed_ && off_m < kTap_m) {  // a person's word is worth no more than that
    doubt_position(off_m);
    belief_.P(kYaw, kYaw) += std::pow(base::angle_diff_rad(at(kYaw), fix.yaw_rad), 2);
  }
  const base::EnuPoint off{o.innovation(0), o.innovation(1)};
  const bool anew = map_found_ != fix.found || doubted_m_ > 0.0;
  const bool asked = anew && health_.by_map && !placed_;
  if (!believable(o, fix, at(kYaw)) || (asked && satellites_object(off))) {
    return place_refused(fix, stamp, off);
  }
  if (changes) {
    if (last_satellites_ && drift_.sigma_m <= 0.0 && !placed_) share_with_anchor(o);
    lead_until_ = placed_ ? std::nullopt : std::optional(now_ + std::chrono::minutes(2));
  }
  o.R *= std::max(1.0, kTogether_s / since_s);
  const bool slowly = lead_until_.has_value();
  if (slowly) weaken(o, since_s);
  if (lead_until_) only_the_place(o);
  o.gate = 0.0;  // it was asked before it was weakened
  std::optional<Belief> before;
  if (anew || (slowly && !lead_until_)) before = belief_;  // it took too long: the rest is a jump
  if (!apply(health_.place, o)) return refuse(health_.place, Refusal::Jump);
  fuse_place_heading(fix, at, since_s);
  if (before && !lead_until_) {
    const double moved_m =
        std::hypot(belief_.x(kEast) - before->x(kEast), belief_.x(kNorth) - before->x(kNorth));
    if (moved_m > kTold_m && !placed_) note_reset("map", *before);
  }
  map_found_ = fix.found;
  lead_by_map(stamp);
}

/// Does it lie where it can, by what both and the map's anchor honestly err?
bool Estimator::believable(const Observation<2>& o, const base::PlaceFix& fix,
                           double yaw_rad) const noexcept {
  Eigen::Matrix2d S = o.H * belief_.P * o.H.transpose() + o.R;
  if (!health_.by_map) S += map_offset_.covariance();
  const double turned = base::angle_diff_rad(yaw_rad, fix.yaw_rad);
  return o.innovation.dot(S.inverse() * o.innovation) <= kGate2 &&
         turned * turned <= 2.0 * kGate1 * (belief_.P(kYaw, kYaw) + yaw_variance(fix));
}

/// Who leads until now may be surer than the anchor: then it is the anchor that is off, for as long
/// as this map is in use.
void Estimator::share_with_anchor(Observation<2>& o) noexcept {
  const Eigen::Matrix2d believed = belief_.P.block<2, 2>(kEast, kEast);
  const Eigen::Vector2d by = map_offset_.learn(believed + o.R) * o.innovation;
  base::EnuPoint& offset = health_.map_offset;
  offset = {offset.east_m - by(0), offset.north_m - by(1)};
  o.innovation -= by;
}

/// Two sources differ: that says nothing of slip, heading or scale.
void Estimator::only_the_place(Observation<2>& o) noexcept {
  o.may_change.setZero();
  for (const StateIndex i : {kEast, kNorth, kDriftE, kDriftN}) o.may_change(i) = 1.0;
}

/// As approach(): the gain that moves the estimate by what it may.
void Estimator::weaken(Observation<2>& o, double since_s) noexcept {
  const double off_m = o.innovation.norm();
  if (off_m < kArrived_m || now_ > *lead_until_) {
    lead_until_.reset();
    return;
  }
  const double step_m = kLead_mps * std::min(since_s, 0.5);
  if (off_m <= step_m) return;
  const Eigen::Matrix2d p = o.H * belief_.P * o.H.transpose();
  const double most = std::max(p(0, 0), p(1, 1)) + std::abs(p(0, 1));
  const double least = most * (off_m / step_m - 1.0);
  if (least > std::max(o.R(0, 0), o.R(1, 1))) o.R = least * Eigen::Matrix2d::Identity();
}

void Estimator::fuse_place_heading(const base::PlaceFix& fix, const StateVector& at,
                                   double since_s) noexcept {
  Observation<1> o;
  o.innovation(0) = base::angle_diff_rad(at(kYaw), fix.yaw_rad);
  o.H(0, kYaw) = 1.0;
  o.R(0, 0) = yaw_variance(fix) * std::max(1.0, kTogether_s / since_s);
  o.gate = 2.0 * kGate1;
  if (lead_until_) o.may_change(kEast) = o.may_change(kNorth) = 0.0;
  (void)apply(health_.place, o);
}

void Estimator::forget_refused() noexcept {
  map_off_since_.reset();
  map_refused_at_.reset();
  map_refused_ = 0;
}

/// Do satellites that are heard say that it is not so far from the estimate? Those that lead do;
/// beside a map those that tell the two places apart, and do not mean the map's.
bool Estimator::satellites_object(base::EnuPoint off) const noexcept {
  const bool fused = last_satellites_ && now_ - *last_satellites_ < kPlaceFresh;
  if (!health_.by_map) return fused;
  const double off_m = std::hypot(off.east_m, off.north_m);
  if (!beside_ || now_ - beside_->at >= kPlaceFresh) return fused && off_m > kAgree_m;
  const double tells_m = kAgree_m + 3.0 * beside_->sigma_m;
  if (off_m <= tells_m) return false;
  return base::distance_m(beside_->off, {}) <= tells_m ||
         base::distance_m(beside_->off, off) > tells_m;
}

/// Refused again and again while it fits what is seen: the robot was carried, or slipped, and the
/// map is right. Not while satellites say that it is not.
void Estimator::place_refused(const base::PlaceFix& fix, Time stamp, base::EnuPoint off) noexcept {
  refuse(health_.place, Refusal::Jump);
  refused_m_ = std::hypot(off.east_m, off.north_m);
  if (satellites_object(off)) return forget_refused();
  if (map_refused_at_ && now_ - *map_refused_at_ > kAgainAndAgain) forget_refused();
  if (!map_off_since_) map_off_since_ = now_;
  map_refused_at_ = now_;
  ++map_refused_;
  if (map_refused_ < kSetAnewFixes || now_ - *map_off_since_ < kSetAnewAfter) return;
  const Belief before = belief_;
  const auto past = history_.at(stamp);
  const StateVector at = past ? past->x : belief_.x;
  const base::EnuPoint z = frame_->to_local(fix.at) + health_.map_offset;
  const base::EnuPoint since{belief_.x(kEast) - at(kEast), belief_.x(kNorth) - at(kNorth)};
  const double turned = base::angle_diff_rad(at(kYaw), belief_.x(kYaw));
  const Eigen::Matrix2d r = place_covariance(fix);
  move(z + since, std::sqrt(std::max(r(0, 0), r(1, 1))));
  set_heading(fix.yaw_rad + turned, std::sqrt(yaw_variance(fix)));
  note_reset("map", before);
  map_found_ = fix.found;
  lead_by_map(stamp);
  lead_until_.reset();
}

/// A position of satellites while the map leads. @return true: it is dealt with
bool Estimator::beside_the_map(const base::GnssFix& fix, const GnssQuality& q) noexcept {
  if (!health_.by_map) return false;
  Input& in = health_.position;
  const auto past = history_.at(taken_at(fix));
  const StateVector& at = past ? past->x : belief_.x;
  const Arm to_antenna = arm(at(kYaw));
  const base::EnuPoint z = local(fix);
  const base::EnuPoint off{z.east_m - at(kEast) - to_antenna.east_m,
                           z.north_m - at(kNorth) - to_antenna.north_m};
  const double off_m = std::hypot(off.east_m, off.north_m);
  const double sigma_m = std::hypot(std::max(q.sigma_east_m, q.sigma_north_m), q.drift.sigma_m);
  beside_ = Beside{now_, off, sigma_m};
  const bool fixed = q.drift.sigma_m <= 0.0 && fix_trust_.settled();
  if (map_is_fresh()) {
    const bool agree = off_m < kAgree_m + 3.0 * map_offset_.sigma_m();
    if (!fixed || !agree) return learn_beside_the_map(off, fix, q);
  }
  // They lead from now on. Nothing jumps: what they differ by is driven out slowly.
  in.refused_since.reset();
  health_.by_map = false;
  // Every match was wrong by the same: their number made none of them truer. Antennas did.
  const bool antennas =
      last_antennas_ && now_ - *last_antennas_ < kPlaceFresh && !health_.heading.refused_since;
  if (!antennas) {
    belief_.P(kYaw, kYaw) = std::max(belief_.P(kYaw, kYaw), north_said_rad_ * north_said_rad_);
  }
  lead_until_.reset();
  drift_ = q.drift;
  if (fix.fix != fused_type_) {
    for (const StateIndex i : {kDriftE, kDriftN}) reset_state(belief_, i, 0.0, q.drift.sigma_m);
  }
  fused_type_ = fix.fix;
  if (off_m >= kTakeOver_m) return false;  // it is somewhere else: told as a reset
  if (q.drift.sigma_m <= 0.0) {
    belief_.P(kEast, kEast) += off_m * off_m;
    belief_.P(kNorth, kNorth) += off_m * off_m;
  }
  approaching_ = true;
  approach_mps_ = kLead_mps;
  approach_until_ = fix.stamp + std::chrono::minutes(5);
  return false;
}

/// The map says where it is; what they say beside it is their own error.
bool Estimator::learn_beside_the_map(base::EnuPoint off, const base::GnssFix& fix,
                                     const GnssQuality& q) noexcept {
  Input& in = health_.position;
  drift_ = q.drift;
  if (fix.fix != fused_type_) {
    fused_type_ = fix.fix;
    for (const StateIndex i : {kDriftE, kDriftN}) reset_state(belief_, i, 0.0, q.drift.sigma_m);
  }
  if (q.drift.sigma_m <= 0.0) {
    refuse(in, base::Refusal::Jump);
    return true;
  }
  Observation<2> o;
  o.innovation << off.east_m - belief_.x(kDriftE), off.north_m - belief_.x(kDriftN);
  o.H(0, kEast) = o.H(1, kNorth) = 1.0;
  o.H(0, kDriftE) = o.H(1, kDriftN) = 1.0;
  o.R(0, 0) = q.sigma_east_m * q.sigma_east_m;
  o.R(1, 1) = q.sigma_north_m * q.sigma_north_m;
  o.gate = kGate2;
  o.may_change.setZero();
  o.may_change(kDriftE) = o.may_change(kDriftN) = 1.0;
  if (apply(in, o)) {
    in.refused_since.reset();
  } else {
    refuse(in, base::Refusal::Jump);
  }
  return true;
}

}  // namespace roverd::nav
