#pragma once
// The loaded mission and the executor that drives it.
//
//   none ──load──▶ loaded ──revise: an item more or less──▶ loaded, under way if it was
//    ▲               │
//    └──revise to nothing, unload (out of the map's reach)
//
// What is replaced comes back to the caller: to free ten thousand items takes longer than a tick
// may. Which mode drives it, and whether it may, others say. Control thread.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "nav/behave/executor.hpp"
#include "robot/compile.hpp"
#include "robot/parameter_set.hpp"

namespace roverd::robot {

class MissionKeeper {
 public:
  using Mission = std::shared_ptr<const CompiledMission>;

  explicit MissionKeeper(const ParameterSet& set)
      : executor(set.path, set.behave, set.modes, set.row, set.marks) {}

  const Mission& get() const noexcept { return mission_; }
  explicit operator bool() const noexcept { return mission_ != nullptr; }
  const CompiledMission* operator->() const noexcept { return mission_.get(); }

  /// Running, Paused or Blocked.
  bool in_hand() const noexcept { return in_hand(executor.state()); }
  /// It waits for someone to go on with it.
  bool waits() const noexcept {
    const base::ExecutionState s = executor.state();
    return s == base::ExecutionState::Paused || s == base::ExecutionState::Blocked;
  }

  /// @param mission never null. @return the one before
  Mission load(Mission mission);
  Mission unload() { return load(nullptr); }
  /// Conflict unless the loaded one is what the revision was made from.
  base::Result<void> may_revise(const ReviseMission& revision) const;
  /// @return the one before. Afterwards nothing may be loaded.
  Mission revise(const ReviseMission& revision);
  /// Would it go on from there? @return why not
  base::Result<void> may_restore(const ResumeAt& left, const ParameterSet& set,
                                 base::EnuPoint here) const;
  /// The same revision by other parameters: may it take the place of the loaded one?
  base::Result<void> may_lay_anew(const CompiledMission& mission) const;
  /// @return the one before
  Mission lay_anew(Mission mission);
  /// After load, of the same mission.
  void restore(const base::MissionPlace& place);

  /// In the words of the snapshot. @param radio the radio drives
  base::MissionProgress progress(const std::optional<base::Pose>& pose,
                                 const std::optional<base::LocalFrame>& frame, bool radio) const;

  /// "mission \"field\" revision 3"
  std::string name() const;

  nav::Executor executor;

 private:
  static bool in_hand(base::ExecutionState s) noexcept {
    return s == base::ExecutionState::Running || s == base::ExecutionState::Paused ||
           s == base::ExecutionState::Blocked;
  }
  std::shared_ptr<const nav::Route> route() const {
    return mission_ ? std::shared_ptr<const nav::Route>(mission_, &mission_->route) : nullptr;
  }

  Mission mission_;
};

/// What is kept is up to a second old, and the robot rolled on: of a row or a wall so much more is
/// done, of a move or an arc so much less is left. @param place of that route. @param pose where
/// the robot stands now
base::MissionPlace rolled_on(const nav::Route& route, base::MissionPlace place,
                             const base::Pose& pose) noexcept;

}  // namespace roverd::robot
