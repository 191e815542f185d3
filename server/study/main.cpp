// roverd-study: see study.hpp.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "study/drill.hpp"
#include "study/study.hpp"
#include "study/world/worlds.hpp"

namespace {

namespace base = roverd::base;
namespace study = roverd::study;
namespace fs = std::filesystem;

constexpr int kFailed = 1;  // a run did not arrive, or a file cannot be written
constexpr int kWrongInput = 2;
constexpr int kDrillNice = 10;  // as the large works of roverd itself

struct Options {
  study::Setup setup;
  std::string courses;
  std::string disturbances;
  std::string world;  ///< instead of disturbances
  int seeds = 5;
  int jobs = 0;
  std::string json;
  std::string svg;
};

int say(int code, const std::string& cause) {
  std::fprintf(stderr, "roverd study: %s\n", cause.c_str());
  return code;
}

base::Result<std::string> read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return base::fail(base::Code::NotFound, "cannot read " + path.string());
  return std::string(std::istreambuf_iterator<char>(in), {});
}

bool write_file(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  return !out.fail();
}

void define(CLI::App& app, Options& o) {
  app.add_option("--vehicle", o.setup.vehicle, "vehicle profile, instead of the config's");
  app.add_option("--config", o.setup.config, "config file; vehicles/ and sim/ lie beside it")
      ->capture_default_str();
  app.add_option("--courses", o.courses, "JSON file of courses")->capture_default_str();
  app.add_option("--disturbances", o.disturbances, "JSON file of disturbances")
      ->capture_default_str();
  app.add_option("--world", o.world,
                 "drive in a simulated world and count what is touched: a file, random:N[:SEED], "
                 "open:N[:SEED], crossing:N[:SEED], turning:N[:SEED] or around:N[:SEED]");
  app.add_option("--seeds", o.seeds, "runs of each course under each disturbance, seeds 1 to N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--jobs", o.jobs, "threads; 0: one for each core")->check(CLI::Range(0, 1024));
  app.add_option("--json", o.json, "write every measure of every run to this file");
  app.add_option("--svg", o.svg, "write a plot for each course and disturbance to this folder");
  app.add_option("--set", o.setup.overrides, "one setting of the robot: key=value");
  app.add_option("--plant", o.setup.plant,
                 "somebody else's plant: a command that speaks the lines of docs/studies.md");
  app.add_option("--sim", o.setup.sim_overrides, "one parameter of the simulator: key=value");
}

std::vector<study::Task> tasks_of(const std::vector<study::Course>& courses,
                                  const std::vector<study::Disturbance>& disturbances, int seeds) {
  std::vector<study::Task> tasks;
  for (const auto& d : disturbances) {
    for (const auto& c : courses) {
      for (int seed = 1; seed <= seeds; ++seed) {
        tasks.push_back({&c, &d, static_cast<std::uint64_t>(seed)});
      }
    }
  }
  return tasks;
}

std::string file_name(const study::Run& run) {
  std::string name = run.course + "-" + run.disturbance;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    if (!plain) c = '_';
  }
  return name + ".svg";
}

bool write_plots(const fs::path& folder, const std::vector<study::Run>& runs) {
  std::error_code ec;
  fs::create_directories(folder, ec);
  std::map<std::string, std::vector<const study::Run*>> plots;
  for (const auto& run : runs) {
    if (!run.way.empty()) plots[file_name(run)].push_back(&run);
  }
  return std::all_of(plots.begin(), plots.end(), [&](const auto& plot) {
    return write_file(folder / plot.first, study::to_svg(plot.second));
  });
}

int jobs_of(const Options& o) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return o.jobs > 0 ? o.jobs : cores;
}

int run(const Options& o) {
  (void)std::signal(SIGPIPE, SIG_IGN);  // a plant of somebody else may die
  const auto folder = fs::path(o.courses).parent_path();
  auto text = read_file(o.courses);
  if (!text) return say(kWrongInput, text.error().detail);
  const auto courses =
      study::read_courses(*text, [&](const std::string& name) { return read_file(folder / name); });
  if (!courses) return say(kWrongInput, o.courses + ": " + courses.error().detail);
  text = read_file(o.disturbances);
  if (!text) return say(kWrongInput, text.error().detail);
  const auto disturbances = study::read_disturbances(*text);
  if (!disturbances) return say(kWrongInput, o.disturbances + ": " + disturbances.error().detail);

  const auto tasks = tasks_of(*courses, *disturbances, o.seeds);
  const auto runs = study::run_all(o.setup, tasks, jobs_of(o), [&](std::size_t n) {
    std::fprintf(stderr, "\r%zu of %zu runs%s", n, tasks.size(), n == tasks.size() ? "\n" : "");
  });
  if (!runs) return say(kWrongInput, runs.error().detail);
  std::fputs(study::to_table(*runs).c_str(), stdout);
  if (!o.json.empty() && !write_file(o.json, study::to_json(*runs, o.setup))) {
    return say(kFailed, "cannot write " + o.json);
  }
  if (!o.svg.empty() && !write_plots(o.svg, *runs)) return say(kFailed, "cannot write to " + o.svg);
  const bool all = std::all_of(runs->begin(), runs->end(),
                               [](const study::Run& r) { return r.problem.empty(); });
  return all ? 0 : kFailed;
}

bool write_world_plots(const fs::path& folder, const std::vector<study::WorldRun>& runs) {
  constexpr std::size_t kAllOf = 50;  // of more than that only what is worth looking at
  std::error_code ec;
  fs::create_directories(folder, ec);
  return std::ranges::all_of(runs, [&](const study::WorldRun& run) {
    if (runs.size() > kAllOf && !study::remarkable(run)) return true;
    const auto name = run.scenario.kind + "-" + std::to_string(run.scenario.number) + ".svg";
    return write_file(folder / name, study::to_svg(run));
  });
}

/// @param given courses were named; otherwise the usual ones
int run_in_worlds(const Options& o, bool given) {
  const auto order = study::parse_worlds(o.world);
  if (!order) return say(kWrongInput, order.error().detail);
  std::vector<study::Course> courses;
  if (given) {
    const auto folder = fs::path(o.courses).parent_path();
    const auto text = read_file(o.courses);
    if (!text) return say(kWrongInput, text.error().detail);
    auto read = study::read_courses(
        *text, [&](const std::string& name) { return read_file(folder / name); });
    if (!read) return say(kWrongInput, o.courses + ": " + read.error().detail);
    courses = std::move(*read);
  }
  roverd::sim::world::World world;
  const bool file = order->kind == study::WorldOrder::Kind::File;
  if (file) {
    const auto text = read_file(order->file);
    if (!text) return say(kWrongInput, text.error().detail);
    auto read = roverd::sim::world::read_world(*text);
    if (!read) return say(kWrongInput, order->file.string() + ": " + read.error().detail);
    world = std::move(*read);
  }
  std::vector<study::Scenario> scenarios;
  for (int i = 0; i < (file ? o.seeds : order->count); ++i) {
    auto one =
        study::scenario_of(*order, order->seed + static_cast<std::uint64_t>(i), courses, world);
    if (!one) return say(kWrongInput, one.error().detail);
    scenarios.push_back(std::move(*one));
  }
  const auto runs = study::run_worlds(o.setup, scenarios, jobs_of(o), [&](std::size_t n) {
    std::fprintf(stderr, "\r%zu of %zu worlds%s", n, scenarios.size(),
                 n == scenarios.size() ? "\n" : "");
  });
  if (!runs) return say(kWrongInput, runs.error().detail);
  std::fputs(study::to_table(*runs).c_str(), stdout);
  if (!o.json.empty() && !write_file(o.json, study::to_json(*runs, o.setup))) {
    return say(kFailed, "cannot write " + o.json);
  }
  if (!o.svg.empty() && !write_world_plots(o.svg, *runs)) {
    return say(kFailed, "cannot write to " + o.svg);
  }
  const bool none = std::ranges::none_of(*runs, [](const study::WorldRun& run) {
    return !run.problem.empty() || std::ranges::any_of(run.touches, [](const auto& t) {
      return t.blame == study::Blame::Ours;
    });
  });
  return none ? 0 : kFailed;
}

/// Beside a robot that may drive: behind all that wants to run, and gone with who started it.
void step_back() {
  const sched_param none{};
  (void)sched_setscheduler(0, SCHED_BATCH, &none);
  (void)setpriority(PRIO_PROCESS, 0, kDrillNice);
  (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
  (void)write_file("/proc/self/oom_score_adj", "1000");  // the first to go where memory is short
}

int run_drill() {
  step_back();
  const std::string order(std::istreambuf_iterator<char>(std::cin), {});
  return study::drill(order, [](const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  });
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  o.setup.config = "config/robot.toml";
  o.courses = "config/courses/five.json";
  o.disturbances = "config/disturbances/bunker.json";
  CLI::App app("Drives courses in simulated time and measures how well.", "roverd study");
  define(app, o);
  CLI::App* played = app.add_subcommand(
      "drill", "where a robot would stand; roverd starts it: one JSON document in, JSON lines out");
  try {
    app.parse(argc, argv);
    if (played->parsed()) return run_drill();
    return o.world.empty() ? run(o) : run_in_worlds(o, app.count("--courses") > 0);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return 0;
  } catch (const CLI::ParseError& error) {
    return say(kWrongInput, std::string(error.what()) + " (roverd study --help lists the options)");
  } catch (const std::exception& error) {
    return say(kFailed, error.what());
  }
}
