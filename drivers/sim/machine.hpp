#pragma once
// Who drives the base: its modes, its watchdog, its e-stop.
//
//                 0x421 = 1, 2
//     Standby ───────────────────▶ Can, Uart      (radio not heard, or SWB up)
//        ▲ ◀──────── 0x421 = 0 ────┘  │
//        │                            │ radio heard, SWB middle or down
//        │ SWB up, or radio lost      ▼
//        └──────────────────────── Radio ◀── any mode, also at power-up
//
//   After Radio the base stands in Standby: it wants a new 0x421 before it obeys 0x111.
//   A CAN request while the radio drives makes the shown mode flicker; too many of them latch an
//   exception, which only a power cycle clears.
//   E-stop and exception: modes change as above, nothing moves.

#include <cstdint>
#include <optional>

#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/time.hpp"
#include "sim/params.hpp"
#include "sim/radio.hpp"

namespace roverd::sim {

using base::Time;

/// What the base sees at one step.
struct MachineInput {
  Radio radio;
  bool radio_heard = false;
  bool estop = false;
  bool battery_fault = false;
  bool motor_fault = false;
};

struct Wanted {
  base::BodyTwist twist;
  bool brake = false;  ///< e-stop or exception: brake at once
};

class Machine {
 public:
  /// 0x421. @param mode raw byte 0; values other than 0, 1, 2 are ignored.
  void request_mode(std::uint8_t mode, int fight_limit, Time now);
  /// 0x111. Kept in every mode, obeyed in CAN mode only.
  void command(base::BodyTwist twist, Time now);

  /// Once a step, before the tracks.
  Wanted step(const Params& p, const MachineInput& in, Time now);

  base::ControlMode shown_mode(Time now) const noexcept;
  base::VehicleState state() const noexcept { return state_; }
  /// The transmitter was heard since power-up and is not heard now.
  bool radio_lost() const noexcept { return radio_lost_; }
  void power_cycle();

 private:
  void follow_radio(const MachineInput& in);

  base::ControlMode mode_ = base::ControlMode::Standby;
  base::VehicleState state_ = base::VehicleState::Normal;
  base::BodyTwist command_;
  std::optional<Time> commanded_;
  base::Switch swb_ = base::Switch::Unknown;  ///< last position between detents kept
  bool heard_once_ = false;
  bool radio_lost_ = false;
  bool exception_ = false;
  int fights_ = 0;
  Time flicker_until_{};
};

}  // namespace roverd::sim
