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
#include "bunker/driver.hpp"
#include "gnss/driver.hpp"
#include "options.hpp"
#include "settings.hpp"

namespace roverd {

class DriverBay {
 public:
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  /// Errors: a link address that cannot be read, a recording that cannot be opened or written.
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

  std::vector<std::string> names() const;

 private:
  DriverBay() = default;
  void add_bunker(const Settings& settings, const Options& options, const OnMeasurement& sink);
  void add_gnss(const Settings& settings, const Options& options, const OnMeasurement& sink);
  void tick_soon();

  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      io_.get_executor()};
  boost::asio::steady_timer timer_{io_};
  std::unique_ptr<bunker::Driver> bunker_;
  std::unique_ptr<gnss::Driver> gnss_;
  std::thread thread_;
};

}  // namespace roverd
