#pragma once
// The command line of roverd-sim.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "sim/config.hpp"
#include "sim/port.hpp"

namespace roverd::sim {

struct Options {
  std::string can;  ///< SocketCAN interface; or
  std::string
      cansock;      ///< path of the local CAN socket: exactly one of them where device.wire is can
  PortSpec drive;   ///< elsewhere: where the device listens
  PortSpec bumper;  ///< the same of its bumper, where it has one
  std::optional<std::uint16_t> gnss_port = std::uint16_t{0};  ///< 0: choose
  std::string gnss_pty;                                       ///< set instead of gnss_port
  PortSpec imu{PortSpec::Kind::Tcp, 0, {}};                   ///< where there is one
  std::uint16_t control_port = 0;                             ///< 0: choose
  std::uint64_t seed = 1;
  std::optional<world::World> world;  ///< read already
  bool die_with_parent = false;
  Config config;
};

/// What to do instead of running, or the options.
struct Parsed {
  std::optional<Options> options;
  std::string text;   ///< to print when there are no options
  int exit_code = 0;  ///< 2: bad arguments, `text` is one line for stderr
};

Parsed parse_options(int argc, const char* const* argv);

}  // namespace roverd::sim
