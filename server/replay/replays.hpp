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

/// Looks into the files; recordings without any bytes are left out. Errors: a file that is missing
/// or no recording, two of a kind (two drive links, a receiver and a gpsd), recordings of different
/// runs, several without a pace, nothing but corrections.
base::Result<Replays> read_replays(const std::vector<std::string>& files, double speed);

/// What one file holds.
struct RecordingLook {
  std::string driver;                   ///< "bunker", or as speaker_of says
  std::optional<base::Duration> begin;  ///< of its first item, since 1970; empty: no dates
};
base::Result<RecordingLook> look_into(const std::string& path, const link::ReplayOptions& how);

}  // namespace roverd
