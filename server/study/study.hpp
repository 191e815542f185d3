#pragma once
// roverd study: courses × disturbances × seeds in simulated time, and what was measured.
//
//   courses.json ─┐                      ┌─ table
//   disturbances ─┼─▶ runs (all cores) ──┼─ JSON, every measure of every run
//   vehicle ──────┘                      └─ SVG, one plot per course and disturbance
//
// A program of its own (roverd-study, which `roverd study` becomes): it holds the simulated
// vehicle, which nothing that drives a real robot may know. Each run is the whole robot: plant,
// real codecs and drivers over memory links, Robot::tick every 20 ms (study_stage.hpp). Equal input
// gives equal output, whatever the number of threads.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"
#include "nav/measure/measure.hpp"

namespace roverd::study {

/// A way to drive. Begins at its first point.
struct Course {
  std::string name;
  std::vector<base::EnuPoint> points;  ///< metres east and north of the start, two at least
  std::optional<mission::Plan> plan;   ///< instead of points
  double speed_mps = 1.0;
  std::optional<double> start_heading_deg;  ///< empty: along the first leg
  mission::Turn turn = mission::Turn::Auto;
  bool reverse = false;
  /// Not 0: the mission's points lie so far apart on the way that `points` are, and beside it by
  /// noise of this deviation, another one for each seed. The drive is judged by the way itself.
  double every_m = 0.0;
  double noise_m = 0.0;
  bool taught = false;  ///< they are the samples of a teach-in, and the mission is made of those
};

using Changes = std::vector<std::pair<std::string, base::ParamValue>>;

/// What becomes of the plant on the way.
struct Later {
  double after_s = 0.0;  ///< since the mission's start
  Changes sim;           ///< parameters
  Changes fault;         ///< members of sim/radio.hpp's Faults
};

/// What makes it hard: keys of roverd-sim --parameters, and of the robot's configuration.
struct Disturbance {
  std::string name;
  Changes sim;
  std::vector<Later> later;
  double start_forward_m = 0.0;  ///< the robot begins so far beside the course's first point
  double start_left_m = 0.0;
  double start_heading_off_deg = 0.0;  ///< and turned to the right by this
  double start_off_m = 0.0;            ///< further by the seed, any way: at most so far
  double start_turn_deg = 0.0;         ///< and turned by so much, at most, either way
  std::vector<std::string> robot;      ///< "nav.track.delay_s=0.2"
};

/// {"courses": [{"name", "points": [[east_m, north_m], …] | "arcs": [[length_m, curvature_1pm], …]
/// | "mission": FILE, "speed_mps", "start_heading_deg", "closed", "turn", "reverse", "every_m",
/// "noise_m", "taught"}]}. Arcs follow each other, northwards first; left is positive. Malformed or
/// Invalid, naming the member.
/// @param read_file gives a mission's text by the name written there.
base::Result<std::vector<Course>> read_courses(
    std::string_view text,
    const std::function<base::Result<std::string>(const std::string&)>& read_file);

/// {"disturbances": [{"name", "sim": {"drive.slip": 0.08, …}, "robot": {…}, "later": [{"after_s",
/// "sim": {…}, "fault": {"gnss_jump_east_m": 3, …}}], "start_offset_m": [forward, left],
/// "start_heading_off_deg", "start_off_m", "start_turn_deg"}]}. A key of the simulator that does
/// not exist or a value out of range is Invalid.
base::Result<std::vector<Disturbance>> read_disturbances(std::string_view text);

/// The mission that a course is, in this frame.
mission::Plan plan_of(const Course& course, const base::LocalFrame& frame, std::uint64_t seed);

struct Task {
  const Course* course = nullptr;
  const Disturbance* disturbance = nullptr;
  std::uint64_t seed = 1;
};

/// Does the robot know how well it knows where it is?
struct Honesty {
  double inside_pct = 0.0;      ///< of the time the truth lies in the 95 % ellipse
  double position_rms_m = 0.0;  ///< of the believed position
  double heading_rms_rad = 0.0;
  double heading_sigmas = 0.0;  ///< rms of the heading's error over its sigma: 1 where it is right
  std::uint64_t resets = 0;     ///< of the estimate, while driving
};

struct Run {
  std::string course;
  std::string disturbance;
  std::uint64_t seed = 1;
  std::string problem;       ///< empty: it finished
  nav::RunMeasure truth;     ///< of the true pose
  nav::RunMeasure believed;  ///< of the pose the robot believed
  Honesty honesty;
  double swept_half_width_m = 0.0;  ///< of the footprint, across the way
  double tick_p99_us = 0.0;
  std::vector<base::EnuPoint> way;       ///< intended, in metres of the course
  std::vector<nav::DrivenPoint> driven;  ///< truth, likewise, ten a second
  std::vector<nav::Matched> matched;     ///< likewise
};

struct Setup {
  std::filesystem::path config;  ///< config/robot.toml; sim/ and vehicles/ lie beside it
  std::string vehicle;
  std::vector<std::string> overrides;      ///< of the robot's configuration
  std::vector<std::string> sim_overrides;  ///< "drive.slip=0.1"
  std::string plant;                       ///< somebody else's plant: a command; empty: ours
};

/// One run, on the caller's thread. What the setup or the disturbance says wrongly is an error; a
/// robot that does not arrive is not.
base::Result<Run> run_one(const Setup& setup, const Task& task);

/// All of them, in the order of `tasks`, on `jobs` threads. @param told after each run, from one
/// thread at a time. The first error ends it.
base::Result<std::vector<Run>> run_all(const Setup& setup, const std::vector<Task>& tasks, int jobs,
                                       const std::function<void(std::size_t done)>& told);

/// A row per course and disturbance: of all its seeds the mean and the worst.
std::string to_table(const std::vector<Run>& runs);
/// {"runs": [{"course", "disturbance", "seed", "problem", "truth": {…}, "believed": {…}, "track":
/// [[t_s, east_m, north_m, heading_deg, speed_mps], …]}], "ways": {course: [[east_m, north_m],
/// …]}}. Tracks are true, ways intended; both in metres of the course.
std::string to_json(const std::vector<Run>& runs, const Setup& setup);
/// One plot: the intended way, all seeds' tracks, and the cross-track error along the way.
std::string to_svg(const std::vector<const Run*>& runs);

}  // namespace roverd::study
