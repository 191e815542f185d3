#pragma once
// `roverd locate --map MAP.yaml LOG`: a recorded drive (CARMEN's text, plain or gzip) through a
// map, and how near the log's own poses its scans were placed.

#include <filesystem>

#include "tools/locate_run.hpp"

namespace roverd {

struct LocateCommand {
  std::filesystem::path map;  ///< the yaml; its image is looked for from the same folder
  std::filesystem::path log;
  LocateOptions options;
  std::size_t starts = 0;  ///< so many starts without a pose in place of the whole drive
};

/// Prints the figures. @return exit code: 0; 1 a file cannot be read, or is no map or no log.
int locate(const LocateCommand& command);

}  // namespace roverd
