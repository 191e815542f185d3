#pragma once
// The simulated Bunker: CAN frames in, CAN frames and NMEA bytes out, and a true pose that only
// tests look at. It has its own kinematics and knows nothing of the navigation it is to judge.
//
//   receive(frame) ─▶ base machine ─▶ delay, lag, limits ─▶ tracks ─▶ slip ─▶ true pose
//                         │                                   │                   │
//                     0x211 0x241                  0x221 0x251.. 0x311      GNSS, compass
//
// No thread, no clock: advance_to(t) runs fixed inner steps of 5 ms up to t. The same parameters,
// seed, start and inputs at the same times give the same frames and bytes.

#include <cstdint>
#include <functional>
#include <memory>

#include "base/bytes.hpp"
#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/time.hpp"
#include "sim/params.hpp"
#include "sim/radio.hpp"

namespace roverd::sim {

using base::Bytes;
using base::CanFrame;
using base::Time;

struct Start {
  base::LatLon at{58.378020, 26.728900};
  double heading_deg = 40.0;
  Time time{};            ///< the plant's time begins here
  base::WallTime wall{};  ///< what the receiver calls UTC at `time`
};

/// What is really so. Local metres: ENU at the start (east and north of `Start::at`).
struct Truth {
  Time time;
  base::LatLon at;
  base::EnuPoint local;
  double yaw_rad = 0.0;         ///< (−π, π]
  base::BodyTwist twist;        ///< over ground, at the body's origin
  double left_track_mps = 0.0;  ///< what the encoders see
  double right_track_mps = 0.0;
  double driven_m = 0.0;  ///< way of the body's origin since the start
  double battery_pct = 0.0;
  base::ControlMode control_mode = base::ControlMode::Standby;
  base::VehicleState vehicle_state = base::VehicleState::Normal;
  std::uint64_t commands = 0;  ///< 0x111 frames that reached the base
};

class Bunker {
 public:
  static constexpr base::Duration kStep = std::chrono::milliseconds(5);

  Bunker(const Params& params, std::uint64_t seed, const Start& start);
  ~Bunker();
  Bunker(const Bunker&) = delete;
  Bunker& operator=(const Bunker&) = delete;

  /// Called from within advance_to, stamped with the time at which the frame or the sentences of
  /// one epoch leave. Either may be empty.
  std::function<void(const CanFrame&, Time)> on_frame;
  std::function<void(Bytes, Time)> on_gnss;

  /// A frame from the host, now (at the time last advanced to). Unknown ids, extended, remote,
  /// error and short frames are ignored, as the base does.
  void receive(const CanFrame& frame);

  /// Runs whole steps until the next one would end after `now`; an earlier `now` does nothing.
  void advance_to(Time now);

  Truth truth() const;
  const base::LocalFrame& frame() const noexcept;  ///< ENU at the start

  const Radio& radio() const noexcept;
  void set_radio(const Radio& radio);
  const Faults& faults() const noexcept;
  /// A changed gnss_jump_* starts its duration anew; when it is over all three are zero again.
  /// Unknown word in gnss_fix: an error, no change.
  base::Result<void> set_faults(const Faults& faults);
  const Params& params() const noexcept;
  /// Takes effect at the next step; start values (battery.start_pct) do not.
  void set_params(const Params& params);

  /// @param percent is cut to 0..100.
  void set_battery_pct(double percent);
  /// Puts the robot somewhere else, standing. @param at valid.
  void place(base::LatLon at, double heading_deg);
  /// Odometer and counters begin anew, latched errors go, mode as after power-up.
  void power_cycle();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roverd::sim
