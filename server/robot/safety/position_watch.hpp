#pragma once
// What speaks against the position, beside its own uncertainty: that it has been uncertain for
// long, and wheels that turn on the spot (safety/spin.hpp). Control thread; time is an argument.

#include <optional>

#include "robot/config.hpp"
#include "robot/safety/spin.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

class PositionWatch {
 public:
  /// Once a tick. @return true just when the wheels are caught at spinning: the way that they
  /// counted meanwhile misleads all who drive by it.
  /// @param corridor_m of the mission that runs.
  bool step(const std::optional<base::Pose>& pose, const World& world, const SafetyParams& p,
            std::optional<double> corridor_m, Time now) noexcept {
    watch(pose && pose->horizontal_sigma_m > p.sigma_hold_m, bad_since_, now);
    watch(pose && corridor_m && 2.0 * pose->horizontal_sigma_m > *corridor_m, wide_since_, now);
    spin_.step(world.motion, world.gnss_velocity, now);
    const bool spun = spins_;
    spins_ = spin_.for_longer_than(p.spin_s, now);
    return spins_ && !spun;
  }

  bool spins() const noexcept { return spins_; }
  const std::optional<Time>& uncertain_since() const noexcept { return bad_since_; }
  /// 2 sigma do not fit into the corridor.
  const std::optional<Time>& too_wide_since() const noexcept { return wide_since_; }

 private:
  static void watch(bool bad, std::optional<Time>& since, Time now) noexcept {
    if (!bad) since.reset();
    if (bad && !since) since = now;
  }

  SpinWatch spin_;
  bool spins_ = false;
  std::optional<Time> bad_since_;
  std::optional<Time> wide_since_;
};

}  // namespace roverd::robot
