#pragma once
// roverd study --world: drives through simulated worlds in simulated time, and what was touched.
//
//   world, course, speed, sticks or AUTO, faults ─▶ Scenario ─▶ the whole robot, with eyes ─▶
//   counts
//
// The plant is the study's; rays are cast as the simulator's sensors cast them, with their rates,
// noise and delays, and reach the robot as base::Sight. The referee knows the truth: each contact
// of body and world, and whether braking from the first sight would have avoided it. Equal input
// gives equal output, whatever the number of threads.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/geo.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"
#include "sim/world/faults.hpp"
#include "sim/world/world.hpp"
#include "study/study.hpp"

namespace roverd::study {

/// What --world says: FILE, or "random:N", "open:N", "crossing:N", "turning:N", "around:N", each
/// with ":SEED" or without.
struct WorldOrder {
  enum class Kind {
    File,
    Random,    ///< N of all kinds, numbered from the seed on
    Open,      ///< N fields of rough grass in the rain, where nothing stands
    Crossing,  ///< N worlds with people who walk to and fro across the course, 0.5 to 2 m/s
    Around,    ///< N straight ways on which something stands, among other things: driven around
    Turning,   ///< N worlds with people who wander about the course and turn as they like
  };
  Kind kind = Kind::File;
  std::filesystem::path file;
  int count = 1;
  std::uint64_t seed = 1;
};
/// Invalid: N not in 1 .. 100000, or something behind it that is no number.
base::Result<WorldOrder> parse_worlds(std::string_view text);

/// One drive. All of it follows from the order and its number.
struct Scenario {
  std::uint64_t number = 1;
  std::string kind;   ///< static, moving, open, crossing, turning, around, or the file's world
  std::string fault;  ///< none, rain, dust, dropouts, sun, dirt, noise or dead
  sim::world::World world;
  Course course;  ///< by sticks: only where it begins to look
  /// Driven in place of the course, which then only says where it begins to look.
  std::optional<mission::Plan> plan{};
  double speed_mps = 1.0;
  bool sticks = false;  ///< somebody drunk drives, with the dead-man held
  bool lidar = false;   ///< a VLP-16 above and a scanner ahead; else scanners ahead and behind
  sim::world::SensorFaults faults;
  double fault_after_s = 5.0;  ///< of the drive
  double time_s = 60.0;
  /// What stays is driven around, and each way around takes up to so long to be found; empty: as
  /// the settings say, and at once.
  std::optional<double> around_late_s{};
};
/// @param courses empty: a straight, an L and a slalom. @param world of a file.
/// Invalid: a course without points.
base::Result<Scenario> scenario_of(const WorldOrder& order, std::uint64_t number,
                                   const std::vector<Course>& courses,
                                   const sim::world::World& world);

/// Whose was it?
enum class Blame {
  Ours,      ///< braking from the first sight would have avoided it
  Late,      ///< it came in sight too late for any brakes, or would have come to it anyhow
  Beside,    ///< what was touched lies beneath the one plane of its scanners or hangs above it, or
             ///< rises no higher over the ground than grass
  Unseen,    ///< no sensor ever saw it: too low, too high, too dark
  Standing,  ///< the robot stood, or drove away from it: it came
};
std::string_view to_string(Blame blame) noexcept;  // ours late beside unseen standing

struct TouchSeen {
  double at_s = 0.0;
  std::string thing;
  Blame blame = Blame::Ours;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double seen_before_s = 0.0;  ///< the first sight that counts
  bool crossed = false;        ///< ours, but in the way it was too late for any brakes
  double way_m = 0.0;          ///< of the outline since it was seen and where it was touched
  double needed_m = 0.0;       ///< to stop
  double height_m = 0.0;       ///< of the thing
  std::size_t beams = 0;       ///< that met it before, from the first one on
  base::EnuPoint at;
};

/// The guard stood in the way.
struct StopSeen {
  double at_s = 0.0;
  std::string what;       ///< obstacle, drop, unseen, blind
  std::string cause;      ///< of obstacle and drop: thing, left (it was there), or what was met;
                          ///< of who was believed to move: comes, or still (he does not)
  bool needless = false;  ///< nothing true on the swept way
  base::EnuPoint at;      ///< what was said to stand there
  std::string sensor;     ///< that told it
  double age_s = 0.0;     ///< of its last echo
  double rise_m = 0.0;    ///< of the ground there over the plane on which the robot stood
  std::optional<double> stands_m;  ///< room before the static thing that it stopped for
  std::string thing;               ///< that one
};

struct WorldRun {
  Scenario scenario;
  std::string problem;  ///< it could not begin
  double driven_m = 0.0;
  double driven_s = 0.0;
  std::vector<TouchSeen> touches;
  std::size_t brushes = 0;  ///< leaves
  std::vector<StopSeen> stops;
  std::size_t slows = 0;
  std::size_t detours = 0;
  bool finished = false;
  /// Of `around`, for who turns on the spot: a way that keeps 0.3 m from everything leads to the
  /// end (passable.hpp).
  std::optional<bool> way{};
  std::vector<base::EnuPoint> track;
};

/// One drive, on the caller's thread. What the setup says wrongly is an error.
base::Result<WorldRun> run_world(const Setup& setup, const Scenario& scenario);

/// All of them on `jobs` threads, in order. @param told after each, from one thread at a time.
base::Result<std::vector<WorldRun>> run_worlds(const Setup& setup,
                                               const std::vector<Scenario>& scenarios, int jobs,
                                               const std::function<void(std::size_t)>& told);

std::string to_table(const std::vector<WorldRun>& runs);
std::string to_json(const std::vector<WorldRun>& runs, const Setup& setup);
std::string to_svg(const WorldRun& run);
/// Worth a plot: a contact that was ours, or a stop without a cause.
bool remarkable(const WorldRun& run) noexcept;

}  // namespace roverd::study
