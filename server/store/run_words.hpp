#pragma once
// What the store keeps of runs, of the execution in hand and of changed parameters.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/params.hpp"
#include "base/snapshot.hpp"
#include "mission/plan.hpp"

namespace roverd::store {

/// One sample of a run's track.
struct RunPoint {
  double t_s = 0.0;  ///< since the run began, by the monotonic clock
  base::LatLon at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double sigma_m = 0.0;
  std::optional<double> cross_m;  ///< left of the path positive
  std::optional<int> item;
  int lap = 1;
  std::optional<double> power_w;  ///< out of the battery
  bool by_itself = true;          ///< the program drove, not a person
};

enum class RunOutcome { Running, Finished, Aborted, Interrupted };
std::string_view to_string(RunOutcome o) noexcept;  // running finished aborted interrupted

/// A parameter that differed from its default.
struct RunParameter {
  std::string name;
  base::ParamValue value;
};

struct RunHead {
  std::int64_t id = 0;
  base::WallTime begun;
  std::optional<base::WallTime> ended;
  RunOutcome outcome = RunOutcome::Running;
  std::string mission_id;
  std::int64_t revision = 0;
  std::string name;
  std::string vehicle;
  int first_item = 1;
};

struct StoredRun {
  RunHead head;
  mission::Plan plan;
  std::vector<RunParameter> parameters;
  std::vector<base::Event> events;
};

/// Added to a run, all or nothing.
struct RunBatch {
  std::vector<RunPoint> points;
  std::vector<base::Event> events;
  std::optional<RunOutcome> outcome;  ///< it ended
  base::WallTime ended;
};

/// Where the mission in hand stands.
struct StoredPlace {
  base::WallTime time;
  std::string mission_id;
  std::int64_t revision = 0;
  std::string name;
  std::optional<int> item;
  int items = 0;
  base::MissionPlace place;
};

struct StoredParameter {
  std::string name;
  base::ParamValue value;
};

}  // namespace roverd::store
