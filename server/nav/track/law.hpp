#pragma once
// Steering laws: from where the vehicle is beside its path to the curvature it should drive.
//
//   e > 0: left of the path     ψe: heading minus the path's     κ: of the path     all of the end
//   that leads (reversing, the tail)
//
// path_frame    κ_cmd = κ·cos ψe/(1 − κ·e) − (2ζ/L)·(sin ψe + q),  q = e/(2ζL) within ±1/2
//               A linear oscillator over the way: natural frequency 1/L per metre, damping ζ. The
//               limit of q makes the path be approached at 30° at most. Pointing away by more than
//               90° it turns as hard as at 90°. Source: Samson 1995; Kanayama et al. 1990.
// pure_pursuit  κ_cmd = 2y/D² to a point at distance D ahead on the path. Source: Coulter 1992.
// stanley       δ = −ψe − atan(g·e_f/(v + 0.5)), κ_cmd = κ + tan δ/wheelbase, e_f at the front
// axle.
//               Source: Hoffmann et al. 2007.
//
// Pure, SI, radians.

#include <optional>
#include <string_view>

#include "nav/track/params.hpp"

namespace roverd::nav {

enum class TrackLaw { PathFrame, PurePursuit, Stanley };

/// Empty: no such word.
std::optional<TrackLaw> law_from(std::string_view word) noexcept;

/// The leading end beside its path.
struct BesidePath {
  double cross_m = 0.0;
  double heading_rad = 0.0;    ///< (−π, π]
  double curvature_1pm = 0.0;  ///< of the path, where the command acts
  double speed_mps = 0.0;      ///< >= 0
  double calm = 1.0;           ///< >= 1: so much longer the way back may be
};

/// How much calmer to steer for a heading that is not known well: what looks like an error of
/// direction is then the compass's. 1 to 2.5.
double calm_of(double yaw_sigma_rad, double known_sigma_rad) noexcept;

/// L of the path-frame law: not less than what the delay lets be stable.
double settle_length_m(double speed_mps, const TrackParams& p) noexcept;

/// How far the heading is from the direction in which the path should be approached. (−π, π]
double course_error_rad(double cross_m, double heading_rad, double settle_m,
                        double damping) noexcept;

double path_frame_1pm(const BesidePath& at, const TrackParams& p) noexcept;

/// @param wheelbase_m a skid-steer: how far ahead of its centre its front is taken to be.
double stanley_1pm(const BesidePath& at, double wheelbase_m, const TrackParams& p) noexcept;

}  // namespace roverd::nav
