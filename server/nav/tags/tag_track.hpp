#pragma once
// One tag, kept over time in the odometry's frame O: what each image tells of it, weighted by its
// certainty; the odometry's own error lets it grow less certain with the way.
//
// State X_OT = [x, y, yaw], P 3×3 in that order. A measurement that does not fit (χ² of 3, 99.9 %)
// is left out; five in a row that fit each other begin anew: a single one of the other pose (a flat
// tag has two that look alike) never does. Not shared between threads.

#include <optional>
#include <utility>

#include <Eigen/Core>

#include "base/time.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/tags/tag_place.hpp"

namespace roverd::nav::tags {

class TagTrack {
 public:
  /// @param seen in B. @param pose X_OB when the image was taken. @param earlier X_OB were it taken
  /// as much earlier as its moment is uncertain: what moves meanwhile is known so much less.
  /// @return false: it was left out.
  bool take(const TagPlace& seen, const sense::Pose2& pose, base::Time stamp,
            const sense::Pose2& earlier);
  /// Of an image whose moment is known, or who stands.
  bool take(const TagPlace& seen, const sense::Pose2& pose, base::Time stamp) {
    return take(seen, pose, stamp, pose);
  }
  void forget() noexcept { known_ = false; }

  /// X_OT; empty: never seen. As long as no image told its direction it is taken to face whoever
  /// saw it first, and sigma_yaw_rad says how little that is worth.
  std::optional<sense::Pose2> pose() const noexcept;
  bool direction_known() const noexcept { return yaw_known_; }
  /// The last images fitted each other: it is not one of the other pose that it began with.
  bool steady() const noexcept { return fitted_ >= kSteady; }
  double sigma_m() const noexcept;
  double sigma_yaw_rad() const noexcept;
  /// How well it is known where it is to a vehicle that has driven on to @p pose since: its place
  /// (m) and its direction (rad), 1σ. No lens and no mount is known better than 2 mm and 0.17 deg.
  std::pair<double, double> sigma_from(const sense::Pose2& pose) const noexcept;
  /// How well it is known where in the tag's own frame @p pose stands (m, the worse direction) and
  /// points (rad), 1σ. The tag's direction is a part of both: 1 degree is 14 mm at 0.8 m.
  std::pair<double, double> sigma_before(const sense::Pose2& pose) const noexcept;
  base::Time seen_at() const noexcept { return seen_at_; }

 private:
  static constexpr int kSteady = 5;

  void drift(const sense::Pose2& pose) noexcept;
  bool five_agree(const Eigen::Vector3d& told, const Eigen::Matrix3d& r, bool yaw_known) noexcept;

  bool known_ = false;
  bool yaw_known_ = false;
  int fitted_ = 0;                                   ///< in a row
  int left_out_ = 0;                                 ///< in a row, that fit each other
  Eigen::Vector3d other_ = Eigen::Vector3d::Zero();  ///< the first of them
  Eigen::Matrix3d other_r_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d p_ = Eigen::Matrix3d::Zero();
  sense::Pose2 at_;  ///< X_OB of the last image
  base::Time seen_at_{};
};

}  // namespace roverd::nav::tags
