#pragma once
// Whose bytes a recording holds, by what can be read in them: a file may be renamed.

#include <string>

#include "link/replay_options.hpp"

namespace roverd {

/// "gnss", "gpsd", "mti", "ntrip" (corrections), "ackermann", "ratio", "twist" or "bumper", or the
/// kind of a sensor, "sick", "velodyne", "vision", "cloud" or "ranges": the driver of whose
/// messages the first 64 kB hold most, or the first 4 MB where those hold none (an image is large).
/// What was sent counts where nothing may come back. Nothing readable: "gnss"; a recording without
/// any bytes: "".
std::string speaker_of(const std::string& path, const link::ReplayOptions& how);

}  // namespace roverd
