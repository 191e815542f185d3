#include "sim/ground.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "sim/noise.hpp"

namespace roverd::sim {
namespace {

constexpr double kGroundGravity_mps2 = 9.81;
constexpr double kRutRadius_m = 0.5;
/// Something always brakes: the motors' speed loop is stronger than a robot's weight.
constexpr double kLeastShare = 0.2;

enum Layer { kSlipPatches = 1, kCrabPatches, kRutEast, kRutNorth, kRutTurn, kTrees };

/// [0, 1) of one knot of the grid.
double knot(std::uint64_t seed, int layer, double column, double row) {
  const auto number = [](double whole) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
  };
  const std::uint64_t place = mix(mix(number(column)) + number(row));
  return static_cast<double>(mix(mix(seed + static_cast<std::uint64_t>(layer)) ^ place) >> 11) *
         0x1.0p-53;
}

/// rad for each metre of way. Ruts are round places, one in each square of such a size that a
/// straight way meets one every rut_every_m.
double rut_at(const GroundParams& p, std::uint64_t seed, base::EnuPoint at) {
  const double side_m = std::sqrt(2.0 * kRutRadius_m * p.rut_every_m);
  double sum = 0.0;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const double column = std::floor(at.east_m / side_m) + i;
      const double row = std::floor(at.north_m / side_m) + j;
      const double east_m = (column + knot(seed, kRutEast, column, row)) * side_m;
      const double north_m = (row + knot(seed, kRutNorth, column, row)) * side_m;
      const double off = std::hypot(at.east_m - east_m, at.north_m - north_m) / kRutRadius_m;
      if (off >= 1.0) continue;
      const double turn = 2.0 * knot(seed, kRutTurn, column, row) - 1.0;
      sum += base::rad_from_deg(p.rut_dps) * turn * (1.0 - off * off);
    }
  }
  return sum;
}

double sign_of(double value) {
  return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0;
}

}  // namespace

double field_at(std::uint64_t seed, int layer, base::EnuPoint at, double patch_m) {
  const double column = std::floor(at.east_m / patch_m);
  const double row = std::floor(at.north_m / patch_m);
  const auto eased = [](double share) { return share * share * (3.0 - 2.0 * share); };
  const double across = eased(at.east_m / patch_m - column);
  const double up = eased(at.north_m / patch_m - row);
  const double below =
      std::lerp(knot(seed, layer, column, row), knot(seed, layer, column + 1.0, row), across);
  const double above = std::lerp(knot(seed, layer, column, row + 1.0),
                                 knot(seed, layer, column + 1.0, row + 1.0), across);
  return std::lerp(below, above, up);
}

Footing footing_at(const Params& p, std::uint64_t seed, base::EnuPoint at, double yaw_rad) {
  const GroundParams& g = p.ground;
  Footing f;
  if (g.slope_deg > 0.0) {
    // H: level, with the body's yaw. The plane rises by `steep` a metre towards uphill.
    const double steep = std::tan(base::rad_from_deg(g.slope_deg));
    const double uphill_rad = base::yaw_from_heading(g.uphill_deg);
    f.ahead = steep * std::cos(uphill_rad - yaw_rad);
    f.leftward = steep * std::sin(uphill_rad - yaw_rad);
    f.pitch_rad = std::atan(f.ahead);
    f.roll_rad = std::atan(f.leftward * std::cos(f.pitch_rad));
    f.height_m = steep * (at.east_m * std::cos(uphill_rad) + at.north_m * std::sin(uphill_rad));
  }
  if (g.slip_patches > 0.0) {
    const double half_m = p.drive.track_width_m / 2.0;
    const double east_m = -half_m * std::sin(yaw_rad);
    const double north_m = half_m * std::cos(yaw_rad);
    const auto slip = [&](base::EnuPoint track) {
      return g.slip_patches * field_at(seed, kSlipPatches, track, g.patch_m);
    };
    f.left_slip = slip({at.east_m + east_m, at.north_m + north_m});
    f.right_slip = slip({at.east_m - east_m, at.north_m - north_m});
  }
  if (g.crab_patches > 0.0) {
    f.crab = g.crab_patches * (2.0 * field_at(seed, kCrabPatches, at, g.patch_m) - 1.0);
  }
  if (g.rut_dps > 0.0) f.rut_rad = rut_at(g, seed, at);
  return f;
}

Footing on_ground(Footing f, const Lie& lie) {
  f.ahead = lie.ahead;
  f.leftward = lie.leftward;
  f.pitch_rad = std::atan(f.ahead);
  f.roll_rad = std::atan(f.leftward * std::cos(f.pitch_rad));
  f.height_m = lie.height_m;
  return f;
}

bool under_trees(const TreesParams& p, std::uint64_t seed, base::EnuPoint at) {
  return p.share > 0.0 && field_at(seed, kTrees, at, p.patch_m) >= 1.0 - p.share;
}

DriveParams drive_on(const DriveParams& p, const GroundParams& ground, const Footing& footing,
                     double speed_mps) {
  DriveParams d = p;
  d.slip_left += footing.left_slip;
  d.slip_right += footing.right_slip;
  d.mass_kg *= p.payload;
  for (double* limit : {&d.turn_accel_radps2, &d.turn_decel_radps2}) *limit /= p.payload;
  const double uphill_mps2 =
      ground.gravity_share * kGroundGravity_mps2 * std::sin(footing.pitch_rad) * sign_of(speed_mps);
  const auto on_slope = [&](double& limit_mps2, double gain_mps2) {
    limit_mps2 /= p.payload;
    if (gain_mps2 != 0.0) limit_mps2 = std::max(kLeastShare * limit_mps2, limit_mps2 + gain_mps2);
  };
  on_slope(d.accel_mps2, -uphill_mps2);
  on_slope(d.decel_mps2, uphill_mps2);
  on_slope(d.estop_decel_mps2, uphill_mps2);
  return d;
}

GroundMotion slid(GroundMotion wanted, const Params& p, const Footing& footing, double travel_mps) {
  const double crab = p.drive.crab + footing.crab;
  const double downhill_mps = p.ground.slide * travel_mps;
  GroundMotion out = wanted;
  out.twist.angular_radps += footing.rut_rad * wanted.twist.linear_mps;
  out.twist.linear_mps -= downhill_mps * footing.ahead;
  out.lateral_mps -= downhill_mps * footing.leftward + crab * std::abs(wanted.twist.linear_mps);
  if (footing.pitch_rad != 0.0) out.twist.linear_mps *= std::cos(footing.pitch_rad);
  if (footing.roll_rad != 0.0) out.lateral_mps *= std::cos(footing.roll_rad);
  return out;
}

}  // namespace roverd::sim
