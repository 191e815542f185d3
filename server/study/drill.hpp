#pragma once
// roverd study drill: where would the robot stand? Each failure of a list is played at one place of
// a mission, by the whole robot in simulated time, and measured by its true pose.
//
//   one JSON document on stdin ─▶ order ─▶ for each failure: drive up to the place, break, watch
//                                              └─▶ one JSON line on stdout
//
// The document, written by roverd itself:
//
//   {"settings": {"nav.speed.max_mps": 1.0, …},      told() of the running program
//    "sim": "config/sim/bunker.toml",                the plant
//    "mission": {"id", "revision", "plan": {…}}, "fence": {…} | null,
//    "home": {"lat", "lon"} | null, "origin": {"lat", "lon"} | null,  of the robot's map
//    "at_m": 40.0 | null, "limit_s": 120.0, "failures": ["drive_link", …]}   empty: all it has
//
// Lines: {"begins": {…}} once, then {"result": {…}} for each failure; or {"error": {"detail",
// "fields"}} and exit code 2.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/drill.hpp"
#include "config/settings.hpp"
#include "mission/fence/fence.hpp"
#include "nav/track/path.hpp"
#include "robot/robot.hpp"
#include "sim/config.hpp"

namespace roverd::study {

struct DrillOrder {
  Settings settings;
  sim::Params plant;
  robot::MissionCopy mission;
  std::shared_ptr<const mission::Fence> fence;  ///< null: none
  std::optional<base::LatLon> home;
  std::optional<base::LatLon> origin;  ///< of the robot's map: local items count from there
  std::optional<double> at_m;          ///< along the way; empty: its middle
  double limit_s = base::kDrillLimit_s;
  std::vector<std::string_view> failures;  ///< ids of base::kDrillFailures; empty: all it has
};

/// Malformed or Invalid, naming the member by JSON pointer.
base::Result<DrillOrder> read_drill(std::string_view text);

/// Where the failures begin, and from where the simulated robot drives there.
struct DrillPlace {
  base::LocalFrame frame;  ///< of the path
  nav::Path path;
  double length_m = 0.0;
  double at_m = 0.0;
  double from_m = 0.0;     ///< the simulated robot is put down there
  double speed_mps = 0.0;  ///< planned at the failure
  sim::Start start;
};

/// Invalid: the mission has no way, or not so long a one.
base::Result<DrillPlace> place_of(const DrillOrder& order);

enum class DrillEnd {
  Stands,     ///< and nothing drives it on
  Finished,   ///< it went on to the end of its mission
  Home,       ///< it returned
  GoesOn,     ///< it still drives at the end of the simulated time
  NotPlayed,  ///< there is no such thing on this vehicle, or it did not come so far
};
std::string_view to_string(DrillEnd end) noexcept;  // stands finished home goes_on not_played

struct DrillPose {
  base::LatLon at;
  double heading_deg = 0.0;
};

/// All times and ways count from the moment of the failure, by the true pose.
struct DrillResult {
  std::string_view failure;
  DrillEnd end = DrillEnd::NotPlayed;
  std::string reason;  ///< why it goes on, or was not played; what the robot says it stands for
  std::optional<double> zero_s;    ///< until its command is zero and stays so; empty: never
  std::optional<double> stands_s;  ///< until it stands
  double way_m = 0.0;              ///< driven since
  double speed_mps = 0.0;          ///< at the failure
  DrillPose begins;
  DrillPose last;                 ///< where it stands, or was at the end
  double off_way_m = 0.0;         ///< there
  std::optional<double> fence_m;  ///< the body's smallest distance to it; negative: outside
  std::string mode;               ///< afterwards; empty: there is no program any more
  bool armed = false;
  bool estop = false;
  std::vector<base::SafetyCondition> said;  ///< conditions that came, as they were told first
  std::vector<base::LatLon> track;
};

/// The failures that this order plays, in the order of base::kDrillFailures.
std::vector<std::string_view> failures_of(const DrillOrder& order);

/// Plays one. An error: it cannot even set off, whatever the failure.
base::Result<DrillResult> play(const DrillOrder& order, const DrillPlace& place,
                               std::string_view failure);

nlohmann::json begins_json(const DrillOrder& order, const DrillPlace& place);
nlohmann::json result_json(const DrillResult& result);

/// The whole: reads `text`, calls `tell` with each line. @return the program's exit code
int drill(std::string_view text, const std::function<void(const std::string&)>& tell);

}  // namespace roverd::study
