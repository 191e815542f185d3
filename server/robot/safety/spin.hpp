#pragma once
// Do the wheels turn on the spot? Tracks in mud spin, and odometry counts a way that was not
// driven; the estimator gates the receiver's positions against it, so it would believe the tracks
// for a while and pass waypoints that were never reached.
//
//   Gripping ──the receiver sees less than 0.4 of the wheels' speed, for the time limit──▶ Spinning
//      ▲                                                                                      │
//      └──────────it sees more, the wheels stand, or one of the two tells nothing─────────────┘
//
// Control thread.

#include <cmath>
#include <optional>

#include "base/measurements.hpp"
#include "base/time.hpp"

namespace roverd::robot {

class SpinWatch {
 public:
  static constexpr double kSpeed_mps = 0.2;  ///< slower wheels prove nothing
  static constexpr double kShare = 0.4;
  static constexpr double kSigma_mps = 0.1;  ///< of receivers that do not tell
  static constexpr base::Duration kFresh = std::chrono::seconds(1);

  /// Once a tick, with what was heard last of either.
  void step(const std::optional<base::BaseMotion>& wheels,
            const std::optional<base::GnssVelocity>& ground, base::Time now) noexcept {
    // Seen beyond doubt once, it lasts while nothing speaks against it: a robot that slows down,
    // because it does not know its place, is no less stuck.
    if (!spins(wheels, ground, since_ ? -0.5 : 2.0, now)) {
      since_.reset();
    } else if (!since_) {
      since_ = now;
    }
  }

  bool for_longer_than(double limit_s, base::Time now) const noexcept {
    return since_ && base::seconds(now - *since_) > limit_s;
  }

 private:
  static bool spins(const std::optional<base::BaseMotion>& wheels,
                    const std::optional<base::GnssVelocity>& ground, double sigmas,
                    base::Time now) noexcept {
    if (!wheels || !ground) return false;
    if (now - wheels->stamp > kFresh || now - ground->stamp > kFresh) return false;
    const double told_mps = std::abs(wheels->twist.linear_mps);
    const double seen_mps = std::hypot(ground->east_mps, ground->north_mps);
    const double sigma_mps = ground->sigma_mps.value_or(kSigma_mps);
    return told_mps >= kSpeed_mps && seen_mps + sigmas * sigma_mps < kShare * told_mps;
  }

  std::optional<base::Time> since_;
};

}  // namespace roverd::robot
