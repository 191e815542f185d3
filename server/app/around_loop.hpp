#pragma once
// The thread that looks for ways around what stands before a mission: a search may take 20 ms, and
// neither control nor the sensors wait for it.
//
//   Robot::around_questions() ─▶ Planner ─▶ Robot::around_answers()

#include <atomic>
#include <thread>

#include "robot/robot.hpp"

namespace roverd {

class AroundLoop {
 public:
  /// Starts the thread. @param robot outlives it.
  explicit AroundLoop(robot::Robot& robot);
  ~AroundLoop();
  AroundLoop(const AroundLoop&) = delete;
  AroundLoop& operator=(const AroundLoop&) = delete;

  /// Ends the thread. Idempotent.
  void stop();

 private:
  void run() noexcept;

  robot::Robot& robot_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace roverd
