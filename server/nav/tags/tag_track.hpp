#pragma once
// One tag, kept over time in the odometry's frame O: what each image tells of it, weighted by its
// certainty; the odometry's own error lets it grow less certain with the way.
//
// State X_OT = [x, y, yaw], P 3×3 in that order. A measurement that does not fit (χ² of 3, 99.9 %)
// is left out; five in a row begin anew. Not shared between threads.

#include <optional>

#include <Eigen/Core>

#include "base/time.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/tags/finder.hpp"

namespace roverd::nav::tags {

class TagTrack {
 public:
  /// @param seen in B. @param pose X_OB when the image was taken.
  /// @return false: it was left out.
  bool take(const TagPlace& seen, const sense::Pose2& pose, base::Time stamp);
  void forget() noexcept { known_ = false; }

  /// X_OT; empty: never seen. As long as no image told its direction it is taken to face whoever
  /// saw it first, and sigma_yaw_rad says how little that is worth.
  std::optional<sense::Pose2> pose() const noexcept;
  bool direction_known() const noexcept { return yaw_known_; }
  double sigma_m() const noexcept;
  double sigma_yaw_rad() const noexcept;
  base::Time seen_at() const noexcept { return seen_at_; }

 private:
  void drift(const sense::Pose2& pose) noexcept;

  bool known_ = false;
  bool yaw_known_ = false;
  int left_out_ = 0;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d p_ = Eigen::Matrix3d::Zero();
  sense::Pose2 at_;  ///< X_OB of the last image
  base::Time seen_at_{};
};

}  // namespace roverd::nav::tags
