#pragma once
// Charge from the voltage, for a base that tells no charge itself. Section [battery].
//
// A battery sags under load, so the voltage is smoothed over half a minute before it is looked up;
// between two points of the curve the charge is linear.
// Control thread.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/setting.hpp"

namespace roverd::robot {

struct BatteryParams {
  std::string curve;
};

template <class V>
void fields(V& v, BatteryParams& p) {
  v("curve", p.curve,
    "voltage and charge in percent, rising, as \"42.0 0, 46.8 20, 54.0 100\"; empty: charge is "
    "known "
    "only where the base tells it");
}

struct CurvePoint {
  double voltage_v = 0.0;
  double charge_pct = 0.0;
};

/// @return at least two points, both rising, 0..1000 V and 0..100 %; none of an empty text.
base::Result<std::vector<CurvePoint>> battery_curve(std::string_view text);

/// What cannot be said by a range.
inline base::Result<void> check(const BatteryParams& p) {
  return battery_curve(p.curve).map([](const auto&) {});
}

/// Of a voltage outside the curve the charge is that of its end. @param curve not empty.
double charge_pct(const std::vector<CurvePoint>& curve, double voltage_v) noexcept;

class BatteryGauge {
 public:
  static constexpr double kSmooth_s = 30.0;

  BatteryGauge() = default;
  /// @param params checked (battery_curve); of a damaged curve nothing is told.
  explicit BatteryGauge(base::Setting<BatteryParams> params) : params_(std::move(params)) {}

  /// @return the charge as the voltage tells it; empty without a curve or a voltage.
  std::optional<base::BatteryState> step(const base::BaseStatus& base);

 private:
  base::Setting<BatteryParams> params_;
  std::string read_;  ///< the text of which the curve was made
  std::vector<CurvePoint> curve_;
  std::optional<double> smooth_v_;
  base::Time at_{};
};

}  // namespace roverd::robot
