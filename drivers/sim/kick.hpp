#pragma once
// The motors' currents bend the compass: a further error for each ampere by which they differ, as
// the iron around it remembers them.

#include <cmath>

#include "sim/params.hpp"

namespace roverd::sim {

class Kick {
 public:
  /// Once a step. @param motor_difference_a right minus left motor current.
  void step(const CompassParams& p, double motor_difference_a, double dt_s) {
    const double tau_s = p.kick_memory_s;
    const double share = tau_s > 0.0 ? 1.0 - std::exp(-dt_s / tau_s) : 1.0;
    remembered_a_ += (motor_difference_a - remembered_a_) * share;
  }
  /// Shown minus true heading.
  double error_deg(const CompassParams& p) const noexcept {
    return p.kick_deg_per_a * remembered_a_;
  }

 private:
  double remembered_a_ = 0.0;
};

}  // namespace roverd::sim
