#pragma once
// What a metre costs, measured: the charge that went while the robot drove, so that it can be told
// whether the rest brings it home.
//
//   a first charge ──drives──▶ measuring ──3 % and 200 m later──▶ known (of all since the first)
//   charge rises by 2 %: it was charged, measuring begins anew; what was known holds until then
//
// What it uses while it stands counts to the metres: too much rather than too little. Control
// thread.

#include <cmath>
#include <optional>

#include "base/measurements.hpp"

namespace roverd::robot {

class BatteryUse {
 public:
  static constexpr double kLeast_pct = 3.0;
  static constexpr double kLeast_m = 200.0;
  static constexpr double kCharged_pct = 2.0;

  /// Once a tick. @param speed_mps of the base; the sign does not matter
  void step(const std::optional<base::BatteryState>& battery, double speed_mps,
            double dt_s) noexcept {
    if (!battery) return;
    const double charge_pct = battery->charge_pct;
    if (!first_pct_ || charge_pct > lowest_pct_ + kCharged_pct) {
      first_pct_ = lowest_pct_ = charge_pct;
      way_m_ = 0.0;
    }
    if (charge_pct < lowest_pct_) lowest_pct_ = charge_pct;
    way_m_ += std::abs(speed_mps) * dt_s;
    const double used_pct = *first_pct_ - lowest_pct_;
    if (used_pct >= kLeast_pct && way_m_ >= kLeast_m) pct_per_m_ = used_pct / way_m_;
  }

  /// Empty: not measured yet.
  std::optional<double> pct_per_m() const noexcept { return pct_per_m_; }

 private:
  std::optional<double> first_pct_;
  double lowest_pct_ = 0.0;
  double way_m_ = 0.0;
  std::optional<double> pct_per_m_;
};

}  // namespace roverd::robot
