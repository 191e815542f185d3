#pragma once
// Drive by hand, get a map: what the scanner sees and how the body moves is laid together on a
// thread of its own, and neither control nor the search for the place waits for it.
//
//   SenseLoop ─sights, odometry─▶ inbox (bounded, the oldest goes) ─▶ Mapper ◀─hang on it─ Clouds
//                    robot.snapshot() ─where the satellites see it─────┘
//
// A scan that moved by less than a hand from the one before says nothing new and is left out: who
// stands fills no memory. What a drive may hold is the mapper's bound.
//
//   None --start--> Driven --finish--> Drawn --kept--> None
//                     ^                  `--not kept: what was driven stays, finish() tries again
//   any --drop, cancel--> None

#include <atomic>
#include <functional>
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
  /// @param eyes their names, the best to look through first. A drive is made of one: the best that
  /// is heard in its first second
  MapMaker(robot::Robot& robot, std::map<std::string, base::Mount> mounts,
           std::vector<std::string> eyes = {});
  ~MapMaker();
  MapMaker(const MapMaker&) = delete;
  MapMaker& operator=(const MapMaker&) = delete;

  /// The sense thread; never waits for the work. Nothing is taken while none is made.
  void take(const std::vector<std::shared_ptr<const base::Sight>>& sights,
            const std::vector<nav::sense::Odometry>& moved);
  /// Any thread; never waits. Conflict: one is being made. Unavailable: no thread for it.
  base::Result<void> start();
  using Keep = std::function<base::Result<maps::About>(const maps::Made&)>;
  /// Any thread but the web's: closes the last loops, draws, which takes seconds, and has it kept.
  /// Where that fails, the reason is told in progress() too, nothing more is taken, and another
  /// call tries again. Conflict: none is being made, it is being drawn by another call, or nothing
  /// was seen: then it has ended. Unavailable: there is no memory for it.
  base::Result<maps::About> finish(const Keep& keep);
  /// Drops what was seen. May wait for a scan. Conflict: none is being made (any more), or it is
  /// being drawn by finish().
  base::Result<void> drop();
  /// The same at the program's end. A finish() that draws meanwhile gives up at its next scan or
  /// loop; what is being kept already is waited for. Idempotent.
  void cancel();
  /// Any thread. Empty: none is being made.
  std::optional<maps::Making> progress() const;

 private:
  struct Drive;
  void run(Drive& drive) noexcept;
  void work(Drive& drive);
  void look(Drive& drive, const base::Sight& sight);
  void look_at_rows(Drive& drive, const base::Sight& sight);
  void tell_silence(Drive& drive);
  void tell_trouble(const std::string& why);
  void stop_taking();
  void forget();
  base::Result<maps::About> draw(const Keep& keep);

  robot::Robot& robot_;
  const std::map<std::string, base::Mount> mounts_;
  const std::vector<std::string> eyes_;
  base::Inbox<std::shared_ptr<const base::Sight>> sights_{64};
  base::Inbox<nav::sense::Odometry> moved_{512};
  std::map<std::string, base::Time> put_;  ///< the newest of each sensor; the sense thread's
  sem_t news_{};
  std::atomic<bool> taking_{false};
  std::atomic<bool> stop_{false};
  std::atomic<bool> ends_{false};  ///< the program does
  std::mutex turn_;                ///< of whoever begins or ends a drive, and of what follows
  std::unique_ptr<Drive> drive_;
  std::thread thread_;
  mutable std::mutex told_mutex_;  ///< leaf
  std::optional<maps::Making> told_;
};

}  // namespace roverd
