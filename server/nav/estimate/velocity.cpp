// Velocities of the receiver: they make heading and odometry scale observable.

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

constexpr double kSlowest_mps = 0.15;  // below, a velocity says nothing of the direction
constexpr double kReceiverMost_mps = 60.0;
constexpr double kSuspect_mps = 0.6;  // of a receiver that seems to run off from tracks and gyro
const double kCoarse_rad = rad_from_deg(10.0);  // less certain, an angle is fused, not a vector
const double kCourse_rad = rad_from_deg(0.5);   // of a course, beside the velocity's noise
const double kCarried_rad = rad_from_deg(5.0);  // the same of one that tells nothing of itself

}  // namespace

void Estimator::take(const base::GnssVelocity& velocity) {
  Input& in = health_.velocity;
  const double speed = std::hypot(velocity.east_mps, velocity.north_mps);
  if (!std::isfinite(speed)) return refuse(in, Refusal::NotFinite);
  if (speed > kReceiverMost_mps) return refuse(in, Refusal::Impossible);
  if (!in_order(in, last_velocity_, velocity.stamp)) return;
  if (velocity.sigma_mps && !(*velocity.sigma_mps <= params_->speed_accuracy_max_mps)) {
    return refuse(in, Refusal::Accuracy);
  }
  if (receivers_.disagree()) return refuse(in, Refusal::Receivers);
  if (history_.forgotten(taken_at(velocity))) return refuse(in, Refusal::Stamp);
  double sigma_mps = velocity_sigma_mps(fix_trust_.fix(), velocity.sigma_mps);
  const double slower_than_mps = speed > 0.0 ? 0.0 : velocity.sigma_mps.value_or(0.0);
  votes_.velocity({velocity.east_mps, velocity.north_mps}, sigma_mps, taken_at(velocity),
                  velocity.stamp, slower_than_mps);
  wander_watch_.velocity({velocity.east_mps, velocity.north_mps}, taken_at(velocity));
  if (outvoted(base::Sense::Velocity, in)) return;
  velocity_ = velocity;
  sigma_mps = std::hypot(sigma_mps, kSuspect_mps * suspected_course());
  if (!located_) return;
  if (has_odometry(velocity.stamp)) {
    fuse_velocity(velocity, sigma_mps);
  } else {
    fuse_course(velocity, sigma_mps);
  }
}

/// A receiver alone, carried by something that drives forward: its course is the heading.
void Estimator::fuse_course(const base::GnssVelocity& velocity, double sigma_mps) noexcept {
  const double speed = std::hypot(velocity.east_mps, velocity.north_mps);
  if (speed < 3.0 * sigma_mps || speed < 0.3) return;
  const double course = std::atan2(velocity.north_mps, velocity.east_mps);
  const double sigma = std::hypot(sigma_mps / speed, kCarried_rad);
  if (!heading_known_) {
    set_heading(course, sigma);
    return;
  }
  Observation<1> o;
  o.innovation(0) = base::angle_diff_rad(belief_.x(kYaw), course);
  o.H(0, kYaw) = 1.0;
  o.R(0, 0) = sigma * sigma;
  apply(health_.velocity, o);
}

void Estimator::fuse_velocity(const base::GnssVelocity& velocity, double sigma_mps) noexcept {
  const Time t = taken_at(velocity);
  const auto at = history_.at(t);
  const auto before = history_.at(t - milliseconds(50));
  const auto after = history_.at(t + milliseconds(50));
  if (!at || !before || !after || before->stamp >= after->stamp) return;
  const double dt_s = seconds(after->stamp - before->stamp);
  const base::BodyTwist odometry{(after->ahead_m - before->ahead_m) / dt_s,
                                 (after->turned_rad - before->turned_rad) / dt_s};
  if (std::abs(at->x(kScale) * odometry.linear_mps) < kSlowest_mps) {
    health_.velocity.refused_since.reset();
    return;
  }
  if (!align(velocity, sigma_mps, *at, odometry)) fuse_vector(velocity, sigma_mps, *at, odometry);
}

/// While the heading is uncertain by many degrees: the course as an angle, which is linear in it.
/// Reversing, the body points the other way. @return false: certain enough for the vector.
bool Estimator::align(const base::GnssVelocity& velocity, double sigma_mps, const Past& at,
                      const base::BodyTwist& odometry) noexcept {
  const double variance = belief_.P(kYaw, kYaw);
  if (heading_known_ && variance < kCoarse_rad * kCoarse_rad) return false;
  const double w = odometry.angular_radps;
  const Arm to_antenna = heading_known_ ? arm(at.x(kYaw)) : Arm{0.0, 0.0};
  const Eigen::Vector2d turns =
      heading_known_ ? Eigen::Vector2d(w * way_per_rad(at.x, at.x(kYaw))) : Eigen::Vector2d(0, 0);
  const double east = velocity.east_mps + w * to_antenna.north_m - turns.x();
  const double north = velocity.north_mps - w * to_antenna.east_m - turns.y();
  const double speed = std::hypot(east, north);
  if (speed < 3.0 * sigma_mps) return true;
  const double back = odometry.linear_mps < 0.0 ? base::kPi : 0.0;
  const double facing = base::wrap_rad(std::atan2(north, east) + back);
  const double sigma = std::hypot(sigma_mps / speed, kCourse_rad, 0.05 * w);
  // It drives beside where it points by crab and slide, so that a course tells of all three.
  const double way = odometry.linear_mps < 0.0 ? -1.0 : 1.0;
  const double scale = at.x(kScale);
  const auto seen = [&](double yaw_rad) {
    Observation<1> o;
    const double s = std::sin(yaw_rad);
    const double c = std::cos(yaw_rad);
    const double left = at.x(kCrab) + way * (c * at.x(kSlideN) - s * at.x(kSlideE));
    o.innovation(0) = base::angle_diff_rad(yaw_rad + left / scale, facing);
    o.H(0, kYaw) = 1.0;
    o.H(0, kCrab) = 1.0 / scale;
    o.H(0, kSlideE) = -way * s / scale;
    o.H(0, kSlideN) = way * c / scale;
    o.R(0, 0) = sigma * sigma;
    return o;
  };
  if (!heading_known_) {
    set_heading(facing + base::angle_diff_rad(at.x(kYaw), belief_.x(kYaw)), base::kPi);
    apply(health_.velocity, seen(facing));
    return true;
  }
  Observation<1> o = seen(at.x(kYaw));
  o.gate = kGate1;
  if (apply(health_.velocity, o)) {
    velocity_off_since_.reset();
    health_.velocity.refused_since.reset();
    return true;
  }
  refuse(health_.velocity, Refusal::Jump);
  velocity_refused(velocity, odometry.linear_mps, sigma_mps);
  return true;
}

void Estimator::fuse_vector(const base::GnssVelocity& velocity, double sigma_mps, const Past& at,
                            const base::BodyTwist& odometry) noexcept {
  const double v = at.x(kScale) * odometry.linear_mps;
  const double w = odometry.angular_radps;
  const double tracks_mps = std::abs(odometry.linear_mps);
  const double c = odometry.linear_mps * std::cos(at.x(kYaw));
  const double s = odometry.linear_mps * std::sin(at.x(kYaw));
  const Eigen::Vector2d drives =
      tracks_mps * way_per_m(at.x, at.x(kYaw), odometry.linear_mps < 0.0 ? -1.0 : 1.0) +
      w * way_per_rad(at.x, at.x(kYaw));
  const Arm to_antenna = arm(at.x(kYaw));
  Observation<2> o;
  o.innovation << velocity.east_mps - (drives.x() - w * to_antenna.north_m),
      velocity.north_mps - (drives.y() + w * to_antenna.east_m);
  o.H(0, kYaw) = -(drives.y() - tracks_mps * at.x(kSlideN)) - w * to_antenna.east_m;
  o.H(1, kYaw) = drives.x() - tracks_mps * at.x(kSlideE) - w * to_antenna.north_m;
  o.H(0, kScale) = c;
  o.H(1, kScale) = s;
  o.H(0, kCrab) = -s;
  o.H(1, kCrab) = c;
  o.H(0, kSlideE) = o.H(1, kSlideN) = tracks_mps;
  o.H(0, kPivot) = w * std::sin(at.x(kYaw));
  o.H(1, kPivot) = -w * std::cos(at.x(kYaw));
  // While turning, an error of the latency shows as one of the direction.
  const double turning = 0.05 * std::abs(w * v);
  o.R(0, 0) = o.R(1, 1) = sigma_mps * sigma_mps + turning * turning;
  o.gate = kGate2;
  if (apply(health_.velocity, o)) {
    velocity_off_since_.reset();
    health_.velocity.refused_since.reset();
    return;
  }
  refuse(health_.velocity, Refusal::Jump);
  velocity_refused(velocity, v, sigma_mps);
}

void Estimator::velocity_refused(const base::GnssVelocity& velocity, double ahead_mps,
                                 double sigma_mps) noexcept {
  const double speed = std::hypot(velocity.east_mps, velocity.north_mps);
  const bool moving = speed > std::max(0.2, 3.0 * sigma_mps) && std::abs(ahead_mps) > 0.2;
  if (!moving) {
    velocity_off_since_.reset();
    return;
  }
  if (!velocity_off_since_) velocity_off_since_ = velocity.stamp;
  // Moving elsewhere than the heading says for so long: the heading is wrong, not the receiver.
  const bool sure = gyro_used_ && alignment_ == base::Alignment::Aligned;
  if (velocity.stamp - *velocity_off_since_ < std::chrono::seconds(sure ? 5 : 2)) return;
  const Belief before = belief_;
  const double course = std::atan2(velocity.north_mps, velocity.east_mps);
  set_heading(course + (ahead_mps < 0.0 ? base::kPi : 0.0), sigma_mps / speed + 0.05);
  reset_state(belief_, kBias, belief_.x(kBias), base::kPi);
  // What was driven with the wrong heading went to the wrong place.
  for (const StateIndex i : {kEast, kNorth}) {
    reset_state(belief_, i, belief_.x(i), 2.0 + std::sqrt(belief_.P(i, i)));
  }
  velocity_off_since_.reset();
  note_reset("heading", before);
}

}  // namespace roverd::nav
