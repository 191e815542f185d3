#include "app/options.hpp"

#include <cstdlib>
#include <iostream>

#include <CLI/CLI.hpp>

#include "app/version.hpp"

namespace roverd {

namespace {

/// Not a number lies in no range, and CLI's own check lets it pass.
std::string check_speed(const std::string& text) {
  constexpr double kFastest = 1000.0;
  double speed = 0.0;
  if (CLI::detail::lexical_cast(text, speed) && speed >= 0.0 && speed <= kFastest) return {};
  return "\"" + text + "\" is not a number in 0 .. 1000";
}

}  // namespace

Options read_options(int argc, char** argv) {
  Options o;
  CLI::App app("roverd: the ground station that lives on the robot", "roverd");
  app.footer(
      "roverd decode KIND FILE|-   a recording as JSON lines (roverd decode --help)\n"
      "roverd replay FILE... --report  the track of a recorded run (roverd replay --help)\n"
      "roverd report RUN...        how well runs were driven, side by side\n"
      "roverd study                courses in simulated time, measured (roverd study --help)");
  app.set_version_flag("--version", kVersion);
  app.add_option("--config", o.config, "config file; vehicle profiles lie beside it in vehicles/")
      ->capture_default_str();
  app.add_option("--data", o.data, "folder for missions, events, logs and recordings")
      ->capture_default_str();
  app.add_option("--vehicle", o.vehicle, "vehicle profile, instead of the config's");
  app.add_option("--port", o.port, "TCP port, instead of the config's; 0 chooses a free one")
      ->check(CLI::Range(0, 65535));
  app.add_option("--set", o.overrides,
                 "one setting: key=value, e.g. nav.track.lookahead_min_m=0.8");
  app.add_option("--replay", o.replays,
                 "play this recording (receiver bytes or candump log) instead of opening drivers; "
                 "twice, for the bus and the receiver of one run: in step")
      ->allow_extra_args(false);
  app.add_option("--replay-speed", o.replay_speed, "times real time; 0 is as fast as possible")
      ->check(check_speed)
      ->capture_default_str();
  app.add_flag("--record", o.record, "record every input byte under the data folder");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    std::exit(0);
  } catch (const CLI::CallForVersion&) {
    std::cout << "roverd " << kVersion << "\n";
    std::exit(0);
  } catch (const CLI::ParseError& error) {
    std::cerr << "roverd: " << error.what() << " (roverd --help lists the options)\n";
    std::exit(2);
  }
  return o;
}

}  // namespace roverd
