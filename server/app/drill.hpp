#pragma once
// The drill: which program plays the failures, and what it is told of this robot.

#include <memory>

#include "api/api.hpp"
#include "app/child_process.hpp"
#include "app/options.hpp"
#include "config/settings.hpp"

namespace roverd {

/// The study, which holds the simulated vehicle: this program is not to know it, so it lies beside
/// it.
std::string study_program();

/// @param child, robot outlive the door.
api::DrillDoor drill_door(ChildProcess& child, const robot::Robot& robot, const Settings& settings,
                          const Options& options);

}  // namespace roverd
