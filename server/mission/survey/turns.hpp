#pragma once
// Turns of a vehicle that cannot turn on the spot. Pure.

#include <functional>
#include <vector>

#include "base/geo.hpp"

namespace roverd::mission::survey {

using base::EnuPoint;

struct Pose {
  EnuPoint at;
  double yaw_rad = 0.0;  ///< any finite angle
};

struct TurnPoint {
  EnuPoint at;
  bool reverse = false;  ///< driven backwards to here
};

/// Ways from one pose to another, shortest first, without the pose they begin at: those of at most
/// two arcs and a straight or three arcs (L. E. Dubins 1957; formulas: A. M. Shkel, V. Lumelsky
/// 2001), and where the poses look in opposite directions the fishtail: arc, backwards, arc.
///
///      ╭───╮        ╭──╮           ───╮ ╭───
///      │   │       (    )             │ │      fishtail: less room ahead
///      a   b        a  b           a──╯ ╰──b
///
/// @param radius_m > 0. @param step_m along the arcs, > 0
std::vector<std::vector<TurnPoint>> turns_between(const Pose& a, const Pose& b, double radius_m,
                                                  double step_m);

/// Where none of those has room: with straight pieces before and behind them, either way, and the
/// arcs forwards or backwards.
///
///     │   ╭──╮   │ border      back from a, two arcs, on along b's way, back to b
///     │  a   │   │
///     │  ↓   ↓b  │
///
/// @param fits is asked about the cheapest ones first: a change of direction costs as much as three
/// radii of way. @return the first that fits; empty: none
std::vector<TurnPoint> turn_reversing(
    const Pose& a, const Pose& b, double radius_m, double step_m,
    const std::function<bool(const std::vector<TurnPoint>&)>& fits);

}  // namespace roverd::mission::survey
