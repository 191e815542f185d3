// One run, and all of them on several threads.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numbers>
#include <span>
#include <thread>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"
#include "robot/compile.hpp"
#include "sim/config.hpp"
#include "sim/noise.hpp"
#include "study/plant_program.hpp"
#include "study/stage.hpp"
#include "study/study.hpp"
#include "study/tool_track.hpp"

namespace roverd::study {
namespace {

using base::Result;

constexpr base::LatLon kPlace{58.378020, 26.728900};
constexpr double kReady_s = 40.0;
constexpr double kEllipse95 = 5.991;  // chi-square with two degrees of freedom
// So near, and pointing so, as far as it knows, it has joined its way: not where it crosses it.
constexpr double kOnWay_m = 0.3;
const double kAlongWay_rad = base::rad_from_deg(30.0);
constexpr auto kStartStream = static_cast<sim::Stream>(9001);  // the study's own
constexpr std::size_t kThin = 5;  // kept for plots: every so many ticks
const base::WallTime kWall{std::chrono::seconds(1'780'000'000)};

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

/// Where the robot begins: at the course's first point, unless the disturbance says otherwise.
sim::Start start_of(const Disturbance& d, base::LatLon first, double heading_deg) {
  const base::LocalFrame frame(1, first);
  const double yaw_rad = base::yaw_from_heading(heading_deg);
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  const base::LatLon at = frame.to_global(
      {c * d.start_forward_m - s * d.start_left_m, s * d.start_forward_m + c * d.start_left_m});
  const bool there = d.start_forward_m == 0.0 && d.start_left_m == 0.0;
  const double turned_deg = heading_deg + d.start_heading_off_deg;
  return {there ? first : at, d.start_heading_off_deg == 0.0 ? heading_deg : turned_deg, {}, kWall};
}

struct Prepared {
  Settings settings;
  sim::Params plant;
  sim::Start start;
  mission::Plan plan;
  base::LatLon datum = kPlace;  ///< of the course's metres
};

/// Where the robot is put down beside the beginning; equal seeds, equal places.
void put_aside(sim::Start& start, const Task& task) {
  const Disturbance& d = *task.disturbance;
  if (d.start_off_m <= 0.0 && d.start_turn_deg <= 0.0) return;
  sim::Noise part(task.seed, kStartStream);
  const double off_m = d.start_off_m * std::sqrt(part.uniform());  // even over the circle
  const double way_rad = 2.0 * std::numbers::pi * part.uniform();
  const base::LocalFrame frame(1, start.at);
  start.at = frame.to_global({off_m * std::cos(way_rad), off_m * std::sin(way_rad)});
  const double turn_deg = d.start_turn_deg * (2.0 * part.uniform() - 1.0);
  start.heading_deg = std::fmod(start.heading_deg + turn_deg + 720.0, 360.0);
}

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
  p.plan = plan_of(*task.course, base::LocalFrame(1, kPlace), task.seed);
  const auto [first, second] = beginning(p.plan);
  const double along = base::distance_bearing(first, second).bearing_deg;
  // Noise turns the first leg of dense points anywhere: there the way itself tells.
  const auto& way = task.course->points;
  const bool noisy = task.course->every_m > 0.0 && way.size() > 1;
  const double first_deg =
      noisy ? base::heading_from_yaw(nav::direction_rad(way[0], way[1])) : along;
  p.start = start_of(*task.disturbance, first, task.course->start_heading_deg.value_or(first_deg));
  put_aside(p.start, task);
  if (task.course->plan) p.datum = first;
  return p;
}

/// Empty: the plant is ours.
Result<std::unique_ptr<PlantProgram>> plant_of(const Setup& setup, const Task& task,
                                               const Prepared& p) {
  if (setup.plant.empty()) return std::unique_ptr<PlantProgram>();
  PlantHello hello;
  hello.vehicle = p.settings.vehicle.name;
  hello.seed = task.seed;
  hello.steered = p.plant.device.wire == "ackermann";
  hello.track_width_m = p.plant.drive.track_width_m;
  hello.wheelbase_m = p.plant.car.wheelbase_m;
  hello.heading_deg = p.start.heading_deg;
  return PlantProgram::start(setup.plant, hello);
}

/// Arms, loads and starts. @return what went wrong.
Result<std::shared_ptr<const robot::CompiledMission>> set_off(Stage& stage, const Task& task,
                                                              const mission::Plan& plan,
                                                              const PlantProgram* foreign) {
  const auto ready = [&] {
    const auto s = stage.robot().snapshot();
    return s && s->ready_to_arm;
  };
  const auto fails = [&] { return foreign != nullptr && !foreign->problem().empty(); };
  while (!ready() && !fails() && stage.now_s() < kReady_s) stage.tick();
  if (fails()) return base::fail(base::Code::Unavailable, foreign->problem());
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
  explicit Recorder(const robot::CompiledMission& mission)
      : frame_(mission.frame), way_(mission.route.forth.path) {}

  void note(Stage& stage) {
    const sim::Truth t = stage.plant().truth();
    const base::EnuPoint at = frame_.to_local(t.at);
    truth.push_back({stage.now_s(), at, t.yaw_rad, t.twist.linear_mps, t.twist.angular_radps});
    ticks_us.push_back(stage.tick_us());
    const auto now = stage.robot().snapshot();
    const auto& pose = now->pose;
    const auto& place = now->mission.place;
    if (pose && !joined && place && place->s_m >= 0.0) {
      if (on_way(*pose, place->s_m)) {
        joined = Joined{truth.size() - 1, believed.size(), place->s_m};
      }
    }
    if (!pose) return;
    judge_claims(*pose, at, t.yaw_rad);
    if (!resets_before_) resets_before_ = now->estimator.resets;
    resets_ = now->estimator.resets;
    believed.push_back({stage.now_s(), pose->at, pose->yaw_rad, pose->speed_mps.value_or(0.0),
                        pose->yaw_rate_radps.value_or(0.0)});
  }

  Honesty honesty() const {
    Honesty h;
    const auto n = static_cast<double>(std::max<std::size_t>(1, believed.size()));
    h.inside_pct = 100.0 * static_cast<double>(inside_) / n;
    h.position_rms_m = std::sqrt(off_m2_ / n);
    h.heading_rms_rad = std::sqrt(yaw_off_rad2_ / n);
    h.heading_sigmas = std::sqrt(yaw_off_sigmas2_ / n);
    h.resets = resets_ - resets_before_.value_or(0);
    return h;
  }

  std::vector<nav::DrivenPoint> truth;
  std::vector<nav::DrivenPoint> believed;
  std::vector<double> ticks_us;

  /// When it first drove on its way: what it drove to get there is none of it.
  struct Joined {
    std::size_t truth = 0;
    std::size_t believed = 0;
    double s_m = 0.0;
  };
  std::optional<Joined> joined;

 private:
  bool on_way(const base::Pose& pose, double s_m) const {
    const nav::Leg& leg = way_.legs[std::min(way_.leg_from(s_m), way_.legs.size() - 1)];
    const double way_rad = way_.yaw_rad(leg, s_m, leg.first) + (leg.reverse ? base::kPi : 0.0);
    return base::distance_m(pose.at, way_.at(s_m)) < kOnWay_m &&
           std::abs(base::angle_diff_rad(way_rad, pose.yaw_rad)) < kAlongWay_rad;
  }
  void judge_claims(const base::Pose& pose, base::EnuPoint at, double yaw_rad) {
    const base::EnuPoint off = pose.at - at;
    const double c = std::cos(pose.ellipse.major_yaw_rad);
    const double s = std::sin(pose.ellipse.major_yaw_rad);
    const double major = (c * off.east_m + s * off.north_m) / pose.ellipse.major_m;
    const double minor = (c * off.north_m - s * off.east_m) / pose.ellipse.minor_m;
    if (major * major + minor * minor <= kEllipse95) ++inside_;
    off_m2_ += off.east_m * off.east_m + off.north_m * off.north_m;
    const double turned_rad = base::angle_diff_rad(yaw_rad, pose.yaw_rad);
    yaw_off_rad2_ += turned_rad * turned_rad;
    yaw_off_sigmas2_ += std::pow(turned_rad / pose.heading_sigma_rad, 2);
  }

  base::LocalFrame frame_;
  std::uint64_t inside_ = 0;
  double off_m2_ = 0.0;
  double yaw_off_rad2_ = 0.0;
  double yaw_off_sigmas2_ = 0.0;
  std::optional<std::uint64_t> resets_before_;
  std::uint64_t resets_ = 0;
  const nav::Path& way_;
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

/// What the mission's points were taken from, in the frame of the drive.
nav::Path way_itself(const Course& course, const base::LocalFrame& frame) {
  const base::LocalFrame place(1, kPlace);
  std::vector<nav::Vertex> vertices;
  for (const base::EnuPoint& p : course.points) {
    nav::Vertex v;
    v.at = frame.to_local(place.to_global(p));
    v.reverse = course.reverse;
    vertices.push_back(v);
  }
  return nav::build_path(vertices, {});
}

/// The missions' frame lies at the first fix, and so elsewhere with each seed.
void keep_ways(Run& run, const Recorder& seen, const nav::Path& way, const base::LocalFrame& frame,
               base::LatLon datum) {
  const base::LocalFrame course(1, datum);
  const auto moved = [&](base::EnuPoint p) { return course.to_local(frame.to_global(p)); };
  for (std::size_t i = 0; i < seen.truth.size(); i += kThin) {
    run.driven.push_back(seen.truth[i]);
    run.driven.back().at = moved(run.driven.back().at);
  }
  for (const nav::PathPoint& p : way.points) run.way.push_back(moved(p.at));
}

/// A tool's point in the place of the vehicle.
void follow_tool(Recorder& seen, const nav::ToolParams& tool) {
  if (!tool.fitted()) return;
  seen.truth = tool_track(seen.truth, tool);
  seen.believed = tool_track(seen.believed, tool);
  // The point's way and the vehicle's are not equally long.
  if (seen.joined) seen.joined->s_m = std::max(0.0, seen.joined->s_m - 2.0 * tool.reach_m());
}

void judge(Run& run, const Recorder& seen, const Task& task, const robot::CompiledMission& mission,
           base::LatLon datum, const nav::VehicleParams& vehicle) {
  const nav::Course& course = mission.route.forth;
  const bool led = !course.point_path.points.empty();
  std::vector<base::EnuPoint> vertices;
  for (std::size_t i = 0; i < course.nodes.size(); ++i) {
    vertices.push_back(led ? course.point_path.at(course.point_path.vertex_m[i])
                           : course.nodes[i].at);
  }
  const bool noisy = task.course->every_m > 0.0;
  const nav::Path& laid = led ? course.point_path : course.path;
  const nav::Path meant = noisy ? way_itself(*task.course, mission.frame) : laid;
  if (noisy) vertices.clear();
  const Recorder::Joined from = seen.joined.value_or(Recorder::Joined{});
  const double from_m = noisy ? 0.0 : from.s_m;
  const auto counts = seen.joined ? nav::Counts::All : nav::Counts::FromNear;
  const auto truth = std::span(seen.truth).subspan(from.truth);
  const auto believed = std::span(seen.believed).subspan(from.believed);
  run.truth = nav::measure_run(meant, vertices, truth, from_m, counts, believed);
  run.believed = nav::measure_run(meant, vertices, believed, from_m, counts);
  const auto matched = nav::match_run(meant, truth, from_m, counts, believed);
  run.honesty = seen.honesty();
  run.swept_half_width_m = swept_half_width_m(matched, vehicle);
  for (std::size_t i = 0; i < matched.size(); i += kThin) run.matched.push_back(matched[i]);
  keep_ways(run, seen, meant, mission.frame, datum);
  std::vector<double> us = seen.ticks_us;
  if (us.empty()) return;
  const auto k = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(us.size() - 1));
  std::nth_element(us.begin(), us.begin() + k, us.end());
  run.tick_p99_us = us[static_cast<std::size_t>(k)];
}

/// What the disturbance has in store for this moment.
class Fate {
 public:
  explicit Fate(const Disturbance& d) : later_(d.later) {
    std::ranges::stable_sort(later_, {}, &Later::after_s);
  }

  Result<void> strike(sim::Vehicle& plant, double driven_s) {
    for (; next_ < later_.size() && later_[next_].after_s <= driven_s; ++next_) {
      sim::Params params = plant.params();
      for (const auto& [key, value] : later_[next_].sim) {
        if (auto good = sim::set_param(params, key, value); !good) return good;
      }
      plant.set_params(params);
      sim::Faults faults = plant.faults();
      for (const auto& [key, value] : later_[next_].fault) {
        if (auto good = base::set_param(faults, key, value); !good) return good;
      }
      if (auto good = plant.set_faults(faults); !good) return good;
    }
    return {};
  }

 private:
  std::vector<Later> later_;
  std::size_t next_ = 0;
};

}  // namespace

Result<Run> run_one(const Setup& setup, const Task& task) {
  auto prepared = prepare(setup, task);
  if (!prepared) return tl::unexpected(prepared.error());
  Run run;
  run.course = task.course->name;
  run.disturbance = task.disturbance->name;
  run.seed = task.seed;
  const auto foreign = plant_of(setup, task, *prepared);
  if (!foreign) {
    run.problem = foreign.error().detail;
    return run;
  }
  const PlantProgram* const program = foreign->get();
  Stage stage(prepared->settings, prepared->plant, task.seed, prepared->start);
  if (program != nullptr) stage.plant().set_foreign(foreign->get());
  const auto compiled = set_off(stage, task, prepared->plan, program);
  if (!compiled) {
    run.problem = compiled.error().detail;
    return run;
  }
  Recorder seen(**compiled);
  const double began_s = stage.now_s();
  const double limit_s = time_limit_s((*compiled)->route.forth.path);
  auto state = base::ExecutionState::Running;
  Fate fate(*task.disturbance);
  const auto fails = [&] { return program != nullptr && !program->problem().empty(); };
  while (state == base::ExecutionState::Running && stage.now_s() - began_s < limit_s && !fails()) {
    if (auto struck = fate.strike(stage.plant(), stage.now_s() - began_s); !struck) {
      return tl::unexpected(struck.error());
    }
    stage.tick();
    seen.note(stage);
    state = stage.robot().snapshot()->mission.state;
  }
  if (fails()) {
    run.problem = program->problem();
  } else if (state != base::ExecutionState::Finished) {
    const std::string& reason = stage.robot().snapshot()->mission.reason;
    run.problem = state == base::ExecutionState::Running
                      ? "not there after " + std::to_string(std::lround(limit_s)) + " s"
                      : std::string(base::to_string(state)) + ": " + reason;
  }
  follow_tool(seen, prepared->settings.robot.tool);
  judge(run, seen, task, **compiled, prepared->datum, prepared->settings.robot.vehicle);
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
