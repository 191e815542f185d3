#pragma once
// What one image tells of a tag, on the ground plan of the body.

#include <string>
#include <vector>

#include "base/time.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::tags {

/// A tag on the ground plan: X_BT, its yaw the direction in which somebody looks who faces it. 1σ
/// along the line of sight and across it.
struct TagPlace {
  int id = 0;
  sense::Pose2 pose;
  double sigma_range_m = 0.0;
  double sigma_across_m = 0.0;
  double sigma_yaw_rad = 0.0;
  bool yaw_known = false;  ///< its doubt is small enough
};

/// All that one image showed. Immutable once told.
struct TagsSeen {
  std::string camera;
  base::Time stamp;            ///< when the image was taken
  std::vector<TagPlace> tags;  ///< none: the camera looked and saw none
};

}  // namespace roverd::nav::tags
