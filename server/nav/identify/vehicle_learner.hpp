#pragma once
// How the vehicle answers, learned while it drives, and what of it the tracker is told.
//
//   sent(t) ──┬─▶ delay of turning   ┐                 ┌ delay: the learned one, within bounds
//             ├─▶ delay of driving   ├─▶ handling() ──▶┤ braking: never more than the parameter's
//   seen(t) ──┴─▶ braking, speed up  ┘                 └ not shown since arming: half of that
//
// What the robot carries changes while it stands; nobody tells. So the first stop after arming is
// begun as if the brakes were half as good, by braking a little harder than planned: that shows
// what they can, and the rest of the way is planned with it (Tracker, PathParams::prove_braking).
// The delay that steering feels is that of turning, where it was seen well enough, and that of
// speeding up, where the same motors do both.
//
// Control thread; no allocation; nothing here reads a clock.

#include <optional>

#include "base/geo.hpp"
#include "base/snapshot.hpp"
#include "base/time.hpp"
#include "nav/identify/brake_meter.hpp"
#include "nav/identify/delay_meter.hpp"
#include "nav/track/path.hpp"

namespace roverd::nav {

class VehicleLearner {
 public:
  /// One tick's view of the vehicle.
  struct Seen {
    base::Time now{};
    std::optional<base::BodyTwist> tracks;  ///< as the base told last; not what it was told to do
    base::Time tracks_stamp{};
    std::optional<double> yaw_rate_radps;  ///< over ground, now
    bool ours = false;                     ///< the commands are what the base obeys
    bool turns_count = true;               ///< nothing but a command turns it now
  };

  /// Before deciding.
  void see(const Seen& seen) noexcept;
  /// After it: what the base is told, in the tracks' measure.
  void sent(const base::BodyTwist& twist, const PathParams& set) noexcept;
  /// What it carries may be another load from here on.
  void doubt_braking() noexcept { braking_.doubt(); }

  /// What another life of this program learned.
  void recall(const base::VehicleLearned& known) noexcept;
  /// It brakes no harder, as far as is known.
  std::optional<double> braking_limit_mps2() const noexcept { return braking_.limit_mps2(); }
  /// What is known now, whatever is used of it.
  base::VehicleLearned learned(const PathParams& set) const noexcept;
  /// Of this, what was not merely recalled: only that is as fresh as today.
  base::VehicleLearned learned_now(const PathParams& set) const noexcept;

  /// Never more optimistic about braking and speeding up than what was set; the delay between 0.3
  /// times what was set and 0.4 s more. @return whether `use` is another one now
  bool handle(const PathParams& set, PathParams& use) noexcept;

 private:
  std::optional<DelayFound> delay(const PathParams& set) const noexcept;
  double longest_delay_s(const PathParams& set) const noexcept;

  DelayMeter turning_{kTurnExcited};
  DelayMeter driving_{kDriveExcited};
  BrakeMeter braking_{BrakeMeter::Way::Braking};
  BrakeMeter speeding_up_{BrakeMeter::Way::SpeedingUp};
  std::optional<DelayFound> turned_;  ///< the last that turning told
  std::optional<DelayFound> drove_;   ///< what speeding up and slowing down tell
  std::optional<DelayFound> recalled_;
  base::Time told_{};  ///< stamp of what the base told last
  double seen_mps_ = 0.0;
  double can_mps_ = 0.0;  ///< told, as fast as it can follow
  bool ours_ = false;
  bool speaks_ = false;  ///< the base tells its speed
  int rolling_ = 0;      ///< ticks in which it was told to drive, not to turn on the spot
  int heard_ = 1000;     ///< ticks since the base told
  int unsure_ = 0;       ///< ticks in which what the vehicle can do is not known well
  int look_ = 0;         ///< ticks until turning is asked again

  static constexpr double kTurnExcited = 0.03 * 0.03;   // (rad/s)²
  static constexpr double kDriveExcited = 0.15 * 0.15;  // (m/s)²
};

}  // namespace roverd::nav
