#include "app/options.hpp"

#include <charconv>
#include <cstdlib>
#include <iostream>
#include <utility>

#include <CLI/CLI.hpp>

#include "app/version.hpp"
#include "base/angle.hpp"

namespace roverd {

namespace {

constexpr int kArgumentsWrong = 2;

/// Not a number lies in no range, and CLI's own check lets it pass.
CLI::Validator number_in(double least, double most) {
  return {
      [=](std::string& text) -> std::string {
        double value = 0.0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
        if (good) return {};
        return "\"" + text + "\" is not a number in " + std::to_string(static_cast<long>(least)) +
               " .. " + std::to_string(static_cast<long>(most));
      },
      ""};
}

std::string check_run(const std::string& text) {
  std::int64_t id = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (ec == std::errc{} && end == text.data() + text.size() && id >= 1) return {};
  return "\"" + text + "\" is no run's number";
}

void add_station(CLI::App& app, Options& o) {
  app.set_version_flag("--version", std::string("roverd ") + kVersion);
  app.add_option("--config", o.config, "config file; vehicle profiles lie beside it in vehicles/")
      ->capture_default_str();
  app.add_option("--data", o.data, "folder for missions, events, logs and recordings")
      ->capture_default_str();
  app.add_option("--vehicle", o.vehicle, "vehicle profile, instead of the config's");
  app.add_option("--port", o.port, "TCP port, instead of the config's; 0 chooses a free one")
      ->check(CLI::Range(0, 65535));
  app.add_flag("--tls", o.tls, "https instead of http, with a certificate of its own");
  app.add_flag(
      "--lan", o.lan,
      "for phones and others in the network: on all addresses of this computer, with TLS and "
      "log-in");
  app.add_option("--set", o.overrides,
                 "one setting: key=value, e.g. nav.track.lookahead_min_m=0.8");
  app.add_option("--replay", o.replays,
                 "play this recording (receiver bytes or candump log) instead of opening drivers; "
                 "twice, for the bus and the receiver of one run: in step")
      ->allow_extra_args(false);
  app.add_option("--replay-speed", o.replay_speed, "times real time; 0 is as fast as possible")
      ->check(number_in(0.0, 1000.0))
      ->capture_default_str();
  app.add_flag("--record", o.record, "record every input byte under the data folder");
}

/// A command, with what it says when what it needs is not there.
struct Told {
  CLI::App* app;
  std::string wants;
};

Told add_decode(CLI::App& app, DecodeCommand& c) {
  CLI::App* d = app.add_subcommand("decode", "a recording as JSON lines");
  d->footer(
      "One JSON object a line for each frame or sentence of a recording; - reads standard input.\n"
      "What is not understood carries its reason under \"refused\".\n"
      "KIND:\n"
      "  bunker   CAN frames of a Bunker: the text of candump or candump -L\n"
      "  nmea     bytes of a GNSS receiver\n"
      "  ubx      the same, with the frames of u-blox receivers read\n"
      "  mti      bytes of an Xsens MTi\n"
      "  sick     bytes of a SICK scanner, or a session of one as text\n"
      "  vlp16    datagrams of a Velodyne VLP-16: a capture (pcap), or one after another\n"
      "  cloud    frames of a camera's program (docs/cloud-format.md)\n"
      "  ranges   lines of ultrasonic and infrared rangers\n"
      "  vision   datagrams of a vision program: a capture (pcap), or one a line");
  d->add_option("KIND", c.kind, "bunker, nmea, ubx, mti, sick, vlp16, cloud, ranges or vision")
      ->required();
  d->add_option("FILE", c.file, "the recording; - is standard input")->required();
  return {d, "decode wants KIND and FILE"};
}

Told add_replay(CLI::App& app, ReplayCommand& c) {
  CLI::App* r = app.add_subcommand("replay", "the track of a recorded run");
  r->footer(
      "Plays recordings of one run (CAN bus, receiver, inertial unit) through the drivers and the\n"
      "estimator, as fast as the machine can, and prints the track. The same files and settings\n"
      "give the same output. X.log goes on in X.002.log, X.003.log ... where they are.");
  r->add_option("FILE", c.plan.files, "the recordings")->required();
  r->add_flag("--report", c.report, "also what the estimator made of its inputs");
  r->add_option_function<std::string>(
       "--format", [&c](const std::string& word) { c.geojson = word == "geojson"; },
       "csv: the track as a table, the report as # lines after it; geojson: a FeatureCollection, "
       "the report as its member")
      ->check([](const std::string& word) -> std::string {
        return word == "csv" || word == "geojson" ? "" : "must be csv or geojson";
      })
      ->default_str("csv");
  r->add_option("--every", c.plan.every_s, "seconds between two poses; 0: all, 50 a second")
      ->check(number_in(0.0, 3600.0))
      ->capture_default_str();
  r->add_option("--config", c.source.config, "config file")->capture_default_str();
  r->add_option("--vehicle", c.source.vehicle, "vehicle profile, instead of the config's");
  r->add_option("--set", c.source.overrides, "one setting: key=value")->allow_extra_args(false);
  return {r, "replay: wants a FILE"};
}

Told add_report(CLI::App& app, ReportCommand& c) {
  CLI::App* r = app.add_subcommand("report", "how well runs were driven, side by side");
  r->footer("GET /runs lists the runs.");
  r->add_option("--data", c.data, "folder of the database")->capture_default_str();
  r->add_option("RUN", c.runs, "numbers of runs")->required()->check(check_run);
  return {r, "report: which runs?"};
}

Told add_ntrip(CLI::App& app, TableCommand& c) {
  CLI::App* n = app.add_subcommand("ntrip", "what casters of corrections offer");
  CLI::App* t = n->add_subcommand("table", "lists the streams of casters");
  n->require_subcommand(1);
  t->add_option("CASTER", c.casters, "HOST[:PORT] or ntrip[s]://[USER:PASSWORD@]HOST[:PORT]")
      ->required();
  t->add_flag("--json", c.json, "as a JSON array");
  return {n, "usage: roverd ntrip table CASTER [CASTER...] [--json]"};
}

Told add_backup(CLI::App& app, BackupCommand& c) {
  CLI::App* b = app.add_subcommand("backup", "a copy of the database, also while roverd runs");
  b->footer(
      "Prints the name of the copy. The newest backup that is whole takes the place of a\n"
      "database that is found damaged when roverd starts.");
  b->add_option("--data", c.data, "folder of the database")->capture_default_str();
  b->add_option("--keep", c.keep, "the newest so many are kept, the oldest go")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  b->add_option("--ends-with", c.ends_with)->group("");  // roverd's own, not shown
  return {b, "usage: roverd backup [--data DIR] [--keep N]"};
}

Told add_failsafes(CLI::App& app, FailsafesCommand& c) {
  CLI::App* f = app.add_subcommand("failsafes", "what the robot watches, and what follows from it");
  f->add_option("--into", c.into, "writes the table into this page, between its marks");
  return {f, "usage: roverd failsafes [--into FILE]"};
}

Told add_align(CLI::App& app, AlignCommand& c) {
  CLI::App* a = app.add_subcommand("align", "how one cloud lies in another");
  a->footer(
      "Reads two PCD files and prints, as JSON, where the source lies in the target, how sure "
      "that\n"
      "is, and whether to believe it: exit code 0 only where the verdict is good.");
  a->add_option("SOURCE", c.source, "the cloud that is moved")->required();
  a->add_option("TARGET", c.target, "the cloud or map of cells that stays")->required();
  a->add_option("--cell", c.cell_m, "edge of a cell, metres")
      ->check(number_in(0.01, 10.0))
      ->capture_default_str();
  a->add_option("--x", c.start_x_m, "where it seems to lie, metres")->capture_default_str();
  a->add_option("--y", c.start_y_m)->capture_default_str();
  a->add_option("--z", c.start_z_m)->capture_default_str();
  a->add_option("--yaw", c.start_yaw_deg, "degrees, left positive")->capture_default_str();
  a->add_option("--search", c.search_m, "metres by which that may be wrong")
      ->check(number_in(0.0, 20.0))
      ->capture_default_str();
  return {a, "align wants SOURCE and TARGET"};
}

Told add_map(CLI::App& app, MapCommand& c) {
  CLI::App* m = app.add_subcommand("map", "a map of a recorded drive");
  m->footer("Reads a log of CARMEN, plain or packed by gzip; writes NAME.pgm and NAME.yaml.");
  m->add_option("LOG", c.log, "the recording")->required();
  m->add_option("--into", c.into, "NAME of the map's two files")->required();
  m->add_option("--resolution", c.resolution_m, "edge of a cell, metres")
      ->check(number_in(0.01, 1.0))
      ->capture_default_str();
  return {m, "map wants LOG and --into NAME"};
}

Told add_locate(CLI::App& app, LocateCommand& c) {
  CLI::App* l = app.add_subcommand("locate", "a recorded drive placed in a map, and how well");
  l->footer(
      "LOG is the text of CARMEN (FLASER and ODOM lines), plain or gzip; its poses are taken for\n"
      "the truth, or as good as --truth-m and --truth-deg say. The map is that of ROS's map "
      "server.");
  l->add_option("--map", c.map, "the map's yaml; its image lies beside it")->required();
  l->add_option("LOG", c.log, "the recorded drive")->required();
  l->add_flag(
      "--no-start", [&c](std::int64_t) { c.options.with_start = false; },
      "the log's first pose is not told: the place is looked for in the whole map");
  l->add_option(
       "--starts", c.starts,
       "in place of the whole drive: so many starts without a pose, from places of it that "
       "are drawn by chance")
      ->check(number_in(1, 10'000));
  const auto which = [](WhichScans& into) {
    return [&into](const std::string& word) {
      into = word == "all" ? WhichScans::All : word == "odd" ? WhichScans::Odd : WhichScans::Even;
    };
  };
  const CLI::IsMember words({"all", "odd", "even"});
  l->add_option_function<std::string>("--scans", which(c.options.use),
                                      "which are given, counted from 0: all, odd or even")
      ->check(words)
      ->default_str("all");
  l->add_option_function<std::string>("--score", which(c.options.score),
                                      "which of them are compared: all, odd or even")
      ->check(words)
      ->default_str("all");
  l->add_option(
       "--truth-m", c.options.truth_m,
       "how sure the log's poses are along x and along y, 1 sigma: counts in the certainty")
      ->check(number_in(0.0, 10.0))
      ->capture_default_str();
  l->add_option_function<double>(
       "--truth-deg", [&c](const double& deg) { c.options.truth_rad = base::rad_from_deg(deg); },
       "the same of their heading")
      ->check(number_in(0.0, 180.0))
      ->default_str("0");
  return {l, "locate wants --map MAP.yaml and LOG"};
}

/// Why the arguments of a command are wrong.
std::string cause_of(const CLI::ParseError& error, const CLI::App& app, const Told& command) {
  const std::string name = command.app->get_name();
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) return command.wants;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const auto rest = app.remaining(true);
    const bool option = !rest.empty() && rest.front().starts_with("-");
    return option ? name + ": " + rest.front() + " is not known" : command.wants;
  }
  return name + ": " + error.what();
}

[[noreturn]] void complain(const std::string& cause, const std::string& help) {
  std::cerr << "roverd: " << cause << " (" << help << ")\n";
  std::exit(kArgumentsWrong);
}

}  // namespace

Command read_command(int argc, char** argv) {
  Options options;
  DecodeCommand decode;
  ReplayCommand replay;
  ReportCommand report;
  TableCommand table;
  BackupCommand backup;
  FailsafesCommand failsafes;
  AlignCommand align;
  MapCommand map;
  LocateCommand place;
  CLI::App app("roverd: the ground station that lives on the robot", "roverd");
  app.footer("roverd study: courses in simulated time, measured (roverd study --help)");
  add_station(app, options);
  const Told commands[] = {
      add_decode(app, decode), add_replay(app, replay), add_report(app, report),
      add_ntrip(app, table),   add_backup(app, backup), add_failsafes(app, failsafes),
      add_align(app, align),   add_map(app, map),       add_locate(app, place)};
  const auto chosen = [&commands]() -> const Told* {
    for (const Told& one : commands) {
      if (one.app->parsed()) return &one;
    }
    return nullptr;
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    std::exit(0);
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << "\n";
    std::exit(0);
  } catch (const CLI::ParseError& error) {
    const Told* command = chosen();
    if (command == nullptr) complain(error.what(), "roverd --help lists the options");
    complain(cause_of(error, app, *command), "roverd " + command->app->get_name() + " --help");
  }
  const Told* command = chosen();
  if (command == nullptr) return options;
  if (command->app == commands[0].app) return decode;
  if (command->app == commands[1].app) return replay;
  if (command->app == commands[2].app) return report;
  if (command->app == commands[3].app) return table;
  if (command->app == commands[4].app) return backup;
  if (command->app == commands[5].app) return failsafes;
  if (command->app == commands[6].app) return align;
  if (command->app == commands[7].app) return map;
  return place;
}

}  // namespace roverd
