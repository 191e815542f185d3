#pragma once
// Steering and speed rules, one free function each. Pure, noexcept, SI.

#include <algorithm>
#include <cmath>

#include "base/geo.hpp"
#include "nav/track/path.hpp"

namespace roverd::nav {

/// A point seen from the body: x forward, y left, metres.
struct BodyPoint {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// @param yaw_rad the body's.
inline BodyPoint to_body(EnuPoint point, EnuPoint body, double yaw_rad) noexcept {
  const EnuPoint d = point - body;
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {c * d.east_m + s * d.north_m, -s * d.east_m + c * d.north_m};
}

/// Arc from the body's origin, tangent to its forward axis, through a point ahead.
/// @return curvature, 1/m, left positive; 0 if nearer than 5 cm.
/// Source: Coulter 1992, κ = 2y/L².
inline double arc_curvature_1pm(BodyPoint ahead) noexcept {
  const double square = ahead.x_m * ahead.x_m + ahead.y_m * ahead.y_m;
  return square < 0.05 * 0.05 ? 0.0 : 2.0 * ahead.y_m / square;
}

/// Distance to look ahead, metres: grows with speed, and with the distance from the path so that
/// the path is approached at 30° at most (tan 60° = 1.73).
inline double lookahead_m(double speed_mps, double cross_track_m, const TrackParams& p) noexcept {
  const double by_speed = std::clamp(p.lookahead_time_s * std::abs(speed_mps), p.lookahead_min_m,
                                     std::max(p.lookahead_min_m, p.lookahead_max_m));
  return std::max(by_speed, 1.73 * std::abs(cross_track_m));
}

/// Speed from which `distance_m` suffices to stop when braking starts `delay_s` late:
/// v·T + v²/2a = d solved for v; 0 when nothing is left.
inline double stopping_mps(double distance_m, double decel_mps2, double delay_s) noexcept {
  if (distance_m <= 0.0) return 0.0;
  const double at = decel_mps2 * delay_s;
  return std::sqrt(at * at + 2.0 * decel_mps2 * distance_m) - at;
}

/// The same down to `end_mps` instead of zero.
inline double braking_mps(double end_mps, double distance_m, const SpeedParams& p,
                          double delay_s) noexcept {
  if (end_mps <= 0.0) return stopping_mps(distance_m, p.decel_mps2, delay_s);
  const double at = p.decel_mps2 * delay_s;
  const double left = std::max(0.0, distance_m);
  return std::max(end_mps, std::sqrt(at * at + end_mps * end_mps + 2.0 * p.decel_mps2 * left) - at);
}

/// Slower the more the robot points away from where it should go: 1 − 2|error|/π, at least 0.2.
inline double heading_factor(double error_rad) noexcept {
  return std::max(0.2, 1.0 - 2.0 * std::abs(error_rad) / 3.141592653589793);
}

/// Slower on a tight arc: √(a/κ).
inline double bend_mps(double curvature_1pm, double lateral_mps2) noexcept {
  return std::sqrt(lateral_mps2 / std::max(1e-6, std::abs(curvature_1pm)));
}

/// Turn rate on the spot for an angle that is still to go; its braking is part of it.
/// @return over ground, rad/s, the sign of the error.
inline double pivot_rate_radps(double error_rad, const PivotParams& p) noexcept {
  const double angle = std::abs(error_rad);
  const double rate =
      std::min({p.max_rate_radps, std::sqrt(2.0 * p.decel_radps2 * angle), 2.0 * angle + 0.05});
  return std::copysign(rate, error_rad);
}

/// From `now` towards `target` by at most the given steps.
inline double slew(double now, double target, double up, double down) noexcept {
  const bool away = std::abs(target) > std::abs(now) && target * now >= 0.0;
  const double step = away ? up : down;
  return now + std::clamp(target - now, -step, step);
}

/// The smallest of several limits, with its name.
struct SpeedLimit {
  double mps = 0.0;
  SpeedReason reason = SpeedReason::Item;

  void cut(double limit_mps, SpeedReason why) noexcept {
    if (limit_mps < mps) {
      mps = limit_mps;
      reason = why;
    }
  }
};

}  // namespace roverd::nav
