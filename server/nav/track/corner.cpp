#include "nav/track/corner.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using mission::Turn;

const double kStraight_rad = rad_from_deg(2.0);
const double kArcLimit_rad = rad_from_deg(150.0);
const double kAligned_rad = rad_from_deg(5.0);

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

/// An arc of radius R that begins t before the corner passes it at √(R² + t²) − R; t is such that
/// this is the deviation. It turns by θ + β, and an arc back by β ends on the way out:
/// cos β = (1 + cos θ + (t/R)·sin θ)/2. Without room for it the corner stays sharp, and the vehicle
/// comes as near as its steering lets it.
void swing(Corner& c, double radius_m, double deviation_m, double in_m, double out_m) noexcept {
  const double theta = std::abs(c.deflection_rad);
  const double t = std::min(radius_m * std::tan(0.5 * std::min(theta, rad_from_deg(175.0))),
                            std::sqrt(2.0 * radius_m * deviation_m + deviation_m * deviation_m));
  const double cos_beta = 0.5 * (1.0 + std::cos(theta) + t / radius_m * std::sin(theta));
  const double beta = std::acos(std::clamp(cos_beta, -1.0, 1.0));
  const double ends_m = -t * std::cos(theta) + radius_m * (std::sin(theta) + 2.0 * std::sin(beta));
  c.radius_m = c.tangent_m = 0.0;
  if (t > 0.45 * in_m || ends_m > 0.5 * out_m) return;
  c.radius_m = radius_m;
  c.tangent_m = t;
  c.swing_rad = std::copysign(beta, c.deflection_rad);
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
  fillet(c, v[1].deviation_m, 0.45 * std::min(in_m, out_m));
  const double least_m = min_radius_m(params.vehicle);
  if (c.radius_m < least_m) swing(c, least_m, v[1].deviation_m, in_m, out_m);
  return c;
}

double align_rad(const Vertex& at, bool pivot_corner, const PathParams& params) noexcept {
  if (params.vehicle.steered()) return base::kPi;  // it drives an arc, however far off it points
  if (pivot_corner || at.turn == Turn::Pivot) return kAligned_rad;
  const bool arc = at.turn == Turn::Arc || at.turn == Turn::Through;
  return arc ? kArcLimit_rad : rad_from_deg(params.pivot.angle_deg);
}

}  // namespace roverd::nav
