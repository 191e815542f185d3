#pragma once
// The command line of roverd, and of its commands.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "replay/run.hpp"
#include "tools/locate.hpp"
#include "tools/maps.hpp"

namespace roverd {

/// Without a command: the ground station.
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
  bool tls = false;  ///< as server.tls
  bool lan = false;  ///< as server.listen = "lan"
};

struct DecodeCommand {
  std::string kind;
  std::string file;
};
struct ReportCommand {
  std::string data = "data";
  std::vector<std::int64_t> runs;
};
struct TableCommand {
  std::vector<std::string> casters;
  bool json = false;
};
struct BackupCommand {
  std::string data = "data";
  int keep = 7;
  int ends_with = 0;  ///< the process that started it; 0: it goes on without
};
struct FailsafesCommand {
  std::string into;  ///< a page; empty: the table is printed
};
using Command =
    std::variant<Options, DecodeCommand, ReplayCommand, ReportCommand, TableCommand, BackupCommand,
                 FailsafesCommand, AlignCommand, MapCommand, LocateCommand>;

/// Prints help, version or a one-line error and ends the program where the arguments say so
/// (exit code 2 for wrong ones).
Command read_command(int argc, char** argv);

}  // namespace roverd
