#pragma once
// One driver with a thread and an io_context of its own, so that one that throws, or never comes
// back from a call, disturbs nobody.
//
//   Working ─throws─▶ Failed                      stopped (its base is told to stand), thread ended
//   Working ─no sign of life for kHung─▶ Hung ─it comes back─▶ Working
//   any ─abandon─▶ Abandoned                      no word from it is believed any more
//
// Failed and Hung are told as DriverPhase::Failed. A failed driver is not made again by itself:
// what it did once it does again, and a person has to know.

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "supervise/device.hpp"

namespace roverd {

class Runner {
 public:
  static constexpr base::Duration kHung = std::chrono::seconds(3);
  /// What the driver in this place went through before.
  struct Past {
    std::uint64_t restarts = 0;
    std::string last_error{};
    std::optional<base::Time> last_error_at{};
  };
  using Errand = std::function<base::Result<void>(const Device&, base::Time)>;
  using Done = std::function<void(base::Result<void>)>;

  /// Starts the thread, which makes the driver. @param on_measurement called on that thread, and by
  /// look().
  static std::shared_ptr<Runner> begin(const DevicePlan& plan, OnMeasurement on_measurement,
                                       Past past);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Control thread; never waits. Nothing goes out while the driver is being made, or has failed.
  void send(const base::DriveCommand& command, base::Time now) const noexcept;

  /// Any thread: the driver does it soon. @param done called once, on the driver's thread, unless
  /// that hangs.
  void ask(Errand errand, Done done);
  /// Any thread. Closes and opens the driver anew, soon.
  void restart();
  /// Any one thread, now and then: sees whether the driver hangs, and tells.
  void look(base::Time now);
  /// Neither failed nor hanging.
  bool works() const noexcept { return !failed_ && !ended_ && !hung_; }
  Past past() const;

  /// Asks it to stop and to end its thread.
  void stop();
  /// @return false: it did not end in time.
  bool wait_until(base::Time deadline);
  /// Nothing it says is passed on from here on; its thread is left to itself if it hangs.
  void abandon() noexcept;

 private:
  Runner(const DevicePlan& plan, OnMeasurement on_measurement, Past past);
  void run() noexcept;
  void live();
  void fail(const std::string& what) noexcept;
  void tick_soon();
  void hear(const base::Measurement& m);
  void tell(base::DriverStatus status);
  void tell_failure(const std::string& what, base::Time now);
  void doing(const char* what) noexcept;

  const DevicePlan plan_;
  const OnMeasurement on_measurement_;
  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      io_.get_executor()};
  boost::asio::steady_timer timer_{io_};
  std::chrono::steady_clock::time_point due_{};  ///< of the next tick

  std::atomic<bool> ready_{false};  ///< device_ is there and may be sent to
  std::atomic<bool> failed_{false};
  std::atomic<bool> ended_{false};
  std::atomic<bool> hung_{false};
  std::atomic<base::Time::rep> alive_at_{0};
  std::atomic<const char*> doing_{"being made"};

  mutable std::mutex mutex_;  // leaf but for the receiver's own; guards from here to device_
  std::condition_variable end_;
  bool abandoned_ = false;
  Past past_;
  base::DriverStatus last_;
  base::Recording recording_ = base::Recording::Off;
  std::string recording_problem_;

  Device device_;  ///< driver's thread; not changed once ready_
  std::thread thread_;
};

}  // namespace roverd
