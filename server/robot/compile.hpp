#pragma once
// One revision of a mission, laid out in one local frame. Made on the caller's thread, driven by
// the control thread; immutable.

#include <memory>

#include "base/geo.hpp"
#include "nav/behave/route.hpp"
#include "robot/robot.hpp"

namespace roverd::robot {

struct CompiledMission {
  MissionCopy copy;
  base::LocalFrame frame;
  nav::Route route;
};

}  // namespace roverd::robot
