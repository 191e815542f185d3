#pragma once
// The command line of roverd.

#include <optional>
#include <string>
#include <vector>

namespace roverd {

struct Options {
  std::string config = "config/robot.toml";
  std::string data = "data";
  std::string vehicle;                 ///< empty: what the config says
  std::optional<int> port;             ///< instead of the config's
  std::vector<std::string> overrides;  ///< key=value
  /// Recordings of one run instead of the drivers: one of the CAN bus, one of the receiver.
  std::vector<std::string> replays;
  double replay_speed = 1.0;  ///< 0: as fast as possible
  bool record = false;
};

/// Prints help, version or a one-line error and ends the program where the arguments say so
/// (exit code 2 for wrong ones).
Options read_options(int argc, char** argv);

}  // namespace roverd
