#pragma once
// From a motion over ground to what the base is told: its tracks slip and pull to a side.
// Pure, noexcept, SI.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/tracker.hpp"

namespace roverd::nav {

/// @param speed_mps, rate_radps over ground. Too much turn: the speed gives way, not the turn. A
/// steered vehicle keeps the curvature its lock allows.
inline base::BodyTwist track_twist(const Vehicle& v, double speed_mps, double rate_radps,
                                   const PathParams& p) noexcept {
  if (p.vehicle.steered()) {
    const double lock =
        std::tan(base::rad_from_deg(p.vehicle.max_steering_deg)) / p.vehicle.wheelbase_m;
    const double most = lock * std::abs(speed_mps);
    rate_radps = std::clamp(rate_radps, -most, most);
  }
  if (speed_mps == 0.0 && rate_radps == 0.0) return {};
  base::BodyTwist t;
  t.linear_mps = speed_mps / v.odometry_scale;
  t.angular_radps = (rate_radps - v.pull_1pm * t.linear_mps) / v.yaw_scale;
  const double most = p.speed.max_yaw_rate_radps;
  if (std::abs(t.angular_radps) > most) {
    const double part = most / std::abs(t.angular_radps);
    t.linear_mps *= part;
    t.angular_radps *= part;
  }
  return t;
}

/// Turn rate towards a heading that leaves room to brake the turn: min(g·ε, √(2aε), w_max).
/// @param error_rad left positive. Source: as nav/track/rules.hpp, pivot_rate_radps.
inline double heading_rate_radps(double error_rad, double gain_1ps, const PathParams& p) noexcept {
  const double angle = std::abs(error_rad);
  const double rate = std::min({gain_1ps * angle, std::sqrt(2.0 * p.pivot.decel_radps2 * angle),
                                p.speed.max_yaw_rate_radps});
  return std::copysign(rate, error_rad);
}

inline bool stands(const Vehicle& v) noexcept {
  return std::abs(v.speed_mps) < 0.03 && std::abs(v.yaw_rate_radps) < 0.06;
}

}  // namespace roverd::nav
