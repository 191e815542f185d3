// One run, and all of them on several threads.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "base/angle.hpp"
#include "robot/compile.hpp"
#include "sim/config.hpp"
#include "study/stage.hpp"
#include "study/study.hpp"

namespace roverd::study {
namespace {

using base::Result;

constexpr base::LatLon kPlace{58.378020, 26.728900};
constexpr double kReady_s = 40.0;
constexpr std::size_t kThin = 5;  // kept for plots: every so many ticks
const base::WallTime kWall{std::chrono::seconds(1'780'000'000)};

mission::Plan plan_of(const Course& course, const base::LocalFrame& frame) {
  mission::Plan plan;
  if (course.plan) {
    plan = *course.plan;
  } else {
    plan.name = course.name;
    for (const base::EnuPoint& p : course.points) {
      mission::Waypoint w;
      w.at = frame.to_global(p);
      w.turn = course.turn;
      w.reverse = course.reverse;
      plan.items.emplace_back(w);
    }
  }
  if (!plan.settings.speed_mps) plan.settings.speed_mps = course.speed_mps;
  return plan;
}

/// Where the first two different waypoints are.
std::pair<base::LatLon, base::LatLon> beginning(const mission::Plan& plan) {
  std::vector<base::LatLon> at;
  for (const auto& item : plan.items) {
    const auto* w = std::get_if<mission::Waypoint>(&item);
    if (w == nullptr) continue;
    if (at.empty() || base::distance_bearing(at[0], w->at).distance_m > 0.01) at.push_back(w->at);
    if (at.size() == 2) return {at[0], at[1]};
  }
  return {at.empty() ? kPlace : at[0], at.empty() ? kPlace : at[0]};
}

struct Prepared {
  Settings settings;
  sim::Params plant;
  sim::Start start;
  mission::Plan plan;
};

Result<Prepared> prepare(const Setup& setup, const Task& task) {
  Prepared p;
  std::vector<std::string> overrides = task.disturbance->robot;
  overrides.insert(overrides.end(), setup.overrides.begin(), setup.overrides.end());
  auto settings = load_settings({setup.config, setup.vehicle, overrides});
  if (!settings) return tl::unexpected(settings.error());
  p.settings = *settings;
  sim::Config plant;
  const auto file = setup.config.parent_path() / "sim" / (p.settings.vehicle.name + ".toml");
  if (auto good = sim::read_config_file(plant, file.string()); !good) {
    return tl::unexpected(good.error());
  }
  for (const auto& [key, value] : task.disturbance->sim) {
    if (auto good = sim::set_param(plant.params, key, value); !good) {
      return tl::unexpected(good.error());
    }
  }
  for (const auto& text : setup.sim_overrides) {
    if (auto good = sim::apply_override(plant, text); !good) return tl::unexpected(good.error());
  }
  p.plant = plant.params;
  p.plan = plan_of(*task.course, base::LocalFrame(1, kPlace));
  const auto [first, second] = beginning(p.plan);
  const double along = base::distance_bearing(first, second).bearing_deg;
  p.start = {first, task.course->start_heading_deg.value_or(along), {}, kWall};
  return p;
}

/// Arms, loads and starts. @return what went wrong.
Result<std::shared_ptr<const robot::CompiledMission>> set_off(Stage& stage, const Task& task,
                                                              const mission::Plan& plan) {
  const auto ready = [&] {
    const auto s = stage.robot().snapshot();
    return s && s->ready_to_arm;
  };
  while (!ready() && stage.now_s() < kReady_s) stage.tick();
  if (auto armed = stage.ask(robot::Arm{}); !armed) return tl::unexpected(armed.error());
  auto compiled = stage.robot().compile({task.course->name, 1, plan});
  if (!compiled) return compiled;
  if (auto loaded = stage.ask(robot::LoadMission{*compiled}); !loaded) {
    return tl::unexpected(loaded.error());
  }
  if (auto started = stage.ask(robot::StartMission{task.course->name, 1}); !started) {
    return tl::unexpected(started.error());
  }
  return compiled;
}

/// What was driven, in the frame of the compiled mission.
class Recorder {
 public:
  explicit Recorder(const base::LocalFrame& frame) : frame_(frame) {}

  void note(Stage& stage) {
    const sim::Truth t = stage.plant().truth();
    const base::EnuPoint at = frame_.to_local(t.at);
    truth.push_back({stage.now_s(), at, t.yaw_rad, t.twist.linear_mps, t.twist.angular_radps});
    ticks_us.push_back(stage.tick_us());
    const auto pose = stage.robot().snapshot()->pose;
    if (!pose) return;
    believed.push_back({stage.now_s(), pose->at, pose->yaw_rad, pose->speed_mps.value_or(0.0),
                        pose->yaw_rate_radps.value_or(0.0)});
  }

  std::vector<nav::DrivenPoint> truth;
  std::vector<nav::DrivenPoint> believed;
  std::vector<double> ticks_us;

 private:
  base::LocalFrame frame_;
};

double time_limit_s(const nav::Path& path) {
  return 60.0 + 4.0 * path.length_m() + 30.0 * static_cast<double>(path.legs.size());
}

/// Half of the ground's width that the footprint needs across the way.
double swept_half_width_m(const std::vector<nav::Matched>& all, const nav::VehicleParams& v) {
  double widest = 0.0;
  for (const nav::Matched& m : all) {
    widest = std::max(widest, std::abs(m.lateral_m) +
                                  0.5 * v.length_m * std::abs(std::sin(m.heading_rad)) +
                                  0.5 * v.width_m * std::abs(std::cos(m.heading_rad)));
  }
  return widest;
}

void judge(Run& run, const Recorder& seen, const robot::CompiledMission& mission,
           const nav::VehicleParams& vehicle) {
  const nav::Course& course = mission.route.forth;
  std::vector<base::EnuPoint> vertices;
  for (const nav::RouteNode& n : course.nodes) vertices.push_back(n.at);
  run.truth = nav::measure_run(course.path, vertices, seen.truth);
  run.believed = nav::measure_run(course.path, vertices, seen.believed);
  const auto matched = nav::match_run(course.path, seen.truth);
  run.swept_half_width_m = swept_half_width_m(matched, vehicle);
  for (std::size_t i = 0; i < matched.size(); i += kThin) run.matched.push_back(matched[i]);
  for (std::size_t i = 0; i < seen.truth.size(); i += kThin) run.driven.push_back(seen.truth[i].at);
  for (const nav::PathPoint& p : course.path.points) run.way.push_back(p.at);
  std::vector<double> us = seen.ticks_us;
  if (us.empty()) return;
  const auto k = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(us.size() - 1));
  std::nth_element(us.begin(), us.begin() + k, us.end());
  run.tick_p99_us = us[static_cast<std::size_t>(k)];
}

}  // namespace

Result<Run> run_one(const Setup& setup, const Task& task) {
  auto prepared = prepare(setup, task);
  if (!prepared) return tl::unexpected(prepared.error());
  Run run;
  run.course = task.course->name;
  run.disturbance = task.disturbance->name;
  run.seed = task.seed;
  Stage stage(prepared->settings, prepared->plant, task.seed, prepared->start);
  const auto compiled = set_off(stage, task, prepared->plan);
  if (!compiled) {
    run.problem = compiled.error().detail;
    return run;
  }
  Recorder seen((*compiled)->frame);
  const double began_s = stage.now_s();
  const double limit_s = time_limit_s((*compiled)->route.forth.path);
  auto state = base::ExecutionState::Running;
  while (state == base::ExecutionState::Running && stage.now_s() - began_s < limit_s) {
    stage.tick();
    seen.note(stage);
    state = stage.robot().snapshot()->mission.state;
  }
  if (state != base::ExecutionState::Finished) {
    const std::string& reason = stage.robot().snapshot()->mission.reason;
    run.problem = state == base::ExecutionState::Running
                      ? "not there after " + std::to_string(std::lround(limit_s)) + " s"
                      : std::string(base::to_string(state)) + ": " + reason;
  }
  judge(run, seen, **compiled, prepared->settings.robot.vehicle);
  return run;
}

Result<std::vector<Run>> run_all(const Setup& setup, const std::vector<Task>& tasks, int jobs,
                                 const std::function<void(std::size_t done)>& told) {
  std::vector<Run> runs(tasks.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::size_t done = 0;
  std::optional<base::Error> error;
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
      auto run = run_one(setup, tasks[i]);
      const std::lock_guard lock(mutex);
      if (!run) {
        if (!error) error = run.error();
        next = tasks.size();
        return;
      }
      runs[i] = std::move(*run);
      if (told) told(++done);
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t most = std::min<std::size_t>(static_cast<std::size_t>(jobs), tasks.size());
    for (std::size_t i = 0; i < most; ++i) threads.emplace_back(work);
  }
  if (error) return tl::unexpected(*error);
  return runs;
}

}  // namespace roverd::study
