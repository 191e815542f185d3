#pragma once
// How fast each place of a path may be driven, and how long the whole takes.
//
//   v │   item ─────────╮           ╭──────────╮
//     │  ╱ forward      │ bend      │          │╲ backward
//     │ ╱               ╰───────────╯          │ ╲
//     └─────────────────────────────────────────────▶ s
//
// Limits of a bend of curvature κ: lateral acceleration √(a/κ), turn rate 0.7·w/κ (the rest is for
// steering). Of a steered vehicle besides: its wheels must turn no faster than 0.7 of what they
// can, v·dδ/ds with tan δ = wheelbase·κ. Pure.

#include "nav/track/path.hpp"
#include "nav/track/rules.hpp"

namespace roverd::nav {

/// Of the steering rate; the rest is for steering back to the way.
inline constexpr double kSteeringShare = 0.85;

/// @param curvature_1pm > 0.
SpeedLimit bend_limit(double curvature_1pm, const PathParams& params) noexcept;

/// Cuts segment_mps of a steered vehicle's path where its wheels would have to turn too fast.
void limit_steering(Path& path, const PathParams& params) noexcept;

/// Fills speed_mps, reason (backward pass: v_i² = v_{i+1}² + 2·a·ds at most), plan_mps (forward
/// pass) and plan_s of all points.
void plan_speeds(Path& path, const PathParams& params) noexcept;

}  // namespace roverd::nav
