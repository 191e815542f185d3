#pragma once
// Driving on a slope: how fast, how it brakes, whether it may turn on the spot, when it would roll
// over. Section [nav.slope]; the vehicle's share of it in [vehicle]. Pure, SI, radians.
//
//            ╱│ h   mass_height_m             rolls over beyond   atan(w/2h)
//           ╱ ●                               braking downhill    a − k·g·sin(pitch)
//        ──────────  w  support_width_m
//
// Lean: between the body's up and the vertical, whichever way. Pitch: nose up positive; roll: right
// side down positive.

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/params.hpp"
#include "nav/track/params.hpp"

namespace roverd::nav {

struct SlopeParams {
  double free_deg = 6.0;
  double creep_deg = 20.0;
  double pivot_deg = 15.0;
  double brake_share = 0.3;
  double roll_over_share = 0.6;
};

template <class V>
void fields(V& v, SlopeParams& p) {
  v("free_deg", p.free_deg, 0.0, 45.0,
    base::lower_is_stricter("up to this lean, whichever way, a slope makes nothing slower"));
  v("creep_deg", p.creep_deg, 1.0, 60.0,
    base::lower_is_stricter("from this lean on it creeps; in between the speed falls evenly"));
  v("pivot_deg", p.pivot_deg, 0.0, 60.0,
    base::lower_is_stricter("no turn on the spot where the ground leans more: slight turns are "
                            "driven as arcs, before others it pauses"));
  v("brake_share", p.brake_share, 0.0, 1.0,
    base::higher_is_stricter("of g times the sine of the pitch, that is missing from braking "
                             "downhill; 0: the drives hold against all of it"));
  v("roll_over_share", p.roll_over_share, 0.1, 1.0,
    base::lower_is_stricter("of the roll at which it would tip over: beyond, it holds"));
}

inline constexpr double kGravity_mps2 = 9.81;

/// Between the body's up and the vertical, [0, π].
inline double lean_rad(double roll_rad, double pitch_rad) noexcept {
  return std::acos(std::clamp(std::cos(roll_rad) * std::cos(pitch_rad), -1.0, 1.0));
}

/// The roll at which a standing vehicle tips over: w/2 over h.
inline double tips_over_rad(const VehicleParams& v) noexcept {
  return std::atan2(0.5 * v.support_width_m, v.mass_height_m);
}

/// The roll that is allowed.
inline double most_roll_rad(const VehicleParams& v, const SlopeParams& p) noexcept {
  return p.roll_over_share * tips_over_rad(v);
}

/// From full speed at free_deg to creep_mps at creep_deg. @param full_mps of the way, the item.
inline double slope_mps(double lean_rad, double full_mps, double creep_mps,
                        const SlopeParams& p) noexcept {
  const double from = base::rad_from_deg(p.free_deg);
  const double to = std::max(from + 1e-3, base::rad_from_deg(p.creep_deg));
  const double part = std::clamp((lean_rad - from) / (to - from), 0.0, 1.0);
  const double least_mps = std::min(creep_mps, full_mps);
  return full_mps - part * (full_mps - least_mps);
}

/// Braking that is there. @param down_rad the way goes down by, of where it drives.
/// At least a quarter of what the level has: below that no way is long enough to plan with.
inline double slope_decel_mps2(double decel_mps2, double down_rad, const SlopeParams& p) noexcept {
  const double pull_mps2 = p.brake_share * kGravity_mps2 * std::sin(std::max(0.0, down_rad));
  return std::max(0.25 * decel_mps2, decel_mps2 - pull_mps2);
}

/// Sideways acceleration that is left of lateral_mps2 until the allowed roll: on a side slope a
/// bend away from it pushes the same way. @param roll_rad as it stands
inline double slope_lateral_mps2(double lateral_mps2, double roll_rad, const VehicleParams& v,
                                 const SlopeParams& p) noexcept {
  const double most = most_roll_rad(v, p);
  const double left_rad = std::max(0.0, most - std::abs(roll_rad));
  const double until_mps2 = kGravity_mps2 * std::tan(std::min(left_rad, 1.2));
  return std::clamp(until_mps2, 0.1 * lateral_mps2, lateral_mps2);
}

}  // namespace roverd::nav
