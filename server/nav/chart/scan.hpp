#pragma once
// What was seen around the robot at one moment, in the plane: the form in which scans are matched
// against maps and drawn into them.
//
// B: the body, FLU, at the scan's stamp; metres. X_OB: of the odometry.

#include <optional>
#include <vector>

#include "base/sight.hpp"
#include "base/time.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::chart {

/// One direction: from the scan's eye to (x_m, y_m) nothing stands.
struct Beam {
  float x_m = 0.0F;  ///< in B
  float y_m = 0.0F;
  bool hit = false;  ///< something stands at the point; else it is clear at least as far
};

struct Scan {
  base::Time stamp;
  float eye_x_m = 0.0F;  ///< where the scanner stood, in B
  float eye_y_m = 0.0F;
  std::vector<Beam> beams;  ///< in the order in which they were measured; every number finite
};

struct ScanParams {
  double nearest_m = 0.10;   ///< from the eye; what is nearer is the robot or dirt
  double farthest_m = 40.0;  ///< hits further away are clear that far
  double lowest_m = 0.05;    ///< height of the points over the ground that are taken
  double highest_m = 2.0;
  std::size_t most = 2000;  ///< beams; of more, every n-th is taken
};

/// A sensor's piece as a scan of the moment when its last direction was measured: each point is
/// carried there along the odometry, so a turning robot bends no wall. Unknown directions, points
/// outside of the height band and numbers that are not finite are left out.
/// @param odometry with the time of the sight. @return empty: the odometry does not reach it, the
/// device says that its data are not good, or no beam is left. Pure.
std::optional<Scan> scan_of(const base::Sight& sight, const base::Mount& mount,
                            const sense::PoseHistory& odometry, const ScanParams& p = {});

}  // namespace roverd::nav::chart
