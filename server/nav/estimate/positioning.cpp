// What the operator tells of the place, and what the estimator tells of itself.

#include <cmath>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::Alignment;
using base::rad_from_deg;

constexpr double kPlaced_m = 0.10;    // how well a person says where it stands
constexpr double kAnchored_m = 0.15;  // and drives it onto a point
constexpr double kShifted_m = 0.10;   // of a shift, as it was measured while driving
const double kPlaced_rad = rad_from_deg(3.0);
const double kHint_rad = rad_from_deg(20.0);  // less certain: hardly more than a guess
constexpr double kLeaveAligned = 1.5;         // hysteresis

}  // namespace

void Estimator::note_reset(std::string_view what, const Belief& before) noexcept {
  ++health_.resets;
  base::EstimateReset reset;
  reset.what = what;
  if (located_) {
    reset.jump = {before.x(kEast) - belief_.x(kEast), before.x(kNorth) - belief_.x(kNorth)};
  }
  reset.jump_rad = base::angle_diff_rad(belief_.x(kYaw), before.x(kYaw));
  reset.claimed_m = claimed_when_off_m_.value_or(claimed_m(before));
  reset.claimed_rad = std::sqrt(before.P(kYaw, kYaw));
  reset.stamp = now_;
  health_.last_reset = reset;
  beside_.reset();  // it was told of the place until now
}

void Estimator::move(base::EnuPoint to, double sigma_m) noexcept {
  StateVector change = StateVector::Zero();
  change(kEast) = to.east_m - belief_.x(kEast);
  change(kNorth) = to.north_m - belief_.x(kNorth);
  reset_state(belief_, kEast, to.east_m, sigma_m);
  reset_state(belief_, kNorth, to.north_m, sigma_m);
  history_.shift(change);
}

void Estimator::place(std::optional<base::EnuPoint> at, std::optional<double> yaw_rad) noexcept {
  const Belief before = belief_;
  if (at) {
    move(*at, kPlaced_m);
    // The receiver may mean another place: its offset is open.
    for (const StateIndex i : {kDriftE, kDriftN}) reset_state(belief_, i, 0.0, drift_.sigma_m);
    if (!located_) located_since_ = now_;
    located_ = true;
    placed_ = true;
    denial_counted_ = false;  // of this word anew
    differed_m_ = 0.0;
    coarse_walk_.found();
    last_fused_ = now_;
    free_m_ = 0.0;
    approaching_ = false;
    claimed_when_off_m_.reset();
    doubted_m_ = 0.0;
    position_off_since_.reset();
    far_off_since_.reset();
  }
  if (yaw_rad) {
    set_heading(*yaw_rad, kPlaced_rad);
    reset_state(belief_, kBias, belief_.x(kBias), rad_from_deg(params_->compass_bias_sigma_deg));
    velocity_off_since_.reset();
    compass_off_since_.reset();
  }
  note_reset("pose", before);
}

void Estimator::doubt_position(double sigma_m) noexcept {
  if (!located_) return;
  for (const StateIndex i : {kEast, kNorth}) {
    const double known_m = std::sqrt(belief_.P(i, i));
    reset_state(belief_, i, belief_.x(i), std::hypot(known_m, sigma_m));
  }
  located_since_ = now_;
  proving_at_.reset();
  proving_s_ = 0.0;
  claimed_when_off_m_.reset();  // from now on it claims no more than that
}

void Estimator::anchor(base::EnuPoint at, std::optional<int> item) noexcept {
  const Belief before = belief_;
  const base::EnuPoint here{belief_.x(kEast), belief_.x(kNorth)};
  base::Anchor a;
  a.offset = at - here;
  if (health_.anchor) a.offset = a.offset + health_.anchor->offset;
  a.at = frame_->to_global(at);
  a.item = item;
  a.stamp = now_;
  health_.anchor = a;
  anchor_type_ = fused_type_;
  anchor_off_since_.reset();
  move(at, kAnchored_m);
  differed_m_ = 0.0;
  note_reset("anchor", before);
}

void Estimator::drop_anchor() noexcept {
  if (!health_.anchor) return;
  // Nothing jumps: the receiver's own position is approached slowly.
  const base::EnuPoint off = health_.anchor->offset;
  belief_.P(kEast, kEast) += off.east_m * off.east_m;
  belief_.P(kNorth, kNorth) += off.north_m * off.north_m;
  health_.anchor.reset();
  anchor_off_since_.reset();
  approaching_ = true;
  approach_mps_ = kApproach_mps;
  approach_until_ = now_ + std::chrono::seconds(20);
}

void Estimator::settle_shift(bool keep) noexcept {
  if (!health_.base_shift) return;
  const Belief before = belief_;
  const base::EnuPoint by = health_.base_shift->offset;
  const base::EnuPoint here{belief_.x(kEast), belief_.x(kNorth)};
  if (keep) {
    base::Anchor a;
    a.offset = base::EnuPoint{} - by;
    if (health_.anchor) a.offset = a.offset + health_.anchor->offset;
    a.at = frame_->to_global(here);
    a.stamp = now_;
    health_.anchor = a;
    anchor_type_ = fused_type_;
    anchor_off_since_.reset();
  }
  move(keep ? here : here + by, std::hypot(claimed_m(before), kShifted_m));
  differed_m_ = 0.0;
  health_.base_shift.reset();
  shift_watch_.forget();
  position_off_since_.reset();
  far_off_since_.reset();
  claimed_when_off_m_.reset();
  doubted_m_ = 0.0;
  note_reset(keep ? "anchor" : "position", before);
}

void Estimator::watch_alignment() noexcept {
  const double sigma_rad = heading_known_ ? std::sqrt(belief_.P(kYaw, kYaw)) : base::kPi;
  const bool was = alignment_ == Alignment::Aligned;
  const double enough = rad_from_deg(params_->aligned_deg) * (was ? kLeaveAligned : 1.0);
  alignment_ = sigma_rad <= enough      ? Alignment::Aligned
               : sigma_rad <= kHint_rad ? Alignment::Aligning
                                        : Alignment::Unknown;
}

base::Alignment Estimator::alignment() const noexcept {
  return alignment_;
}

/// For a driver.
std::string_view Estimator::advice() const noexcept {
  if (!located_) return "wait for a position: put the robot where it sees the sky";
  if (alignment_ == Alignment::Aligned) return {};
  const bool velocity = velocity_ && now_ - velocity_->stamp < std::chrono::seconds(2);
  if (!velocity) return "say where the robot points, or drive it where its receiver sees the sky";
  return standing_ || !has_moved_ ? "drive 3 m straight to find the heading"
                                  : "drive on straight: the heading is being found";
}

base::EstimatorHealth Estimator::health() const noexcept {
  base::EstimatorHealth h = health_;
  h.alignment = alignment_;
  h.advice = advice();
  h.gyro = gyro_used_;
  if (last_inertial_) h.gyro_bias_radps = belief_.x(kGyroBias);
  h.compass_bias_rad = belief_.x(kBias);
  h.odometry_scale = belief_.x(kScale);
  h.pull_1pm = belief_.x(kPull);
  h.pivot_m = belief_.x(kPivot);
  const Eigen::Vector2d way = way_per_m(belief_.x, belief_.x(kYaw), 1.0);
  h.side_slip = std::cos(belief_.x(kYaw)) * way.y() - std::sin(belief_.x(kYaw)) * way.x();
  if (located_ && drift_.sigma_m > 0.0) {
    h.gnss_offset = base::EnuPoint{belief_.x(kDriftE), belief_.x(kDriftN)};
  }
  h.receivers_disagree = receivers_.disagree();
  h.free_m = free_m_;
  h.placed = placed_;
  h.by_landmark = landmarks_led_ && !health_.by_map;
  h.votes = votes_.told();
  return h;
}

}  // namespace roverd::nav
