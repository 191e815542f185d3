#pragma once
// How well a run was driven: its track against the path that its mission meant, with the parameters
// of that day. Measures: nav/measure/measure.hpp. Pure; linear in the number of points.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/params.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"
#include "nav/measure/measure.hpp"
#include "robot/config.hpp"

namespace roverd::robot {

struct ReportPoint {
  double t_s = 0.0;
  base::LatLon at;
  double yaw_rad = 0.0;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  int lap = 1;
  bool by_itself = true;
  std::optional<double> power_w;
  std::optional<int> item{};        ///< in hand; empty: none, or nobody kept it
  std::optional<double> cross_m{};  ///< beside the way in hand as it was told then, left positive
};

/// The way to the first item: no part of what the mission asks for.
struct Approach {
  double time_s = 0.0;
  double driven_m = 0.0;
};

/// An item that is driven by what is seen: along a row, a wall, past landmarks. Its line is that
/// which was seen while it was driven; where none was, nothing of the way is judged.
struct SightMeasure {
  int item = 0;
  std::string_view type;  ///< row wall landmarks
  double driven_m = 0.0;  ///< by the program while the item was in hand, in all laps
  double judged_m = 0.0;  ///< of it with a line in sight
  nav::CrossTrack cross;  ///< of that; 0 without
  bool tells() const noexcept { return judged_m >= kTelling_m; }
  static constexpr double kTelling_m = 1.0;
};

struct RunReport {
  double time_s = 0.0;              ///< from the first point to the last, pauses included
  double driving_s = 0.0;           ///< in which the program drove
  double driven_m = 0.0;            ///< all of it
  std::optional<double> energy_wh;  ///< empty: the battery does not tell
  int laps = 1;
  std::optional<Approach> approach;  ///< empty: it began at the first item
  /// Of the first lap from the first item on, where the program drove to waypoints; not of ways
  /// home, moves, and items that a jump repeats.
  nav::RunMeasure measure;
  std::vector<int> corner_items;       ///< of measure.corners: the item at that vertex
  std::vector<int> straight_items;     ///< of measure.straights: the item it leads to
  std::vector<SightMeasure> by_sight;  ///< in the order of the mission; of those that were begun

  /// Less way than this tells nothing of how well it was driven.
  static constexpr double kTelling_m = 1.0;
  bool tells_way() const noexcept { return measure.driven_m >= kTelling_m; }
  bool tells_corners() const noexcept { return !measure.corners.empty(); }
  bool tells_straights() const noexcept { return !measure.straights.empty(); }
};

/// @param parameters those that differed from their defaults, by full name; unknown ones are left
/// out
/// Errors: Conflict without points, or where the plan has no path any more.
base::Result<RunReport> report_run(
    const mission::Plan& plan, std::span<const ReportPoint> points, int first_item,
    std::span<const std::pair<std::string, base::ParamValue>> parameters);

}  // namespace roverd::robot
