#pragma once
// What one image tells of a tag, on the ground plan of the body. Where the body leans, a tag that
// hangs at the height h seems h · sin(lean) nearer or farther in that plan: level() takes it out.

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
  double up_m = 0.0;       ///< its middle over the origin, along the body's own upward axis
  double into_up = 0.0;    ///< upward part of the unit vector that its yaw is the direction of
};

/// On the level plan under the body that lies so: ahead is where the body points, seen from above.
TagPlace level(const TagPlace& seen, const sense::Lie3& lie) noexcept;

/// All that one image showed. Immutable once told.
struct TagsSeen {
  std::string camera;
  base::Time stamp;            ///< when the image was taken
  std::vector<TagPlace> tags;  ///< none: the camera looked and saw none
};

}  // namespace roverd::nav::tags
