#pragma once
// The thread that calls a tick 50 times a second, at absolute times. A tick that comes late is
// counted by the robot and never made up for: two commands in one instant help nobody.

#include <atomic>
#include <functional>
#include <thread>

#include "base/time.hpp"

namespace roverd {

class ControlLoop {
 public:
  static constexpr base::Duration kPeriod = std::chrono::milliseconds(20);
  /// now, wall, and how much later than planned the thread woke.
  using Tick = std::function<void(base::Time, base::WallTime, base::Duration)>;

  /// Starts the thread, with real-time priority where the system allows it.
  explicit ControlLoop(Tick tick);
  /// Waits for the tick in progress, at most one period.
  ~ControlLoop();
  ControlLoop(const ControlLoop&) = delete;
  ControlLoop& operator=(const ControlLoop&) = delete;

  /// Whether the system granted real-time priority.
  bool real_time() const noexcept { return real_time_; }

 private:
  void run() noexcept;

  Tick tick_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> real_time_{false};
  std::thread thread_;
};

}  // namespace roverd
