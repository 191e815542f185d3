#include "robot/first_sight.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Pose2;

constexpr double kSigmas = 3.0;
constexpr double kLeast_m = 0.05;
constexpr double kLeast_rad = 0.02;

Pose2 body_by(const nav::LandmarkSight& s) {
  const Eigen::Vector2d arm = Eigen::Rotation2Dd(*s.yaw_rad) * s.seen;
  return {s.at.east_m - arm.x(), s.at.north_m - arm.y(), *s.yaw_rad};
}

/// Of one look, by the picture alone; of the place on the ground and of the heading.
double look_sigma_m(const nav::LandmarkSight& s) {
  return std::hypot(std::sqrt(std::max(s.seen_covariance(0, 0), s.seen_covariance(1, 1))),
                    s.yaw_sigma_rad * s.seen.norm());
}

}  // namespace

std::optional<nav::LandmarkPose> FirstSight::look(std::size_t which, const nav::LandmarkSight& s,
                                                  const Pose2& body) noexcept {
  if (!s.yaw_rad || !std::isfinite(*s.yaw_rad) || !s.seen.allFinite()) return std::nullopt;
  const Pose2 here = body_by(s);
  const Pose2 expected = odometry_ * body;
  const double east_m = here.x_m - expected.x_m;
  const double north_m = here.y_m - expected.y_m;
  const double yaw_rad = base::angle_diff_rad(expected.yaw_rad, here.yaw_rad);
  const double apart = kSigmas * std::sqrt(2.0);
  const bool goes_on = looks_ > 0 && which == which_ && s.stamp > last_ &&
                       base::seconds(s.stamp - last_) <= kGap_s &&
                       std::hypot(east_m, north_m) <= std::max(kLeast_m, apart * look_sigma_m(s)) &&
                       std::abs(yaw_rad) <= std::max(kLeast_rad, apart * s.yaw_sigma_rad);
  if (!goes_on) {
    *this = FirstSight{};
    which_ = which;
    looks_ = 1;
    first_ = last_ = s.stamp;
    odometry_ = here * inverse(body);
    return std::nullopt;
  }
  last_ = s.stamp;
  ++looks_;
  off_east_m_ += east_m;
  off_north_m_ += north_m;
  off_yaw_rad_ += yaw_rad;
  if (looks_ < kLooks || base::seconds(last_ - first_) < kLooksFor_s) return std::nullopt;
  const double n = looks_;
  nav::LandmarkPose out;
  out.stamp = s.stamp;
  out.at = {expected.x_m + off_east_m_ / n, expected.y_m + off_north_m_ / n};
  out.yaw_rad = base::wrap_rad(expected.yaw_rad + off_yaw_rad_ / n);
  out.sigma_rad = std::hypot(s.yaw_sigma_rad, s.face_sigma_rad);
  out.sigma_m = std::hypot(s.place_sigma_m, look_sigma_m(s), s.face_sigma_rad * s.seen.norm());
  return out;
}

}  // namespace roverd::robot
