#pragma once
// Which mode, and what leads from one to another: the only place where it changes.
//
//   by hand                      standing       by itself
//   MANUAL                                      AUTO                     a mission
//   ACRO STEERING SIMPLE  ◀────▶  HOLD  ◀────▶  GUIDED                   one goal after the other
//                                               RTL SMART_RTL FOLLOW DOCK LOITER CIRCLE
//
//   cause             from                          to
//   chosen            any                           the one that was chosen (never AUTO)
//   mission drives    any                           AUTO
//   a loss, a pause   any                           HOLD
//   a return          by itself, AUTO included      the one that leads home
//   e-stop, its reset any                           HOLD
//   armed, disarmed   by itself, AUTO included      HOLD    (by hand stays: it stands all the same)
//   a fault           by itself, AUTO included      HOLD
//   mission over      AUTO                          HOLD    (finished, stopped, failed, replaced)
//   activity over     by itself, but AUTO, GUIDED   HOLD    (GUIDED stays: another goal may come)
//
// What is not in the table changes nothing. Whether a chosen mode may begin is asked before
// (modes/enter.cpp). Leaving AUTO pauses the mission; between two modes that drive by themselves,
// and on the way into one, the robot stands first (modes/changeover.hpp); into AUTO the executor
// sees to that. Pure; control thread.

#include <optional>

#include "base/snapshot.hpp"

namespace roverd::robot {

enum class ModeKind { ByHand, Standing, Mission, ByItself };
ModeKind kind_of(base::Mode mode) noexcept;
/// AUTO included.
bool drives_by_itself(base::Mode mode) noexcept;
/// RTL, SMART_RTL; DOCK, where it may be charged.
bool leads_home(base::Mode mode) noexcept;

enum class ModeCause {
  Chosen,
  MissionDrives,
  Loss,
  Return,
  Estop,
  EstopReset,
  Armed,
  Disarmed,
  Fault,
  MissionOver,
  ActivityOver
};

struct ModeChange {
  base::Mode from = base::Mode::Hold;
  base::Mode to = base::Mode::Hold;
  bool pauses_mission = false;
  bool stands_first = false;
};

class ModeMachine {
 public:
  base::Mode mode() const noexcept { return mode_; }
  ModeKind kind() const noexcept { return kind_of(mode_); }
  bool by_itself() const noexcept { return drives_by_itself(mode_); }

  /// What `cause` would change; empty: nothing. @param chosen with ModeCause::Chosen and Return
  std::optional<ModeChange> would(ModeCause cause,
                                  base::Mode chosen = base::Mode::Hold) const noexcept;
  /// Does it.
  std::optional<ModeChange> take(ModeCause cause, base::Mode chosen = base::Mode::Hold) noexcept;

 private:
  base::Mode mode_ = base::Mode::Hold;
};

}  // namespace roverd::robot
