#pragma once
// Driving by stick with help. The sticks are the drive messages of MANUAL, with the same dead-man's
// handle: let go, or silent for 0.5 s, the robot stops in each of these modes.
//
//   ACRO      the turn rate is held: what the gyro or the tracks miss of it is made up for.
//   STEERING  speed and turn rate over ground; the sideways acceleration is limited. With the turn
//             stick in the middle the heading is held.
//   SIMPLE    the stick's direction counts from the heading at which the mode began: forward is
//             always the same way over the field. The robot turns there and drives.
//
//   Enter: the heading is known; MANUAL's conditions.     Free ──stick──▶ Driving ──let go──▶ Free
//   Exit: any other mode; let go is a stop, not an exit.   (the held heading is taken anew)
//
// Control thread; no allocation.

#include <utility>

#include "base/setting.hpp"
#include "nav/behave/ground.hpp"
#include "nav/behave/mode_params.hpp"

namespace roverd::nav {

enum class StickMode { Acro, Steering, Simple };

class Sticks {
 public:
  Sticks(base::Setting<PathParams> path, base::Setting<ModeParams> modes)
      : path_(std::move(path)), modes_(std::move(modes)) {}

  void begin(StickMode mode, const Vehicle& vehicle) noexcept;
  /// @param stick speed and turn rate asked for, ramped; both 0: let go
  /// @param full what the sticks ask for at their ends
  TrackOutput step(const base::BodyTwist& stick, const base::BodyTwist& full,
                   const Vehicle& vehicle, double limit_mps, double dt_s) noexcept;
  StickMode mode() const noexcept { return mode_; }
  /// Held, or SIMPLE's forward; yaw.
  double yaw_rad() const noexcept { return yaw_rad_; }
  bool holds() const noexcept { return holding_; }

 private:
  TrackOutput acro(const base::BodyTwist& stick, const Vehicle& v, double dt_s) noexcept;
  TrackOutput steering(const base::BodyTwist& stick, const Vehicle& v, double dt_s) noexcept;
  TrackOutput simple(const base::BodyTwist& stick, const base::BodyTwist& full, const Vehicle& v,
                     double dt_s) noexcept;

  base::Setting<PathParams> path_;
  base::Setting<ModeParams> modes_;
  StickMode mode_ = StickMode::Acro;
  double yaw_rad_ = 0.0;
  bool holding_ = false;
  double missing_radps_ = 0.0;  ///< ACRO: integral of the turn rate's error
  double speed_mps_ = 0.0;
  double rate_radps_ = 0.0;
};

}  // namespace roverd::nav
