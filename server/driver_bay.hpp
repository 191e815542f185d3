#pragma once
// The drivers of one vehicle on their own thread, made from settings. A driver that fails disturbs
// neither the others nor the control loop.

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "devices.hpp"
#include "options.hpp"
#include "settings.hpp"

namespace roverd {

class DriverBay {
 public:
  /// Errors: a link address that cannot be read, a recording that cannot be opened or written, two
  /// drivers that both want to move the vehicle.
  /// @param on_measurement called on the device thread.
  static base::Result<std::unique_ptr<DriverBay>> make(const Settings& settings,
                                                       const Options& options,
                                                       const OnMeasurement& on_measurement);
  ~DriverBay();
  DriverBay(const DriverBay&) = delete;
  DriverBay& operator=(const DriverBay&) = delete;

  void start();
  /// Sends the base to standby, closes every link, ends the thread. Idempotent.
  void stop();
  /// Control thread; never waits. Does nothing without a base.
  void send(const base::DriveCommand& command, base::Time now) noexcept;
  /// Any thread. Closes and opens the driver anew, soon. Errors: NotFound.
  base::Result<void> restart(const std::string& name);

  std::vector<std::string> names() const;

 private:
  DriverBay(Settings settings, Options options)
      : settings_(std::move(settings)), options_(std::move(options)) {}
  void each(const std::function<void(const Device&, base::Time)>& act) const;
  void tick_soon();

  const Settings settings_;
  const Options options_;
  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      io_.get_executor()};
  boost::asio::steady_timer timer_{io_};
  std::chrono::steady_clock::time_point due_{};  ///< of the next tick
  std::vector<Device> devices_;                  ///< not changed after make()
  const Device* base_ = nullptr;                 ///< the one that moves the vehicle
  std::thread thread_;
};

}  // namespace roverd
