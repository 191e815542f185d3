#pragma once
// What stands around the robot, as the sense thread hands it to the control thread. Immutable.

#include <string>
#include <vector>

#include "base/sensing.hpp"
#include "base/time.hpp"
#include "nav/sense/grid.hpp"

namespace roverd::robot {

struct Surroundings {
  nav::sense::Patch patch;
  std::vector<base::SensorState> sensors;  ///< by number, as Patch::Cell counts them
};

}  // namespace roverd::robot
