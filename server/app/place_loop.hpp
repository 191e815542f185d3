#pragma once
// The thread that looks for the robot in its map: a match takes some milliseconds, a search of the
// whole map a second, and neither control nor the sense thread waits for it.
//
//   SenseLoop ─sights, odometry─▶ inbox (bounded, the oldest goes) ─▶ Whereabouts ─▶ robot's inbox
//                    robot.snapshot() ─what is believed──────────────┘

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <semaphore.h>

#include "base/inbox.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "config/settings.hpp"
#include "nav/place/whereabouts.hpp"
#include "robot/robot.hpp"

namespace roverd {

class PlaceLoop {
 public:
  using Map = std::shared_ptr<const nav::place::MapInUse>;

  /// Starts the thread. @param robot outlives it. @param mounts of the sensors, by name
  PlaceLoop(robot::Robot& robot, Map map, const nav::place::WhereaboutsParams& params,
            std::map<std::string, base::Mount> mounts);
  ~PlaceLoop();
  PlaceLoop(const PlaceLoop&) = delete;
  PlaceLoop& operator=(const PlaceLoop&) = delete;

  /// Ends the thread. Idempotent.
  void stop();
  /// Any thread; never waits for the work.
  void take(const std::vector<std::shared_ptr<const base::Sight>>& sights,
            const std::vector<nav::sense::Odometry>& moved);
  /// Any thread: a person said where the robot stands.
  void told(const nav::place::Word& word);

 private:
  void run() noexcept;
  void work();

  robot::Robot& robot_;
  nav::place::Whereabouts where_;
  const std::map<std::string, base::Mount> mounts_;
  base::Inbox<std::shared_ptr<const base::Sight>> sights_{16};
  base::Inbox<nav::sense::Odometry> moved_{256};
  base::Inbox<nav::place::Word> words_{4};
  std::vector<std::shared_ptr<const base::Sight>> sight_batch_;
  std::vector<nav::sense::Odometry> moved_batch_;
  std::vector<nav::place::Word> word_batch_;
  sem_t news_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The map of [map]; null: none is said. NotFound, Malformed and the rest with key and file.
base::Result<PlaceLoop::Map> map_of(const Settings& settings);
nav::place::WhereaboutsParams whereabouts_of(const Settings& settings);
std::map<std::string, base::Mount> mounts_of(const Settings& settings);

}  // namespace roverd
