#pragma once
// From settings to drivers: which there are, over which links, recorded or replayed.

#include <functional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "options.hpp"
#include "settings.hpp"

namespace roverd {

/// One driver as the bay handles it. All but `send` are called on the device thread.
struct Device {
  std::string name;
  std::function<void(base::Time)> start;
  std::function<void(base::Time)> tick;
  std::function<void(base::Time)> stop;
  std::function<void(base::Time)> restart;
  /// Control thread, never waits. Empty: it does not move the vehicle.
  std::function<void(const base::DriveCommand&, base::Time)> send;
};

using OnMeasurement = std::function<void(const base::Measurement&)>;

/// What a driver is made from. References live as long as the bay.
struct Workshop {
  boost::asio::io_context& io;
  const Settings& settings;
  const Options& options;
  OnMeasurement sink;  ///< called on the device thread
};

/// Every driver that is enabled, the recording considered. Errors name the key.
base::Result<std::vector<Device>> make_devices(const Workshop& workshop);

}  // namespace roverd
