#include "nav/track/corner.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/track/ease.hpp"
#include "nav/track/profile.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using mission::Turn;

const double kStraight_rad = rad_from_deg(2.0);
const double kArcLimit_rad = rad_from_deg(150.0);
const double kAligned_rad = rad_from_deg(5.0);
const double kNoSwing_rad = rad_from_deg(0.5);
constexpr double kEaseLeast_s = 0.5;  // a bend comes no more suddenly, for whoever rides
constexpr double kEaseShare = 0.5;    // of the steering rate, into a bend: back again needs twice
constexpr double kFarther = 1.4;

bool pivots(Turn turn, double angle_rad, const PivotParams& p) noexcept {
  switch (turn) {
    case Turn::Pivot:
      return true;
    case Turn::Auto:
      return angle_rad > rad_from_deg(p.angle_deg);
    case Turn::Arc:
    case Turn::Through:
      return angle_rad > kArcLimit_rad;
  }
  return true;
}

/// The arc that stays within the deviation, as far as the neighbours leave room.
/// Source of the fillet: R = d/(1/cos(θ/2) − 1), T = R·tan(θ/2).
void fillet(Corner& c, double deviation_m, double room_m) noexcept {
  const double half = 0.5 * std::min(std::abs(c.deflection_rad), rad_from_deg(175.0));
  const double half_tan = std::tan(half);
  c.radius_m = deviation_m / (1.0 / std::cos(half) - 1.0);
  c.tangent_m = c.radius_m * half_tan;
  if (c.tangent_m > room_m) {
    c.tangent_m = room_m;
    c.radius_m = room_m / half_tan;
  }
}

/// The way over which the wheels turn into an arc as fast as it may be driven.
double ease_m(double radius_m, std::span<const Vertex, 3> v, const PathParams& p) noexcept {
  const double wanted = std::min(std::max(v[1].speed_mps, v[2].speed_mps), p.speed.max_mps);
  const double mps = std::max(p.speed.min_mps, std::min(wanted, bend_limit(1.0 / radius_m, p).mps));
  const double turn_s = p.vehicle.wheelbase_m / radius_m /
                        (kEaseShare * rad_from_deg(p.vehicle.max_steering_rate_dps));
  return mps * std::max(turn_s, kEaseLeast_s);
}

/// A fillet, eased within the same deviation and room. Where that is all needed, the curvature
/// grows up to the middle and falls from there: nothing turns the wheels more slowly.
void ease_fillet(Corner& c, double deviation_m, double room_m, std::span<const Vertex, 3> v,
                 const PathParams& params) noexcept {
  c.ease_m = ease_m(c.radius_m, v, params);
  c.ease_m = std::min(c.ease_m, std::sqrt(12.0 * c.radius_m * deviation_m));
  const double left_m = deviation_m - eased_inside_m(c.radius_m, c.ease_m);
  const double half = 0.5 * std::min(std::abs(c.deflection_rad), rad_from_deg(175.0));
  const double part = std::min(1.0, left_m / (c.radius_m * (1.0 / std::cos(half) - 1.0)));
  c.radius_m *= part;
  c.tangent_m *= part;
  if (c.tangent_m + 0.5 * c.ease_m <= room_m) return;
  const double shrink = 0.5 * room_m / c.tangent_m;
  if (shrink * c.radius_m < min_radius_m(params.vehicle)) {
    c.ease_m = std::max(0.0, 2.0 * (room_m - c.tangent_m));
    return;
  }
  c.radius_m *= shrink;
  c.tangent_m = 0.5 * room_m;
  c.ease_m = std::min(room_m, c.radius_m * std::abs(c.deflection_rad));
}

/// Where the first arc has to begin, before the corner, for the way to pass it at d. The eased way
/// is off the line by (s + w/2)³/(6·w·R) until w/2 behind that, then by s²/(2·R) + w²/(24·R).
double begins_before_m(double radius_m, double deviation_m, double window_m) noexcept {
  if (deviation_m < window_m * window_m / (6.0 * radius_m)) {
    return std::cbrt(6.0 * window_m * radius_m * deviation_m) - 0.5 * window_m;
  }
  const double d = deviation_m - eased_inside_m(radius_m, window_m);
  return std::sqrt(2.0 * radius_m * d + d * d);
}

/// An arc of radius R that begins t before the corner and turns by θ + β, and an arc back by β that
/// ends on the way out: cos β = (1 + cos θ + (t/R)·sin θ)/2.
/// @return false: there is no room for it.
bool swing(Corner& c, double radius_m, double deviation_m, double in_m, double out_m) noexcept {
  const double theta = std::abs(c.deflection_rad);
  const double t = std::min(radius_m * std::tan(0.5 * std::min(theta, rad_from_deg(175.0))),
                            begins_before_m(radius_m, deviation_m, c.ease_m));
  const double cos_beta = 0.5 * (1.0 + std::cos(theta) + t / radius_m * std::sin(theta));
  const double beta = std::acos(std::clamp(cos_beta, -1.0, 1.0));
  const double ends_m = -t * std::cos(theta) + radius_m * (std::sin(theta) + 2.0 * std::sin(beta));
  if (t + 0.5 * c.ease_m > 0.45 * in_m || ends_m + 0.5 * c.ease_m > 0.5 * out_m) return false;
  c.radius_m = radius_m;
  c.tangent_m = t;
  c.swing_rad = beta < kNoSwing_rad ? 0.0 : std::copysign(beta, c.deflection_rad);
  return true;
}

/// The swing that passes nearest of those for which there is room; without any the corner stays
/// sharp, and the vehicle comes as near as its steering lets it.
void find_swing(Corner& c, std::span<const Vertex, 3> v, double in_m, double out_m,
                const PathParams& params) noexcept {
  const double least_m = min_radius_m(params.vehicle);
  const double full_m = ease_m(least_m, v, params);
  const double farthest_m =
      least_m * (1.0 / std::cos(0.5 * std::min(std::abs(c.deflection_rad), kArcLimit_rad)) - 1.0);
  c.radius_m = c.tangent_m = 0.0;
  for (double d = v[1].deviation_m;; d = std::min(kFarther * d, farthest_m)) {
    for (const double part : {1.0, 0.7, 0.5, 0.3}) {
      c.ease_m = part * full_m;
      const double radius_m = least_m + eased_inside_m(least_m, c.ease_m);
      if (swing(c, radius_m, d, in_m, out_m)) return;
    }
    if (d >= farthest_m) break;
  }
  c.ease_m = 0.0;
}

}  // namespace

double direction_rad(EnuPoint from, EnuPoint to) noexcept {
  return std::atan2(to.north_m - from.north_m, to.east_m - from.east_m);
}

double min_radius_m(const VehicleParams& p) noexcept {
  return p.steered() ? 1.1 * p.wheelbase_m / std::tan(rad_from_deg(p.max_steering_deg)) : 0.0;
}

Corner corner_at(std::span<const Vertex, 3> v, const PathParams& params) noexcept {
  Corner c;
  c.deflection_rad =
      base::angle_diff_rad(direction_rad(v[0].at, v[1].at), direction_rad(v[1].at, v[2].at));
  const double angle = std::abs(c.deflection_rad);
  c.stop = v[1].stop || v[1].reverse != v[2].reverse;
  if (c.stop || angle < kStraight_rad) return c;
  const bool steered = params.vehicle.steered();
  c.stop = c.pivot = !steered && pivots(v[1].turn, angle, params.pivot);
  if (c.stop) return c;
  const double in_m = base::distance_m(v[0].at, v[1].at);
  const double out_m = base::distance_m(v[1].at, v[2].at);
  const double room_m = 0.45 * std::min(in_m, out_m);
  fillet(c, v[1].deviation_m, room_m);
  if (!steered) return c;
  ease_fillet(c, v[1].deviation_m, room_m, v, params);
  if (c.radius_m < min_radius_m(params.vehicle)) find_swing(c, v, in_m, out_m, params);
  return c;
}

double align_rad(const Vertex& at, bool pivot_corner, const PathParams& params) noexcept {
  if (params.vehicle.steered()) return base::kPi;  // it drives an arc, however far off it points
  if (pivot_corner || at.turn == Turn::Pivot) return kAligned_rad;
  const bool arc = at.turn == Turn::Arc || at.turn == Turn::Through;
  return arc ? kArcLimit_rad : rad_from_deg(params.pivot.angle_deg);
}

}  // namespace roverd::nav
