#pragma once
// What stands around the robot, as the sense thread hands it to the control thread. Immutable.

#include <memory>
#include <optional>
#include <vector>

#include "base/sensing.hpp"
#include "base/time.hpp"
#include "nav/sense/grid.hpp"

namespace roverd::robot {

struct Surroundings {
  nav::sense::Patch patch;
  /// By number, as Patch::Cell counts them. Shared with the snapshots.
  std::shared_ptr<const std::vector<base::SensorState>> sensors;
  std::optional<base::Time> seen;  ///< by any of them, last
  double lasts_s = 0.5;            ///< so long that is believed
};

}  // namespace roverd::robot
