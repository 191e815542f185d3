#pragma once
// The drivers of one vehicle, each in a runner of its own. A driver that fails or hangs disturbs
// neither the others nor the control loop; its state says so, and restart() makes it anew.

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/drive_command.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "supervise/device.hpp"
#include "supervise/runner.hpp"

namespace roverd {

class Supervisor {
 public:
  using Done = Runner::Done;

  /// Errors: two drivers that both want to move the vehicle. @param on_measurement called on the
  /// drivers' threads and the supervisor's own; must be safe for that.
  static base::Result<std::unique_ptr<Supervisor>> make(std::vector<DevicePlan> plans,
                                                        OnMeasurement on_measurement);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  void start();
  /// Sends the base to standby, closes every link, ends the threads. One that hangs is left behind
  /// after kGoodbye. Idempotent. Not while send() may be called.
  void stop();
  /// Control thread; never waits. Does nothing without a base, and at the moment in which its
  /// driver is replaced.
  void send(const base::DriveCommand& command, base::Time now) noexcept;

  /// Any thread. Closes and opens the driver, soon; one that failed or hangs is made anew. Errors:
  /// NotFound.
  base::Result<void> restart(const std::string& name);

  bool has_lights() const noexcept;
  bool clears_errors() const noexcept;
  /// Any thread, at once. The driver does it on its own thread, through the gate that its motion
  /// passes. @param not_after later it is refused. @param done called once, on that thread, unless
  /// it hangs; on the caller's with a Conflict where the vehicle has nothing of the kind.
  void set_lights(const base::LightState& lights, base::Time not_after, Done done);
  /// @param motor from 1; 0: all
  void clear_errors(int motor, base::Time not_after, Done done);

  std::vector<std::string> names() const;

 private:
  static constexpr base::Duration kLook = std::chrono::milliseconds(250);
  static constexpr base::Duration kGoodbye = std::chrono::seconds(2);

  struct Slot {
    DevicePlan plan;
    std::shared_ptr<Runner> runner{};
  };

  Supervisor(std::vector<DevicePlan> plans, OnMeasurement on_measurement);
  void look_after();
  void ask(bool DevicePlan::*able, const char* what, Runner::Errand errand, base::Time not_after,
           Done done);

  const OnMeasurement on_measurement_;
  /// Guards the runners in slots_. The control thread only tries it.
  mutable std::mutex mutex_;
  std::vector<Slot> slots_;  ///< but for the runners not changed after make()
  const Slot* base_ = nullptr;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread watch_;
};

}  // namespace roverd
