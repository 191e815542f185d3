#include "nav/track/profile.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/corner.hpp"

namespace roverd::nav {
namespace {

constexpr double kStanding_s = 0.5;  // until a stop is noticed and the next leg begins
constexpr double kTurnOver_m = 0.5;  // of the way, over which the wheels' turning is averaged

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

SpeedLimit bend_limit(double curvature_1pm, const PathParams& params) noexcept {
  const SpeedParams& p = params.speed;
  const double k = std::max(curvature_1pm, 1e-6);
  SpeedLimit limit{std::sqrt(p.lateral_mps2 / k), SpeedReason::Bend};
  limit.cut(0.7 * p.max_yaw_rate_radps / k, SpeedReason::Turn);
  return limit;
}

/// The segments a window ahead and behind are compared: single ones carry noise.
void limit_steering(Path& path, const PathParams& params) noexcept {
  const VehicleParams& car = params.vehicle;
  if (!car.steered()) return;
  const double rate_radps = kSteeringShare * base::rad_from_deg(car.max_steering_rate_dps);
  const auto wheel_rad = [&](std::size_t i) {
    return std::atan(car.wheelbase_m * path.points[i].curvature_1pm);
  };
  for (const Leg& leg : path.legs) {
    std::size_t last = leg.first;
    for (std::size_t first = leg.first; first + 1 < leg.last; ++first) {
      const double from_m = path.points[first + 1].s_m;  // where its segment ends
      last = std::max(last, first + 1);
      while (last + 1 < leg.last && path.points[last].s_m - from_m < kTurnOver_m) ++last;
      const double way_m = std::max(kTurnOver_m, path.points[last].s_m - from_m);
      const double turn_rad = std::abs(wheel_rad(last) - wheel_rad(first));
      const double mps =
          std::max(rate_radps * way_m / std::max(1e-6, turn_rad), params.speed.min_mps);
      for (std::size_t i = first + 1; i <= last; ++i) {
        if (mps >= path.points[i].segment_mps) continue;
        path.points[i].segment_mps = mps;
        path.points[i].segment_reason = SpeedReason::Steer;
      }
    }
  }
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
