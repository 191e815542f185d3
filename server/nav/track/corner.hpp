#pragma once
// How a corner of the wanted way is driven: straight through, on an arc, by turning on the spot,
// or, by a vehicle that cannot turn so narrowly, with a swing to the outside:
//
//       arc: cuts the corner            swing: passes near the corner, then comes back to the line
//      ─────╮                                   ╭──╮ β
//           │  ↕ deviation             ────────╱─ V ╲
//           V                                  R     │
//           │                                        ╲│  counter-arc, tangent to the way out
//           ▼                                         ▼
//
// A steered vehicle's curvature comes and goes over a window (nav/track/ease.hpp) that its wheels
// have the time to turn in. Where there is no room for a swing that passes as near as allowed, it
// passes farther off, at last on a mere arc. Pure. Angles rad, left positive; lengths m.

#include <span>

#include "nav/track/path.hpp"

namespace roverd::nav {

struct Corner {
  double deflection_rad = 0.0;
  bool stop = false;
  bool pivot = false;      ///< the stop is for turning on the spot
  double radius_m = 0.0;   ///< 0: neither arc nor swing
  double tangent_m = 0.0;  ///< the arc begins so far before the corner
  double swing_rad = 0.0;  ///< not 0: the arc goes on by β beyond the new direction, and back by β
  double ease_m = 0.0;     ///< the window over which its curvature changes; 0: at once
};

/// Yaw of the way from one point to another.
double direction_rad(EnuPoint from, EnuPoint to) noexcept;

inline bool turning_on_the_spot(const VehicleParams& p) noexcept {
  return !p.steered();
}

/// Narrowest turn that the steering allows, with a tenth left to steer with; 0: turns on the spot.
double min_radius_m(const VehicleParams& p) noexcept;

/// @param v three different vertices in a row.
Corner corner_at(std::span<const Vertex, 3> v, const PathParams& params) noexcept;

/// How far off the robot may point when it leaves a stop without turning on the spot first.
double align_rad(const Vertex& at, bool pivot_corner, const PathParams& params) noexcept;

}  // namespace roverd::nav
