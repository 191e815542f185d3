#pragma once
// One planar scan, undistorted: what lines and posts are looked for in.
//
// Frame B of the body at the scan's moment, metres. Order: as measured, so that neighbours in the
// list are neighbours in direction.

#include <cmath>
#include <vector>

#include "base/result.hpp"
#include "base/sight.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::marks {

using sense::Pose2;
using sense::Vec2;

struct Beam {
  Vec2 at;               ///< where it hit, or the direction's far end
  double range_m = 0.0;  ///< from the sensor
  bool hit = false;      ///< else nothing is known of it
  bool echo = false;     ///< something stands there, be it too far for a hit
};

struct PlanarScan {
  base::Time stamp;  ///< of its last point; B is the body's frame then
  Pose2 pose;        ///< X_OB then
  Vec2 eye;          ///< the sensor, in B
  std::vector<Beam> beams;
};

inline double length(Vec2 v) noexcept {
  return std::hypot(v.x, v.y);
}
/// A point in O of one in B.
Vec2 placed(const Pose2& ob, Vec2 p) noexcept;

/// @param history must reach from the sight's stamp to its last point: Unavailable otherwise.
/// @param out its buffer is used again. Hits farther than max_range_m are none. Where the sensor
/// looks in several planes, every hit within ±band_m of its own height counts.
/// The mount's roll and pitch turn points as they should; what lies outside of the band is left
/// out.
base::Result<void> planar_of(const base::Sight& sight, const base::Mount& mount,
                             const sense::PoseHistory& history, double max_range_m, double band_m,
                             PlanarScan& out);

}  // namespace roverd::nav::marks
