#pragma once
// Drive by hand, get a map: what the scanner sees and how the body moves is laid together on a
// thread of its own, and neither control nor the search for the place waits for it.
//
//   SenseLoop ─sights, odometry─▶ inbox (bounded, the oldest goes) ─▶ Mapper
//                    robot.snapshot() ─where the satellites see it─────┘
//
// A scan that moved by less than a hand from the one before says nothing new and is left out: who
// stands fills no memory. What a drive may hold is the mapper's bound.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <semaphore.h>

#include "base/inbox.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "maps/words.hpp"
#include "nav/sense/odometry.hpp"
#include "robot/robot.hpp"

namespace roverd {

class MapMaker {
 public:
  /// @param robot outlives it. @param mounts of the sensors, by name
  MapMaker(robot::Robot& robot, std::map<std::string, base::Mount> mounts);
  ~MapMaker();
  MapMaker(const MapMaker&) = delete;
  MapMaker& operator=(const MapMaker&) = delete;

  /// Any thread; never waits for the work. Nothing is taken while none is made.
  void take(const std::vector<std::shared_ptr<const base::Sight>>& sights,
            const std::vector<nav::sense::Odometry>& moved);
  /// Any thread. Conflict: one is being made.
  base::Result<void> start();
  /// Any thread but the web's: closes the last loops and draws, which takes seconds. Conflict: none
  /// is being made, or nothing was seen: then it has ended, too.
  base::Result<maps::Made> finish();
  /// Drops what was seen. May wait for a scan. Idempotent.
  void cancel();
  /// Any thread. Empty: none is being made.
  std::optional<maps::Making> progress() const;

 private:
  struct Drive;
  void run(Drive& drive) noexcept;
  void work(Drive& drive);
  void look(Drive& drive, const base::Sight& sight);
  std::unique_ptr<Drive> end();

  robot::Robot& robot_;
  const std::map<std::string, base::Mount> mounts_;
  base::Inbox<std::shared_ptr<const base::Sight>> sights_{64};
  base::Inbox<nav::sense::Odometry> moved_{512};
  sem_t news_{};
  std::atomic<bool> making_{false};
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;  ///< of what follows; held while a thread is begun or ended
  std::unique_ptr<Drive> drive_;
  std::thread thread_;
  mutable std::mutex told_mutex_;  ///< leaf
  maps::Making told_;
};

}  // namespace roverd
