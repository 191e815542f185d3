#pragma once
// The recordings of one run that are to be played: which is for which driver, and when the run
// began.

#include <map>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "link/replay_options.hpp"

namespace roverd {

struct Replays {
  std::map<std::string, std::string> file_of;  ///< by driver
  link::ReplayOptions how;
};

/// Looks into the files. A recording is either a bus (driver "bunker") or a receiver ("gnss").
/// Errors: a file that is missing or no recording, two of a kind, recordings of different runs,
/// several without a pace.
base::Result<Replays> read_replays(const std::vector<std::string>& files, double speed);

}  // namespace roverd
