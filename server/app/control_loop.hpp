#pragma once
// The thread that calls a tick 50 times a second, at absolute times. A tick that comes late is
// counted by the robot and never made up for: two commands in one instant help nobody.
//
// Between two ticks it sleeps, and nothing but alert() wakes it: a stop that was asked for leaves
// then, not with the next tick. The ticks stay where they are.

#include <atomic>
#include <functional>
#include <thread>

#include <semaphore.h>

#include "base/time.hpp"

namespace roverd {

class ControlLoop {
 public:
  static constexpr base::Duration kPeriod = std::chrono::milliseconds(20);
  /// now, wall, and how much later than planned the thread woke.
  using Tick = std::function<void(base::Time, base::WallTime, base::Duration)>;

  /// After alert(), between two ticks; must be short.
  using Heed = std::function<void(base::Time)>;

  /// Starts the thread, with real-time priority where the system allows it.
  ControlLoop(Tick tick, Heed heed);
  /// Waits for the tick in progress, at most one period.
  ~ControlLoop();
  ControlLoop(const ControlLoop&) = delete;
  ControlLoop& operator=(const ControlLoop&) = delete;

  /// Any thread, never waits. More of them before it is heeded are one.
  void alert() noexcept;

  /// Whether the system granted real-time priority.
  bool real_time() const noexcept { return real_time_; }

 private:
  void run() noexcept;
  bool sleep_until(base::Time t) noexcept;

  Tick tick_;
  Heed heed_;
  sem_t alerts_{};
  std::atomic<bool> alerted_{false};
  std::atomic<bool> stop_{false};
  std::atomic<bool> real_time_{false};
  std::thread thread_;
};

}  // namespace roverd
