#pragma once
// Between two modes that drive by themselves the command is zero until the robot stands: a vehicle
// that rolls one way cannot begin another, and wheels that stand do not turn under load.
//
//   Open ──mode changes while moving──▶ Zero ──stands for 0.1 s──▶ Open
//
// By hand there is no waiting: the operator's ramp begins at zero. Control thread.

#include <cmath>

namespace roverd::robot {

class Changeover {
 public:
  static constexpr double kStill_mps = 0.05;
  static constexpr double kStill_radps = 0.08;
  static constexpr double kStillFor_s = 0.1;

  void begin() noexcept {
    waits_ = true;
    still_s_ = 0.0;
  }
  void skip() noexcept { waits_ = false; }

  /// Once a tick while a mode drives. @return true just when the wait ended.
  bool ends(double speed_mps, double rate_radps, double dt_s) noexcept {
    if (!waits_) return false;
    const bool still = std::abs(speed_mps) < kStill_mps && std::abs(rate_radps) < kStill_radps;
    still_s_ = still ? still_s_ + dt_s : 0.0;
    if (still_s_ < kStillFor_s) return false;
    waits_ = false;
    return true;
  }
  bool waits() const noexcept { return waits_; }

 private:
  bool waits_ = false;
  double still_s_ = 0.0;
};

}  // namespace roverd::robot
