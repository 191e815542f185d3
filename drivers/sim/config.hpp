#pragma once
// The simulator's configuration file (TOML) and its --set overrides.
//
//   [start]            where the robot stands at first: lat, lon, heading_deg
//   [device] [drive] [car] [battery] [radio] [gnss] [compass] [imu] [ground] [trees] [body]
//                      sim/params.hpp
//   [world]            file: what stands around (docs/worlds.md): its path, or random:N
//   [[sensor]]         one for each, sim/world/sensor.hpp; what is left out is usual for its kind

#include <string>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "sim/vehicle.hpp"
#include "sim/world/sensor.hpp"

namespace roverd::sim {

struct Config {
  Params params;
  Start start;
  std::string world;  ///< file, or random:N; empty: level ground and nothing on it
  std::vector<world::SensorParams> sensors;  ///< checked; no two of one name
};

inline constexpr std::size_t kMaxSensors = 16;

/// Reads `text` into `config`. An unknown table or key, a wrong type, a value out of range: an
/// error naming file, line and key, and `config` is unchanged. @param file for messages.
base::Result<void> read_config(Config& config, std::string_view text, const std::string& file);
base::Result<void> read_config_file(Config& config, const std::string& file);

/// "drive.slip=0.3": a number or true/false where it reads as one, text otherwise. Of a sensor:
/// "sensor.NAME.rate_hz=10".
base::Result<void> apply_override(Config& config, const std::string& text);

/// "LAT,LON" or "LAT,LON,HEADING", degrees.
base::Result<void> read_start(Start& start, const std::string& text);

/// The world that `name` means: a file's, or random:N (sim/world/random.hpp).
base::Result<world::World> load_world(const std::string& name);

/// Every parameter with its value, range and meaning, one a line.
std::string parameter_list(const Config& config);

}  // namespace roverd::sim
