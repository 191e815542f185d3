#include "sim/battery.hpp"

#include <algorithm>

namespace roverd::sim {

void Battery::step(const BatteryParams& p, double motors_w, double dt_s) {
  const double open_v = p.empty_v + (p.full_v - p.empty_v) * charge_pct_ / 100.0;
  // The current of the last step gives the voltage of this one: the loop is far faster than the
  // battery.
  voltage_v_ = std::max(1.0, open_v - current_a_ * p.resistance_ohm);
  current_a_ = (p.electronics_w + motors_w) / voltage_v_;
  const double used_ah = current_a_ * dt_s / 3600.0;
  set_charge_pct(charge_pct_ - 100.0 * used_ah / p.capacity_ah);
}

double Battery::reach(const BatteryParams& p) const noexcept {
  const double missing =
      std::clamp((p.full_v - voltage_v_) / std::max(0.01, p.full_v - p.empty_v), 0.0, 1.0);
  return voltage_v_ > 0.0 ? 1.0 - p.uneven * missing : 1.0;
}

void Battery::set_charge_pct(double percent) noexcept {
  charge_pct_ = std::clamp(percent, 0.0, 100.0);
}

}  // namespace roverd::sim
