#pragma once
// One revision of a mission, laid out in one local frame. Made on the caller's thread, driven by
// the control thread; immutable.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geo.hpp"
#include "mission/checks.hpp"
#include "nav/behave/route.hpp"
#include "robot/robot.hpp"

namespace roverd::robot {

struct CompiledMission {
  std::uint64_t id = 0;  ///< of this very compilation
  MissionCopy copy;
  base::LocalFrame frame;
  nav::Route route;
  std::uint64_t way = 0;        ///< Config::way of the parameters that it was laid out by
  std::uint64_t fence_id = 0;   ///< LaidFence::id of the fence that was looked at; 0: none
  double fence_margin_m = 0.0;  ///< with this Config::way_margin_m
  std::optional<mission::Finding> fence_objection{};  ///< of that fence; empty: it stays inside
};

/// What of it is driven as smooth ways: at most kSmoothedShown, those farthest beside first.
std::vector<SmoothedItems> smoothed_items(const CompiledMission& mission);

struct LaidFence;
/// What the fence has against the mission's legs, if the two were compared with this margin; null:
/// they were not. What it points to belongs to one of them.
const std::optional<mission::Finding>* legs_of(const CompiledMission& mission,
                                               const LaidFence& fence, double margin_m) noexcept;

}  // namespace roverd::robot
