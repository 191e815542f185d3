#pragma once
// DOCK: a slow, straight, final approach to a pose, judged when it stands.
//
//      pose ◀── final straight ── gate ◀── way to the gate, at ordinary speed
//
//   Enter: armed, position known and certain enough for the tolerance, a pose.
//
//   ToGate ──stands at the gate, faces the pose──▶ Straight ──stands at its end──▶ Judge
//     ▲                                                                             │
//     └──outside of the tolerance, first time: back out to the gate── BackOut ◀─────┤
//                                                       within the tolerance──▶ Docked
//                                                       second time, or stuck──▶ Failed
//
//   Exit: Docked and Failed end in HOLD; any other mode; a condition that holds; the fence.
//
// From the GNSS pose now; whoever has a better one at the dock gives it as the vehicle's pose.
// Control thread.

#include <optional>
#include <string>
#include <utility>

#include "base/setting.hpp"
#include "nav/behave/mode_params.hpp"
#include "nav/behave/trip.hpp"

namespace roverd::nav {

struct DockGoal {
  EnuPoint at;
  double yaw_rad = 0.0;  ///< of the vehicle when docked
  bool reverse = false;  ///< docks with its tail
};

class Dock {
 public:
  enum class State { Idle, ToGate, Straight, BackOut, Docked, Failed };

  Dock(base::Setting<PathParams> path, base::Setting<BehaveParams> behave,
       base::Setting<ModeParams> modes)
      : path_(std::move(path)), modes_(std::move(modes)), trip_(path_, std::move(behave)) {}

  void begin(const DockGoal& goal, const Vehicle& vehicle);
  void reset() noexcept;
  void interrupt() noexcept { trip_.interrupt(); }
  TrackOutput step(const Vehicle& vehicle, double limit_mps, double dt_s);

  State state() const noexcept { return state_; }
  const std::string& reason() const noexcept { return reason_; }
  const DockGoal& goal() const noexcept { return goal_; }
  std::optional<double> distance_left_m() const noexcept;

 private:
  EnuPoint gate() const noexcept;
  std::optional<EnuPoint> join(const Vehicle& vehicle) const noexcept;
  double straight_m() const noexcept;
  void to_gate(const Vehicle& vehicle);
  void straight(const Vehicle& vehicle);
  void judge(const Vehicle& vehicle);

  base::Setting<PathParams> path_;
  base::Setting<ModeParams> modes_;
  Trip trip_;
  DockGoal goal_;
  State state_ = State::Idle;
  int tries_ = 0;
  std::string reason_;
};

}  // namespace roverd::nav
