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
constexpr double kMounted_m = 0.002;  ///< and many images of it do not make it better than this
constexpr double kMounted_rad = 0.003;
/// Images share errors of direction: of the light, of the bits' edges, and of the tag's other pose
/// where it lies too near to be left out.
constexpr double kShared = 1.3;

/// χ² of being apart; without a direction the place alone is judged.
double apart(const Eigen::Vector3d& off, const Eigen::Matrix3d& s, bool yaw_known) {
  if (yaw_known) return off.dot(s.ldlt().solve(off));
  const Eigen::Vector2d place = off.head<2>();
  return place.dot(Eigen::Matrix2d(s.topLeftCorner<2, 2>()).ldlt().solve(place));
}

Eigen::Vector3d from_to(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return {to[0] - from[0], to[1] - from[1], base::angle_diff_rad(from[2], to[2])};
}

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

bool TagTrack::five_agree(const Eigen::Vector3d& told, const Eigen::Matrix3d& r,
                          bool yaw_known) noexcept {
  const bool agrees =
      left_out_ > 0 && apart(from_to(other_, told), other_r_ + r, yaw_known) <= kGate;
  if (!agrees) {
    left_out_ = 1;
    other_ = told;
    other_r_ = r;
    return false;
  }
  return ++left_out_ >= kAnew;
}

bool TagTrack::take(const TagPlace& seen, const sense::Pose2& pose, base::Time stamp,
                    const sense::Pose2& earlier) {
  const sense::Pose2 told = pose * seen.pose;
  const double ray_rad = std::atan2(told.y_m - pose.y_m, told.x_m - pose.x_m);
  Eigen::Matrix2d turn;
  turn << std::cos(ray_rad), -std::sin(ray_rad), std::sin(ray_rad), std::cos(ray_rad);
  const double range_m = std::hypot(seen.sigma_range_m, kLeast_m);
  const double across_m = std::hypot(seen.sigma_across_m, kLeast_m);
  const double yaw_rad =
      seen.yaw_known ? kShared * std::hypot(seen.sigma_yaw_rad, kLeast_rad) : kUnknownYaw_rad;
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  r.topLeftCorner<2, 2>() = turn *
                            Eigen::Vector2d(range_m * range_m, across_m * across_m).asDiagonal() *
                            turn.transpose();
  r(2, 2) = yaw_rad * yaw_rad;
  const sense::Pose2 then = earlier * seen.pose;
  const Eigen::Vector3d moved{then.x_m - told.x_m, then.y_m - told.y_m,
                              base::angle_diff_rad(told.yaw_rad, then.yaw_rad)};
  const Eigen::Matrix3d late = moved * moved.transpose();
  r += late;
  if (!r.allFinite() || !std::isfinite(told.x_m + told.y_m + told.yaw_rad)) return false;
  if (known_) {
    drift(pose);
    const Eigen::Vector3d now{told.x_m, told.y_m, told.yaw_rad};
    const Eigen::Vector3d off = from_to(x_, now);
    const Eigen::Matrix3d s = p_ + r;
    if (apart(off, s, seen.yaw_known) > kGate) {
      fitted_ = 0;
      if (!five_agree(now, r, seen.yaw_known)) return false;
    } else {
      const Eigen::Matrix3d gain = s.ldlt().solve(p_).transpose();
      x_ += gain * (seen.yaw_known ? off : Eigen::Vector3d(off[0], off[1], 0.0));
      x_[2] = base::wrap_rad(x_[2]);
      const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - gain;
      p_ = rest * p_ * rest.transpose() + gain * r * gain.transpose();  // Joseph
      p_ = (0.5 * (p_ + p_.transpose())).eval();
      p_ += late;  // the next images are as late as this one: many of them do not make it less
      left_out_ = 0;
      fitted_ = std::min(fitted_ + 1, kSteady);
      yaw_known_ = yaw_known_ || seen.yaw_known;
      seen_at_ = stamp;
      return true;
    }
  }
  known_ = true;
  yaw_known_ = seen.yaw_known;
  left_out_ = 0;
  fitted_ = 1;
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

std::pair<double, double> TagTrack::sigma_from(const sense::Pose2& pose) const noexcept {
  TagTrack then = *this;
  then.drift(pose);
  return {std::hypot(then.sigma_m(), kMounted_m), std::hypot(then.sigma_yaw_rad(), kMounted_rad)};
}

/// p_TB = R(yaw)ᵀ (p_OB − p_OT): a tag that is turned by mistake moves who stands before it about
/// it.
std::pair<double, double> TagTrack::sigma_before(const sense::Pose2& pose) const noexcept {
  TagTrack then = *this;
  then.drift(pose);
  Eigen::Matrix<double, 2, 3> by_tag;
  by_tag << 1.0, 0.0, x_[1] - pose.y_m, 0.0, 1.0, pose.x_m - x_[0];
  const Eigen::Matrix2d c = by_tag * then.p_ * by_tag.transpose();
  const double middle = 0.5 * (c(0, 0) + c(1, 1));
  const double worse = middle + std::hypot(0.5 * (c(0, 0) - c(1, 1)), c(0, 1));
  return {std::hypot(std::sqrt(std::max(0.0, worse)), kMounted_m),
          std::hypot(then.sigma_yaw_rad(), kMounted_rad)};
}

double TagTrack::sigma_yaw_rad() const noexcept {
  return std::sqrt(std::max(0.0, p_(2, 2)));
}

}  // namespace roverd::nav::tags
