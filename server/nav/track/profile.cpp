#include "nav/track/profile.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kOnset_s = 0.2;            // turn rate of a vehicle that turns on the spot
constexpr double kOnsetDeviation_m = 0.05;  // what the wheels' slowness may cost in a bend
constexpr double kStanding_s = 0.5;         // until a stop is noticed and the next leg begins

void backward_pass(Path& path, const Leg& leg, const SpeedParams& speed) noexcept {
  path.points[leg.last].speed_mps = 0.0;
  path.points[leg.last].reason = SpeedReason::Approach;
  for (std::size_t i = leg.last; i-- > leg.first;) {
    PathPoint& p = path.points[i];
    const PathPoint& next = path.points[i + 1];
    const double ds = next.s_m - p.s_m;
    const double brake = std::sqrt(next.speed_mps * next.speed_mps + 2.0 * speed.decel_mps2 * ds);
    p.speed_mps = p.segment_mps;
    p.reason = p.segment_reason;
    if (i > leg.first && path.points[i - 1].segment_mps < p.speed_mps) {
      p.speed_mps = path.points[i - 1].segment_mps;
      p.reason = path.points[i - 1].segment_reason;
    }
    if (brake < p.speed_mps) {
      p.speed_mps = brake;
      p.reason = next.reason;
    }
  }
}

/// Time for a way from speed a to speed b with at most `most` between.
double passage_s(double ds, double a, double b, double most, const SpeedParams& p) noexcept {
  const double up = p.accel_mps2;
  const double down = p.decel_mps2;
  // The peak where speeding up and slowing down meet: v² = (2·ds·a·d + d·a² + a·b²)/(a + d).
  const double peak =
      std::sqrt(std::max(0.0, (2.0 * ds * up * down + down * a * a + up * b * b) / (up + down)));
  const double top = std::max({p.min_mps, a, b, std::min(peak, most)});
  const double ramps_m = (top * top - a * a) / (2.0 * up) + (top * top - b * b) / (2.0 * down);
  return (top - a) / up + (top - b) / down + std::max(0.0, ds - ramps_m) / top;
}

/// From standing at the leg's start. @param begins_s planned. @return when it ends.
double forward_pass(Path& path, const Leg& leg, const SpeedParams& speed,
                    double begins_s) noexcept {
  double v = 0.0;
  double t = begins_s;
  for (std::size_t i = leg.first; i < leg.last; ++i) {
    PathPoint& p = path.points[i];
    p.plan_mps = v;
    p.plan_s = t;
    const PathPoint& next = path.points[i + 1];
    const double ds = next.s_m - p.s_m;
    const double reached = std::min(next.speed_mps, std::sqrt(v * v + 2.0 * speed.accel_mps2 * ds));
    t += passage_s(ds, v, reached, p.segment_mps, speed);
    v = reached;
  }
  path.points[leg.last].plan_mps = 0.0;
  path.points[leg.last].plan_s = t;
  return t;
}

double leg_yaw_rad(const Path& path, const Leg& leg, bool at_end) noexcept {
  const std::size_t i = at_end ? leg.last - 1 : leg.first;
  const double way = direction_rad(path.points[i].at, path.points[i + 1].at);
  return leg.reverse ? way + base::kPi : way;
}

}  // namespace

double bend_onset_s(const VehicleParams& vehicle) noexcept {
  if (!vehicle.steered()) return kOnset_s;
  return std::clamp(2.0 * vehicle.max_steering_deg / vehicle.max_steering_rate_dps, kOnset_s, 3.0);
}

SpeedLimit bend_limit(double curvature_1pm, const PathParams& params) noexcept {
  const SpeedParams& p = params.speed;
  const double k = std::max(curvature_1pm, 1e-6);
  SpeedLimit limit{std::sqrt(p.lateral_mps2 / k), SpeedReason::Bend};
  limit.cut(0.7 * p.max_yaw_rate_radps / k, SpeedReason::Turn);
  if (params.vehicle.steered()) {
    const double onset_s = bend_onset_s(params.vehicle);
    limit.cut(std::sqrt(24.0 * kOnsetDeviation_m / k) / onset_s, SpeedReason::Steer);
  }
  return limit;
}

void plan_speeds(Path& path, const PathParams& params) noexcept {
  double t = 0.0;
  const Leg* before = nullptr;
  for (const Leg& leg : path.legs) {
    if (before != nullptr) {
      const double turn = std::abs(
          base::angle_diff_rad(leg_yaw_rad(path, *before, true), leg_yaw_rad(path, leg, false)));
      t += kStanding_s;
      if (turn > leg.align_rad) t += turn / params.pivot.max_rate_radps + 1.0;
    }
    backward_pass(path, leg, params.speed);
    t = forward_pass(path, leg, params.speed, t);
    before = &leg;
  }
}

}  // namespace roverd::nav
