#pragma once
// The thread that looks for the robot in its map: a match takes some milliseconds, a search of the
// whole map a second, and neither control nor the sense thread waits for it.
//
//   SenseLoop ─sights, odometry─▶ inbox (bounded, the oldest goes) ─▶ Whereabouts ─▶ robot's inbox
//                    robot.snapshot() ─what is believed──────────────┘

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <semaphore.h>

#include "base/inbox.hpp"
#include "base/latest.hpp"
#include "base/result.hpp"
#include "base/sight.hpp"
#include "config/settings.hpp"
#include "maps/shelf.hpp"
#include "nav/place/whereabouts.hpp"
#include "robot/robot.hpp"

namespace roverd {

class PlaceLoop {
 public:
  using Map = std::shared_ptr<const nav::place::MapInUse>;

  /// Starts the thread. @param robot outlives it. @param map null: none is in use yet
  /// @param mounts of the sensors, by name
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
  /// Any thread: another map from now on; null: none. One that waits for that still is dropped, so
  /// no more than two are held. @param same_place see Whereabouts::use
  void use(Map map, bool same_place);
  /// Any thread: another map was asked for and is not looked in yet.
  bool changes() const noexcept { return done_ != asked_; }
  /// Waits until what was asked for is looked in, and the robot tells so. @return false: not within
  /// that time
  bool looks_within(base::Duration most) const;
  /// Any thread: how the map in use lies on the earth; null: nobody knows.
  std::shared_ptr<const nav::place::MapAnchor> placed() const;

 private:
  void run() noexcept;
  void work();
  void take_maps();
  void tell_placed();

  robot::Robot& robot_;
  nav::place::Whereabouts where_;
  const std::map<std::string, base::Mount> mounts_;
  base::Inbox<std::shared_ptr<const base::Sight>> sights_{16};
  base::Inbox<nav::sense::Odometry> moved_{256};
  base::Inbox<nav::place::Word> words_{4};
  struct Choice {
    Map map;
    bool same_place = false;
  };
  std::mutex choice_mutex_;
  std::optional<Choice> choice_;  ///< that waits
  base::Latest<nav::place::MapAnchor> placed_;
  std::atomic<std::uint64_t> asked_{0};  ///< for another map, so often; with choice_mutex_ held
  std::atomic<std::uint64_t> done_{0};
  std::atomic<base::Time> begun_{};  ///< with the map that is looked in
  std::vector<std::shared_ptr<const base::Sight>> sight_batch_;
  std::vector<nav::sense::Odometry> moved_batch_;
  std::vector<nav::place::Word> word_batch_;
  sem_t news_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The files and the anchor of [map]; empty: none is said.
std::optional<maps::Configured> configured_map(const Settings& settings);
/// A kept map, as it is searched. May take a second: not on the web thread. As Shelf::read.
base::Result<PlaceLoop::Map> map_of(const maps::Shelf& shelf, std::int64_t id);
/// As people and the shelf say it.
maps::Anchor told_anchor(const nav::place::MapAnchor& anchor) noexcept;
nav::place::WhereaboutsParams whereabouts_of(const Settings& settings);
/// Of the sensors in which a map is looked for and made: [map] sensor, or all that look around.
std::map<std::string, base::Mount> mounts_of(const Settings& settings);
/// Their names, the best for a map of the plane first: scanners of one plane, as such maps are
/// drawn by, then lidars, depth cameras with their narrow view, single rangers.
std::vector<std::string> eyes_of(const Settings& settings);

}  // namespace roverd
