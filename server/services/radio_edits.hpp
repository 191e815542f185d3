#pragma once
// Changes of the loaded mission that the radio asks for: the robot says what and where, the store
// keeps a new revision of it, and the robot goes on with that without a stop.
//
//   robot ─MissionEdit─▶ queue ─▶ store: revision n+1 ─▶ compile ─▶ robot: ReviseMission ─▶ next
//
// One at a time, in order. What is changed is what is loaded: if somebody saved another revision
// meanwhile, the edit is refused with an event, and nothing is lost. Nothing loaded: a waypoint
// goes to the mission that was cleared last, or to a new one. The services' thread.

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "robot/robot.hpp"
#include "services/desk.hpp"
#include "store/store.hpp"

namespace roverd::services {

class RadioEdits {
 public:
  /// How long the robot may take to go on with a revision.
  static constexpr base::Duration kPatience = std::chrono::seconds(2);

  /// All must outlive it. @param store answers on the desk
  RadioEdits(robot::Robot& robot, store::Store& store, Desk& desk);
  ~RadioEdits();
  RadioEdits(const RadioEdits&) = delete;
  RadioEdits& operator=(const RadioEdits&) = delete;

  /// Writes an event as if the robot had said it.
  std::function<void(base::Event)> tell;
  /// A revision was stored.
  std::function<void(const store::StoredMission&)> announce;

  void put(robot::MissionEdit edit);
  /// Now and then: an edit that the robot does not answer is given up.
  void sweep(base::Time now);

 private:
  static constexpr std::size_t kWaiting = 16;

  struct Target {
    std::string id;  ///< empty: a mission has to be made
    std::int64_t revision = 0;
    bool is_loaded = false;
    mission::Plan plan;
  };

  void next();
  void save(Target target, int item);
  void hand_over(const Target& before, int item, store::StoredMission stored);
  Target find_target(const robot::MissionEdit& edit);
  void finish(base::Result<void> result);

  robot::Robot& robot_;
  store::Store& store_;
  Desk& desk_;
  std::deque<robot::MissionEdit> waiting_;  ///< the first one is at work
  std::optional<Target> cleared_;
  std::optional<base::Time> give_up_;  ///< the first edit is with the robot, until then
  std::uint64_t handed_ = 0;           ///< late answers know which edit they are of
  std::shared_ptr<RadioEdits*> self_ = std::make_shared<RadioEdits*>(this);
};

}  // namespace roverd::services
