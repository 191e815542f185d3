#pragma once
// A mounted tool's point, or a trailer's axle, follows the mission's way in place of the vehicle's
// own origin: the way of the vehicle is worked out so that the point keeps to its own.
//
//   tool      ┌───┐ θ            point T = B + f·u(θ) + l·n(θ), u ahead, n to the left
//          T ─┤ B ├──▶  P        T on P with tangent α:   dθ/ds = sin(α − θ)/f
//             └───┘               f > 0: settles as it is driven; f < 0: worked out from its end
//
//   trailer    A ────── H ── B   axle A on P with tangent α: coupling H = P + L·t(α); H is the tool
//              │   L      h      of the vehicle, f = −h
//
// P's curvature jumps at arcs, and with it the direction in which a trailer has to be pulled: it is
// averaged over a window of L first, which puts the way inside of an arc of radius R by L²/(24·R).
// Where the direction changes too sharply for that, a vehicle that turns on the spot drives from
// where one way ends to where the next begins; one with a trailer never turns on the spot, and
// takes bends as a steered vehicle would. Section [nav.tool]. Pure; m, rad.
// Source of the first equation: the tractrix (Leibniz 1693), as any point of a rolling body.

#include "base/params.hpp"
#include "base/result.hpp"
#include "nav/track/path.hpp"

namespace roverd::nav {

/// The same way for the vehicle's origin, leg by leg, and how fast it may be driven. `vertex_m` and
/// the ends of legs are where the *point* is at its vertex or stop. Unchanged without a tool.
/// Invalid: a bend is too narrow for it, or a trailer would have to be pushed; `at_m` is filled
/// with where on the point's way.
base::Result<Path> led_way(const Path& point_way, const PathParams& params, double& at_m);

/// By what the point's way is laid: no bend narrower than the vehicle can make it follow.
PathParams point_params(const PathParams& params);

/// What the vehicle can do while it pulls: with a trailer it does not turn on the spot.
VehicleParams pulling(const VehicleParams& vehicle, const ToolParams& tool) noexcept;

}  // namespace roverd::nav
