#pragma once
// One revision of a mission, laid out in one local frame. Made on the caller's thread, driven by
// the control thread; immutable.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

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
  std::uint64_t fence_id = 0;  ///< LaidFence::id of the fence that was looked at; 0: none
  std::optional<mission::Finding> fence_objection{};  ///< of that fence; empty: it stays inside
};

}  // namespace roverd::robot
