#pragma once
// The sense thread: takes what sensors saw from their drivers' threads, and gives the robot the
// surroundings. Control never waits for it, nor it for control.
//
//   drivers ─see()─▶ inbox (bounded, the oldest goes) ─▶ Lookout ─▶ Robot::surroundings()
//                          robot.odometry() ────────────────┤
//                                                           └▶ outlook(), for people

#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <semaphore.h>

#include "base/inbox.hpp"
#include "base/latest.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "base/vision.hpp"
#include "config/settings.hpp"
#include "robot/guard/lookout.hpp"
#include "robot/robot.hpp"

namespace roverd {

class MapMaker;
class PlaceLoop;

class SenseLoop {
 public:
  /// Starts the thread. @param robot outlives it, and so does @param place, which is handed on
  /// what comes in; null: nobody looks for the robot in a map
  /// @param maker likewise; null: nobody makes maps
  SenseLoop(robot::Robot& robot, robot::Lookout lookout, robot::OutlookParams shown,
            PlaceLoop* place = nullptr, MapMaker* maker = nullptr);
  ~SenseLoop();
  SenseLoop(const SenseLoop&) = delete;
  SenseLoop& operator=(const SenseLoop&) = delete;

  /// Ends the thread. Idempotent; what is seen from then on is left.
  void stop();
  /// Any thread; never waits for the work.
  void see(std::shared_ptr<const base::Sight> sight);
  void recognise(std::shared_ptr<const base::Vision> vision);

  /// Any thread but control's: what people are shown. Whoever asks gets it anew five times a
  /// second; for nobody it is made once a second. Null: nothing is known yet.
  std::shared_ptr<const robot::Outlook> outlook();

 private:
  void run() noexcept;
  void look_out(base::Time now);

  robot::Robot& robot_;
  PlaceLoop* place_;
  MapMaker* maker_;
  robot::Lookout lookout_;
  base::Inbox<std::shared_ptr<const base::Sight>> sights_{64};
  base::Inbox<std::shared_ptr<const base::Vision>> visions_{32};
  sem_t news_{};
  std::atomic<bool> stop_{false};
  const robot::OutlookParams shown_;
  base::Latest<robot::Outlook> outlook_;
  std::atomic<base::Time> asked_{};  ///< for an outlook
  std::optional<base::Time> told_;   ///< one
  std::thread thread_;
};

/// How the outlook is made for this profile.
robot::OutlookParams shown_of(const Settings& settings) noexcept;

}  // namespace roverd
