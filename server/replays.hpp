#pragma once
// The recordings of one run that are to be played: which is for which driver, and when the run
// began.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "link/replay_options.hpp"

namespace roverd {

struct Replays {
  std::map<std::string, std::string> file_of;  ///< by driver
  link::ReplayOptions how;
};

/// Looks into the files. A recording is a bus (driver "bunker"), a receiver ("gnss") or an inertial
/// unit ("mti"). Errors: a file that is missing or no recording, two of a kind, recordings of
/// different runs, several without a pace.
base::Result<Replays> read_replays(const std::vector<std::string>& files, double speed);

/// What one file holds.
struct RecordingLook {
  std::string driver;                   ///< "bunker", "gnss" or "mti"
  std::optional<base::Duration> begin;  ///< of its first item, since 1970; empty: no dates
};
base::Result<RecordingLook> look_into(const std::string& path, const link::ReplayOptions& how);

}  // namespace roverd
