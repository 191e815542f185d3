#pragma once
// The commands about places:
//
//   roverd align SOURCE TARGET     how one cloud (PCD) lies in another, and whether to believe it
//   roverd map LOG --into NAME     NAME.pgm and NAME.yaml of a recorded drive (CARMEN's log)

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "base/result.hpp"

namespace roverd {

struct AlignCommand {
  std::filesystem::path source;
  std::filesystem::path target;
  double cell_m = 0.2;     ///< a quarter of what both scans resolve at their middle distance
  double start_x_m = 0.0;  ///< where the source seems to lie in the target
  double start_y_m = 0.0;
  double start_z_m = 0.0;
  double start_yaw_deg = 0.0;
  double search_m = 1.0;  ///< how far that may be wrong
};

struct MapCommand {
  std::filesystem::path log;
  std::filesystem::path into;  ///< without its ending
  double resolution_m = 0.05;
};

/// verdict, matrix (rows of X_target_source), deviation_m and deviation_deg of the target's axes,
/// overlap, upright, fit_m, rival, cells of both.
/// @return the error of a file, its name in front
base::Result<nlohmann::ordered_json> aligned(const AlignCommand& c);

/// Writes both files. @return scans, nodes, loops, dropped, unfit, way_m, columns, rows
base::Result<nlohmann::ordered_json> mapped(const MapCommand& c);

/// Print one JSON object. @return exit code: 0; 1 aligned, but not to be believed, or the map could
/// not be written; 2 a file is not there or not what it should be
int align_clouds(const AlignCommand& c);
int make_map(const MapCommand& c);

}  // namespace roverd
