#include "nav/tags/tag_track.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "base/angle.hpp"

namespace roverd::nav::tags {
namespace {

constexpr double kGate = 16.3;
constexpr int kAnew = 5;
constexpr double kUnknownYaw_rad = 1.0;
constexpr double kOdometry = 0.03;            ///< of the way, each way
constexpr double kOdometryTurn = 0.03;        ///< of the turning
constexpr double kOdometryTurn_radpm = 0.01;  ///< of the way
constexpr double kLeast_m = 0.001;            ///< a lens is not known better
constexpr double kLeast_rad = 0.002;

}  // namespace

/// The vehicle moved: where the tag is to it is known so much less. Kept in O as if the tag had
/// moved, turned about the vehicle.
void TagTrack::drift(const sense::Pose2& pose) noexcept {
  const double gone_m = std::hypot(pose.x_m - at_.x_m, pose.y_m - at_.y_m);
  const double turned_rad = std::abs(base::angle_diff_rad(at_.yaw_rad, pose.yaw_rad));
  const double yaw = kOdometryTurn * turned_rad + kOdometryTurn_radpm * gone_m;
  const double along = kOdometry * gone_m;
  const Eigen::Vector3d lever{-(x_[1] - pose.y_m), x_[0] - pose.x_m, 1.0};
  p_ += yaw * yaw * lever * lever.transpose();
  p_.topLeftCorner<2, 2>() += along * along * Eigen::Matrix2d::Identity();
  at_ = pose;
}

bool TagTrack::take(const TagPlace& seen, const sense::Pose2& pose, base::Time stamp) {
  const sense::Pose2 told = pose * seen.pose;
  const double ray_rad = std::atan2(told.y_m - pose.y_m, told.x_m - pose.x_m);
  Eigen::Matrix2d turn;
  turn << std::cos(ray_rad), -std::sin(ray_rad), std::sin(ray_rad), std::cos(ray_rad);
  const double range_m = std::hypot(seen.sigma_range_m, kLeast_m);
  const double across_m = std::hypot(seen.sigma_across_m, kLeast_m);
  const double yaw_rad =
      seen.yaw_known ? std::hypot(seen.sigma_yaw_rad, kLeast_rad) : kUnknownYaw_rad;
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  r.topLeftCorner<2, 2>() = turn *
                            Eigen::Vector2d(range_m * range_m, across_m * across_m).asDiagonal() *
                            turn.transpose();
  r(2, 2) = yaw_rad * yaw_rad;
  if (!r.allFinite() || !std::isfinite(told.x_m + told.y_m + told.yaw_rad)) return false;
  if (known_) {
    drift(pose);
    const Eigen::Vector3d off{told.x_m - x_[0], told.y_m - x_[1],
                              base::angle_diff_rad(x_[2], told.yaw_rad)};
    const Eigen::Matrix3d s = p_ + r;
    // Without a direction its place alone is judged.
    const double fits =
        seen.yaw_known ? off.dot(s.ldlt().solve(off))
                       : off.head<2>().dot(
                             Eigen::Matrix2d(s.topLeftCorner<2, 2>()).ldlt().solve(off.head<2>()));
    if (fits > kGate) {
      if (++left_out_ < kAnew) return false;
    } else {
      const Eigen::Matrix3d gain = s.ldlt().solve(p_).transpose();
      x_ += gain * (seen.yaw_known ? off : Eigen::Vector3d(off[0], off[1], 0.0));
      x_[2] = base::wrap_rad(x_[2]);
      const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - gain;
      p_ = rest * p_ * rest.transpose() + gain * r * gain.transpose();  // Joseph
      p_ = (0.5 * (p_ + p_.transpose())).eval();
      left_out_ = 0;
      yaw_known_ = yaw_known_ || seen.yaw_known;
      seen_at_ = stamp;
      return true;
    }
  }
  known_ = true;
  yaw_known_ = seen.yaw_known;
  left_out_ = 0;
  x_ = {told.x_m, told.y_m, seen.yaw_known ? told.yaw_rad : ray_rad};
  p_ = r;
  at_ = pose;
  seen_at_ = stamp;
  return true;
}

std::optional<sense::Pose2> TagTrack::pose() const noexcept {
  if (!known_) return std::nullopt;
  return sense::Pose2{x_[0], x_[1], x_[2]};
}

double TagTrack::sigma_m() const noexcept {
  return std::sqrt(std::max(0.0, 0.5 * (p_(0, 0) + p_(1, 1))));
}

double TagTrack::sigma_yaw_rad() const noexcept {
  return std::sqrt(std::max(0.0, p_(2, 2)));
}

}  // namespace roverd::nav::tags
