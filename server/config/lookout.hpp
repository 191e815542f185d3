#pragma once
// The eyes that the configuration says, as the chain that makes one picture of them. For whoever
// lets a robot see: the sense thread, and studies in simulated time.

#include "base/result.hpp"
#include "base/time.hpp"
#include "config/settings.hpp"
#include "robot/guard/lookout.hpp"

namespace roverd {

/// Of all sensors that are enabled. @param now their watches begin. Invalid: a mount, or a name
/// that is there twice.
base::Result<robot::Lookout> lookout_of(const Settings& settings, base::Time now);

}  // namespace roverd
