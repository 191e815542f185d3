#pragma once
// One driver as the supervisor handles it: callables, so that the supervisor knows no device.

#include <functional>
#include <string>

#include <boost/asio/io_context.hpp>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/time.hpp"

namespace roverd {

/// All but `send` are called on the driver's own thread.
struct Device {
  std::function<void(base::Time)> start;
  std::function<void(base::Time)> tick;
  std::function<void(base::Time)> stop;
  std::function<void(base::Time)> restart;
  /// Control thread, never waits. Empty: it does not move the vehicle.
  std::function<void(const base::DriveCommand&, base::Time)> send{};
  /// Empty: there are none. @return false: it was not sent.
  std::function<bool(const base::LightState&, base::Time)> set_lights{};
  /// Empty: it cannot. @param motor from 1; 0: all. @return false: it was not sent.
  std::function<bool(int motor, base::Time)> clear_errors{};
};

using OnMeasurement = std::function<void(const base::Measurement&)>;

/// What a driver tells. Valid as long as the driver lives.
struct DeviceEars {
  OnMeasurement on_measurement;  ///< on the driver's thread
  /// Any thread. Whether its input is recorded, and why not.
  std::function<void(base::Recording, const std::string& problem)> on_recording;
};

/// How a driver is made, again if need be.
struct DevicePlan {
  std::string name;
  bool moves = false;  ///< it has `send`
  bool sees = false;   ///< what it tells may have to stop the vehicle
  bool lights = false;
  bool clears_errors = false;
  /// On the driver's thread; may throw. Its links live on `io`.
  std::function<Device(boost::asio::io_context& io, const DeviceEars& ears)> make;
};

}  // namespace roverd
