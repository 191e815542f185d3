#pragma once
// The sense thread: takes what sensors saw from their drivers' threads, and gives the robot the
// surroundings. Control never waits for it, nor it for control.
//
//   drivers ─see()─▶ inbox (bounded, the oldest goes) ─▶ Lookout ─▶ Robot::surroundings()
//                          robot.odometry() ────────────────┘

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include <semaphore.h>

#include "base/inbox.hpp"
#include "base/sight.hpp"
#include "robot/guard/lookout.hpp"
#include "robot/robot.hpp"

namespace roverd {

class SenseLoop {
 public:
  /// Starts the thread. @param robot outlives it.
  SenseLoop(robot::Robot& robot, robot::Lookout lookout);
  ~SenseLoop();
  SenseLoop(const SenseLoop&) = delete;
  SenseLoop& operator=(const SenseLoop&) = delete;

  /// Ends the thread. Idempotent; what is seen from then on is left.
  void stop();
  /// Any thread; never waits for the work.
  void see(std::shared_ptr<const base::Sight> sight);

 private:
  void run() noexcept;

  robot::Robot& robot_;
  robot::Lookout lookout_;
  base::Inbox<std::shared_ptr<const base::Sight>> sights_{64};
  sem_t news_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace roverd
