#include "sim/options.hpp"

#include <algorithm>
#include <charconv>

#include <CLI/CLI.hpp>

namespace roverd::sim {
namespace {

constexpr int kBadArguments = 2;

struct Raw {
  std::string gnss = "tcp:0";
  std::string drive;
  std::string bumper = "pty";
  std::string imu = "tcp";
  std::string config_file;
  std::vector<std::string> overrides;
  std::string start;
  std::string world;
  bool list_parameters = false;
};

Parsed bad(std::string line) {
  std::ranges::replace(line, '\n', ' ');
  return {std::nullopt, "roverd-sim: " + line, kBadArguments};
}

base::Result<void> read_gnss(Options& options, const std::string& text) {
  if (text.starts_with("pty:") && text.size() > 4) {
    options.gnss_pty = text.substr(4);
    options.gnss_port.reset();
    return {};
  }
  if (text.starts_with("tcp:")) {
    const std::string digits = text.substr(4);
    std::uint16_t port = 0;
    const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (ec == std::errc{} && end == digits.data() + digits.size()) {
      options.gnss_port = port;
      return {};
    }
  }
  return base::fail(base::Code::Invalid, "--gnss " + text + ": must be tcp:PORT or pty:PATH");
}

base::Result<void> read_named_port(PortSpec& spec, const char* option, const std::string& text) {
  auto read = read_port(text);
  if (!read) {
    return base::fail(base::Code::Invalid,
                      std::string(option) + " " + text + ": " + read.error().detail);
  }
  spec = *read;
  return {};
}

/// The device's port, once its wire is known.
base::Result<void> read_device(Options& options, const Raw& raw) {
  const DeviceParams& device = options.config.params.device;
  const bool on_can = !options.can.empty() || !options.cansock.empty();
  if (device.wire == "can") {
    if (on_can && raw.drive.empty()) return {};
    return base::fail(base::Code::Invalid, on_can
                                               ? "--drive is of no use on CAN"
                                               : "one of --can IFACE and --cansock PATH is needed");
  }
  if (!options.can.empty()) {
    return base::fail(base::Code::Invalid, "--can is of no use with device.wire " + device.wire);
  }
  const std::string drive = raw.drive.empty() ? device.port : raw.drive;
  if (auto done = read_named_port(options.drive, "--drive", drive); !done) return done;
  if (device.wire == "ackermann" && options.drive.kind != PortSpec::Kind::Udp) {
    return base::fail(base::Code::Invalid, "device.wire ackermann needs udp, not " + drive);
  }
  return read_named_port(options.bumper, "--bumper", raw.bumper);
}

/// Later wins: the code's defaults, the file, --set, --start.
base::Result<void> read_values(Options& options, const Raw& raw) {
  if (auto done = read_gnss(options, raw.gnss); !done) return done;
  if (auto done = read_named_port(options.imu, "--imu", raw.imu); !done) return done;
  if (!raw.config_file.empty()) {
    if (auto done = read_config_file(options.config, raw.config_file); !done) return done;
  }
  for (const auto& text : raw.overrides) {
    if (auto done = apply_override(options.config, text); !done) return done;
  }
  if (!raw.world.empty()) options.config.world = raw.world;
  if (!options.config.world.empty()) {
    auto world = load_world(options.config.world);
    if (!world) return tl::unexpected(world.error());
    options.world = std::move(*world);
  }
  return raw.start.empty() ? base::Result<void>{} : read_start(options.config.start, raw.start);
}

}  // namespace

Parsed parse_options(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  CLI::App app{"Simulated robot: its drive link, GNSS sentences, and a true pose for tests.",
               "roverd-sim"};
  auto* can = app.add_option("--can", options.can, "SocketCAN interface, e.g. vcan0");
  app.add_option("--cansock", options.cansock,
                 "path of a local CAN socket to listen on, where the vehicle is on CAN")
      ->excludes(can);
  app.add_option("--drive", raw.drive,
                 "udp:PORT, tcp:PORT (0: choose) or pty:PATH: where vehicles without CAN listen");
  app.add_option("--bumper", raw.bumper, "the same of the bumper (default: a pseudo-terminal)");
  app.add_option("--gnss", raw.gnss, "tcp:PORT (0: choose) or pty:PATH of a symbolic link");
  app.add_option("--imu", raw.imu, "udp:PORT, tcp:PORT or pty:PATH of the inertial unit");
  app.add_option("--control", options.control_port, "port of the side channel (0: choose)");
  app.add_option("--seed", options.seed, "equal seeds repeat a run")
      ->check([](const std::string& text) {
        return text.starts_with('-') ? std::string("must not be negative") : std::string();
      });
  app.add_option("--config", raw.config_file, "TOML file");
  app.add_option("--set", raw.overrides, "section.key=value, may be repeated")
      ->allow_extra_args(false);
  app.add_option("--start", raw.start, "LAT,LON or LAT,LON,HEADING, degrees");
  app.add_option("--world", raw.world, "what stands around: a file of docs/worlds.md, or random:N");
  app.add_flag("--die-with-parent", options.die_with_parent, "end when the starting process ends");
  app.add_flag("--parameters", raw.list_parameters, "print every parameter and end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return {std::nullopt, app.help(), 0};
  } catch (const CLI::ParseError& error) {
    return bad(error.what());
  }
  if (auto done = read_values(options, raw); !done) return bad(done.error().detail);
  if (raw.list_parameters) return {std::nullopt, parameter_list(options.config), 0};
  if (auto done = read_device(options, raw); !done) return bad(done.error().detail);
  return {std::move(options), "", 0};
}

}  // namespace roverd::sim
