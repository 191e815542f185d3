#pragma once
// What a start would refuse of a mission, told before anything moves: one list for check, load,
// preview and start.
//
//   outside_fence           a way of the mission leaves the fence: legs, jumps, laps, ways home
//   approach_outside_fence  the straight way from the robot to the first item does
//   sensor_blind            a sensor that the profile demands sees nothing
//   not_in_map              the robot is not known to be in the map that the mission counts from
//   start_too_far           the first item is farther away than nav.behave.start_within_m
//
// Where the robot joins its way ahead of the first item (nav/behave/join.hpp), that place stands in
// for it.
//
// Pure, any thread. The legs were compared when mission or fence came (route_objection); all that
// depends on the moment costs little.

#include <optional>
#include <string>
#include <vector>

#include "mission/checks.hpp"
#include "mission/fence/fence.hpp"
#include "nav/behave/executor.hpp"

namespace roverd::robot {

struct StartView {
  const nav::Route& route;
  const mission::CompiledFence* limits = nullptr;         ///< null: no fence
  const std::optional<mission::Finding>* legs = nullptr;  ///< route_objection; null: no fence
  double margin_m = 0.0;  ///< of a way that is asked for: kept margin and kFenceAllowance_m
  const nav::PathParams& path;
  const nav::BehaveParams& behave;
  std::optional<nav::Stand> stand{};  ///< empty: not known
  std::optional<base::EnuPoint> home{};
  nav::StartAt at{};
  std::string blind{};       ///< which sensor, and why; empty: all see
  std::string not_in_map{};  ///< why it is not known to be in the mission's map; empty: it is
};

/// Errors all of them; at most one of a kind. Empty: a start has nothing against it.
std::vector<mission::Finding> start_findings(const StartView& view);

/// Does it depend on where the robot stands, so that it may be driven away?
bool of_the_moment(const mission::Finding& finding) noexcept;

}  // namespace roverd::robot
