// Known places that are seen: compared with the estimate, and corrections by them that never jump.

#include "nav/estimate/landmark.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

constexpr base::Duration kSightTooOld = std::chrono::seconds(1);
constexpr double kSightsTogether_s = 1.0;
// So fast the estimate may go to what a known place says: with the last step less than 0.1 m/s.
constexpr double kByLandmark_mps = 0.06;
constexpr double kByLandmark_radps = 0.04;
constexpr double kMostAtOnce_s = 0.5;
constexpr double kNothing = 1e6;  // a variance that says nothing

/// What one more look may tell of an error that all of them share: with it the belief becomes as
/// sure as that error at most. @param p what is believed. @param shared > 0. Variances.
double no_surer_than(double shared, double p) noexcept {
  return p > 1.0001 * shared ? 1.0 / (1.0 / shared - 1.0 / p) : kNothing;
}

/// Weakens an observation until it moves the estimate by no more than it may.
template <int M>
void slow_down(Observation<M>& o, const Belief& b, double step_m, double turn_rad) noexcept {
  const Eigen::Matrix<double, M, M> p = o.H * b.P * o.H.transpose();
  const Eigen::Matrix<double, kStates, M> cross = b.P * o.H.transpose();
  double more = 0.25 * p.trace();
  for (int i = 0; i < 40; ++i) {
    const StateVector change = cross * ((p + o.R).inverse() * o.innovation);
    const bool slow =
        std::hypot(change(kEast), change(kNorth)) <= step_m && std::abs(change(kYaw)) <= turn_rad;
    if (slow) return;
    o.R += more * Eigen::Matrix<double, M, M>::Identity();
    more *= 1.5;
  }
}

bool sound(const LandmarkSight& s) noexcept {
  return std::isfinite(s.at.east_m + s.at.north_m) && s.seen.allFinite() &&
         s.seen_covariance.allFinite() && s.seen_covariance.determinant() > 0.0 &&
         s.seen_covariance(0, 0) > 0.0 && std::isfinite(s.place_sigma_m) && s.place_sigma_m > 0.0 &&
         std::isfinite(s.yaw_rad.value_or(0.0));
}

}  // namespace

/// The place that is known, less where the estimate of then has what was seen.
Observation<2> Estimator::place_of(const LandmarkSight& s, const StateVector& at) const noexcept {
  const Eigen::Rotation2Dd turn(at(kYaw));
  const Eigen::Vector2d arm_e = turn * s.seen;
  Observation<2> o;
  o.innovation << s.at.east_m - at(kEast) - arm_e.x(), s.at.north_m - at(kNorth) - arm_e.y();
  o.H(0, kEast) = o.H(1, kNorth) = 1.0;
  o.H(0, kYaw) = -arm_e.y();
  o.H(1, kYaw) = arm_e.x();
  o.R = turn.toRotationMatrix() * s.seen_covariance * turn.toRotationMatrix().transpose();
  return o;
}

bool Estimator::needs_no_landmark() const noexcept {
  return satellites_lead() || (health_.by_map && map_is_fresh());
}

std::optional<LandmarkLook> Estimator::compare(const LandmarkSight& s, Time now) const noexcept {
  if (!located_ || !heading_known_ || !sound(s) || s.stamp > now || now - s.stamp > kSightTooOld ||
      history_.forgotten(s.stamp)) {
    return std::nullopt;
  }
  const auto past = history_.at(s.stamp);
  const StateVector& at = past ? past->x : belief_.x;
  const Observation<2> o = place_of(s, at);
  const Eigen::Matrix2d p = o.H * belief_.P * o.H.transpose();
  const Eigen::Matrix2d S =
      p + o.R + s.place_sigma_m * s.place_sigma_m * Eigen::Matrix2d::Identity();
  using Axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>;
  LandmarkLook out;
  out.off = {o.innovation(0), o.innovation(1)};
  out.nis = o.innovation.dot(S.inverse() * o.innovation);
  out.sigma_m = std::sqrt(std::max(0.0, Axes(S, Eigen::EigenvaluesOnly).eigenvalues()(1)));
  out.belief_m = std::sqrt(std::max(0.0, Axes(p, Eigen::EigenvaluesOnly).eigenvalues()(1)));
  if (s.yaw_rad) {
    out.turn_rad = base::angle_diff_rad(at(kYaw), *s.yaw_rad);
    out.turn_sigma_rad = std::sqrt(belief_.P(kYaw, kYaw) + s.yaw_sigma_rad * s.yaw_sigma_rad +
                                   s.face_sigma_rad * s.face_sigma_rad);
  }
  if (!std::isfinite(out.nis)) return std::nullopt;
  return out;
}

bool Estimator::correct(const LandmarkSight& s, Time now) noexcept {
  now_ = now;
  const auto look = compare(s, now);
  if (!look || look->nis > kLandmarkGate2 || needs_no_landmark()) return false;
  const double since_s =
      by_landmark_at_ ? std::clamp(base::seconds(now - *by_landmark_at_), 0.0, kMostAtOnce_s) : 0.1;
  const double room_s = landmark_room_s_ = std::min(landmark_room_s_ + since_s, kMostAtOnce_s);
  by_landmark_at_ = now;
  const auto past = history_.at(s.stamp);
  const StateVector at = past ? past->x : belief_.x;
  const double together = std::max(1.0, kSightsTogether_s / std::max(s.since_s, 0.01));
  Observation<2> o = place_of(s, at);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(o.H * belief_.P * o.H.transpose());
  const double shared = s.place_sigma_m * s.place_sigma_m;
  const Eigen::Vector2d least{no_surer_than(shared, axes.eigenvalues()(0)),
                              no_surer_than(shared, axes.eigenvalues()(1))};
  o.R = o.R * together + axes.eigenvectors() * least.asDiagonal() * axes.eigenvectors().transpose();
  slow_down(o, belief_, kByLandmark_mps * room_s, kByLandmark_radps * room_s);
  const StateVector before = belief_.x;
  if (!apply(health_.landmark, o)) return false;
  const double way_m =
      std::hypot(belief_.x(kEast) - before(kEast), belief_.x(kNorth) - before(kNorth));
  const double turned_rad = std::abs(base::angle_diff_rad(before(kYaw), belief_.x(kYaw)));
  landmark_room_s_ =
      std::max(0.0, room_s - std::max(way_m / kByLandmark_mps, turned_rad / kByLandmark_radps));
  if (s.yaw_rad) turn_by(s, at, together);
  last_by_landmark_ = now;
  landmarks_led_ = true;
  coarse_walk_.found();
  last_fused_ = s.stamp;
  free_m_ = 0.0;
  placed_ = false;
  health_.landmark.refused_since.reset();
  return true;
}

bool Estimator::begin(const LandmarkPose& seen, Time now) noexcept {
  now_ = now;
  const bool sound = std::isfinite(seen.at.east_m + seen.at.north_m + seen.yaw_rad) &&
                     seen.sigma_m > 0.0 && seen.sigma_rad > 0.0;
  if (located_ || !frame_ || !sound || seen.stamp > now || now - seen.stamp > kSightTooOld ||
      history_.forgotten(seen.stamp)) {
    return false;
  }
  const Belief before = belief_;
  const auto past = history_.at(seen.stamp);
  const StateVector at = past ? past->x : belief_.x;
  const Since since = driven_since(at, seen.yaw_rad);
  const double askew = base::angle_diff_rad(at(kYaw), seen.yaw_rad);
  const double known = belief_.P(kYaw, kYaw) + seen.sigma_rad * seen.sigma_rad;
  const bool contradicts = heading_known_ && askew * askew > kGate1 * known;
  set_heading(seen.yaw_rad + since.turned_rad, seen.sigma_rad);
  reset_state(belief_, kBias, belief_.x(kBias),
              base::rad_from_deg(params_->compass_bias_sigma_deg));
  if (contradicts) note_reset("heading", before);
  move(seen.at + since.way, seen.sigma_m);
  located_ = true;
  located_since_ = now;
  landmarks_led_ = true;
  last_by_landmark_ = by_landmark_at_ = now;
  last_fused_ = seen.stamp;
  coarse_walk_.found();
  free_m_ = 0.0;
  return true;
}

void Estimator::turn_by(const LandmarkSight& s, const StateVector& at, double together) noexcept {
  Observation<1> o;
  o.innovation(0) = base::angle_diff_rad(at(kYaw), *s.yaw_rad);
  o.H(0, kYaw) = 1.0;
  const double p = belief_.P(kYaw, kYaw);
  const double shared = s.face_sigma_rad * s.face_sigma_rad;
  const double one = s.yaw_sigma_rad * s.yaw_sigma_rad;
  if (o.innovation(0) * o.innovation(0) > kGate1 * (p + shared + one)) return;
  o.R(0, 0) = one * together + no_surer_than(shared, p);
  slow_down(o, belief_, kByLandmark_mps * landmark_room_s_, kByLandmark_radps * landmark_room_s_);
  const StateVector before = belief_.x;
  if (!apply(health_.landmark, o)) return;
  const double way_m =
      std::hypot(belief_.x(kEast) - before(kEast), belief_.x(kNorth) - before(kNorth));
  const double turned_rad = std::abs(base::angle_diff_rad(before(kYaw), belief_.x(kYaw)));
  landmark_room_s_ = std::max(
      0.0, landmark_room_s_ - std::max(way_m / kByLandmark_mps, turned_rad / kByLandmark_radps));
}

/// The first fixed position after known places led: nothing jumps, what the two differ by is driven
/// out slowly.
void Estimator::lead_after_landmarks(const base::GnssFix& fix, const GnssQuality& q) noexcept {
  if (!landmarks_led_ || q.drift.sigma_m > 0.0) return;
  landmarks_led_ = false;
  const auto past = history_.at(taken_at(fix));
  const StateVector& at = past ? past->x : belief_.x;
  const Arm to_antenna = arm(at(kYaw));
  const base::EnuPoint z = local(fix);
  const double off_m = std::hypot(z.east_m - at(kEast) - to_antenna.east_m,
                                  z.north_m - at(kNorth) - to_antenna.north_m);
  if (off_m >= kTakeOver_m) return;  // it is somewhere else: told as a reset
  belief_.P(kEast, kEast) += off_m * off_m;
  belief_.P(kNorth, kNorth) += off_m * off_m;
  approaching_ = true;
  approach_mps_ = kByLandmark_mps;
  approach_until_ = fix.stamp + std::chrono::minutes(5);
}

}  // namespace roverd::nav
