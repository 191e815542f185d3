#pragma once
// Charge and voltage under load.

#include "sim/params.hpp"

namespace roverd::sim {

class Battery {
 public:
  explicit Battery(const BatteryParams& p) : charge_pct_(p.start_pct) {}

  /// @param motors_w drawn by both motors.
  void step(const BatteryParams& p, double motors_w, double dt_s);

  void set_charge_pct(double percent) noexcept;
  double charge_pct() const noexcept { return charge_pct_; }
  double voltage_v() const noexcept { return voltage_v_; }
  double current_a() const noexcept { return current_a_; }  ///< drawn: positive
  /// Of what is wanted of the motors, what they reach.
  double reach(const BatteryParams& p) const noexcept;
  bool warning(const BatteryParams& p) const noexcept { return charge_pct_ < p.warn_pct; }
  bool fault(const BatteryParams& p) const noexcept { return charge_pct_ < p.fault_pct; }

 private:
  double charge_pct_;
  double voltage_v_ = 0.0;
  double current_a_ = 0.0;
};

}  // namespace roverd::sim
