#pragma once
// From settings to drivers: which there are, over which links, recorded or replayed.

#include <vector>

#include "app/options.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "base/vision.hpp"
#include "config/settings.hpp"
#include "supervise/device.hpp"

namespace roverd {

/// Every driver that is enabled, or that the recordings to play are for. Errors name file, line and
/// key, or the recording. @param on_sight, on_vision what sensors see and vision programs
/// recognise, on their drivers' threads.
base::Result<std::vector<DevicePlan>> plan_devices(const Settings& settings, const Options& options,
                                                   const base::OnSight& on_sight,
                                                   const base::OnVision& on_vision);

}  // namespace roverd
