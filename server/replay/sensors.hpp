#pragma once
// Recordings of what looks around: which of the configured sensors each is of, and that sensor as
// it hears a recording.

#include <string>
#include <string_view>

#include "base/result.hpp"
#include "config/sensors.hpp"

namespace roverd {

/// "sick", "velodyne", "vision", "cloud" or "ranges": a kind of sensors, and no driver.
bool is_sensor_kind(std::string_view speaker) noexcept;

/// The name that recording_file() gave, as far as it is one of ours: "20260301T120000Z-front.pcap"
/// and "….002.pcap" are of "front". Empty: it was renamed.
std::string_view named_in(std::string_view path) noexcept;

/// The sensor of that kind which the file's name tells, or the only one of that kind. Empty: there
/// is none of that kind. Invalid: several, and the name tells none of them.
base::Result<std::string> sensor_of_recording(const std::string& path, std::string_view kind,
                                              const Sensors& sensors);

/// A recording does not answer, and a hole in it is no reason to open it again: it would begin
/// anew.
Sensor as_recorded(Sensor sensor);

}  // namespace roverd
