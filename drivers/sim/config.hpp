#pragma once
// The simulator's configuration file (TOML) and its --set overrides.
//
//   [start]            where the robot stands at first: lat, lon, heading_deg
//   [device] [drive] [car] [battery] [radio] [gnss] [compass] [imu]      sim/params.hpp

#include <string>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "sim/vehicle.hpp"

namespace roverd::sim {

struct Config {
  Params params;
  Start start;
};

/// Reads `text` into `config`. An unknown table or key, a wrong type, a value out of range: an
/// error naming file, line and key, and `config` is unchanged. @param file for messages.
base::Result<void> read_config(Config& config, std::string_view text, const std::string& file);
base::Result<void> read_config_file(Config& config, const std::string& file);

/// "drive.slip=0.3": a number or true/false where it reads as one, text otherwise.
base::Result<void> apply_override(Config& config, const std::string& text);

/// "LAT,LON" or "LAT,LON,HEADING", degrees.
base::Result<void> read_start(Start& start, const std::string& text);

/// Every parameter with its value, range and meaning, one a line.
std::string parameter_list(const Config& config);

}  // namespace roverd::sim
