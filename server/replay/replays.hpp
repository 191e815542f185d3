#pragma once
// The recordings of one run that are to be played: which is for which driver, and when the run
// began.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "config/sensors.hpp"
#include "link/replay_options.hpp"

namespace roverd {

/// What one recording holds.
struct Recording {
  std::string file;
  std::string driver;                   ///< "bunker", or as speaker_of says; of a run: who hears it
  std::optional<base::Duration> begin;  ///< of its first item, since 1970; empty: no dates
  /// No recorder stamped it: it is paced by the time that the device told in its messages.
  bool by_device = false;
};
base::Result<Recording> look_into(const std::string& path);

/// The recordings of one run.
struct RunFiles {
  std::map<std::string, Recording> of;  ///< by driver, or by the name of a sensor
  std::optional<base::Duration> begin;  ///< of the run; empty: no recording has dates
  std::vector<std::string> left_out;    ///< "FILE is of a …, and there is none", for people
};
/// Files without any bytes are left out, those that another one goes on in, and those of sensors
/// that there are none of. @param sensors those of the settings. Errors: a file that is missing or
/// no recording, two of a kind (two drive links, a receiver and a gpsd) or of one sensor, a
/// sensor's of which it is not clear which one it is, recordings of different runs.
base::Result<RunFiles> tell_apart(const std::vector<std::string>& files,
                                  const Sensors& sensors = {});

struct Replays {
  std::map<std::string, std::string> file_of;  ///< by driver
  link::ReplayOptions how;
  std::vector<std::string> remarks;  ///< for the log
};

/// For playing by the clock. Errors also: several without a pace, nothing but corrections.
base::Result<Replays> read_replays(const std::vector<std::string>& files, double speed,
                                   const Sensors& sensors = {});

/// Paces a plain file by what its first bytes turn out to be: a receiver's or an MTi's.
base::StreamClock device_clock();

}  // namespace roverd
