#pragma once
// From settings to drivers: which there are, over which links, recorded or replayed.

#include <vector>

#include "app/options.hpp"
#include "base/picture.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "base/vision.hpp"
#include "config/settings.hpp"
#include "supervise/device.hpp"

namespace roverd {

/// Who hears of what they see, on their drivers' threads.
struct DeviceEyes {
  base::OnSight on_sight;      ///< sensors
  base::OnVision on_vision;    ///< vision programs
  base::OnPicture on_picture;  ///< cameras
};

/// Every driver that is enabled, or that the recordings to play are for. Errors name file, line and
/// key, or the recording.
base::Result<std::vector<DevicePlan>> plan_devices(const Settings& settings, const Options& options,
                                                   const DeviceEyes& eyes);

}  // namespace roverd
