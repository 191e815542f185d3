#pragma once
// What of a mission the guard will not let the vehicle drive, as far as it is known before:
// findings too_near, no_effect and unseen_way of checks.hpp. Pure.

#include <vector>

#include "mission/checks.hpp"

namespace roverd::mission {

/// By item.
std::vector<Finding> guarded_findings(const Plan& plan, const VehicleLimits& vehicle);

}  // namespace roverd::mission
