#pragma once
// How fast each place of a path may be driven, and how long the whole takes.
//
//   v │   item ─────────╮           ╭──────────╮
//     │  ╱ forward      │ bend      │          │╲ backward
//     │ ╱               ╰───────────╯          │ ╲
//     └─────────────────────────────────────────────▶ s
//
// Limits of a bend of curvature κ: lateral acceleration √(a/κ), turn rate 0.7·w/κ (the rest is for
// steering), and, of a steered vehicle, the deviation that its steering rate costs where the bend
// begins: the wheels need t for it, which bends the way by v²·κ·t²/24. Pure.

#include "nav/track/path.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {

/// How long the vehicle takes into a bend: of a steered one, from lock to lock, as one arc may
/// follow another. The tracker begins half of it early.
double bend_onset_s(const VehicleParams& vehicle) noexcept;

/// @param curvature_1pm > 0.
SpeedLimit bend_limit(double curvature_1pm, const PathParams& params) noexcept;

/// Fills speed_mps, reason (backward pass: v_i² = v_{i+1}² + 2·a·ds at most), plan_mps (forward
/// pass) and plan_s of all points.
void plan_speeds(Path& path, const PathParams& params) noexcept;

}  // namespace roverd::nav
