#pragma once
// How fast a laid way is planned to be driven, in few points, to be drawn.
//
//   v │      ●──────────●            set: the item's, or a bend's
//     │     ╱            ╲  ●──●
//     │    ╱              ●      ╲    planned: what speeding up and braking make of it
//     └───●───────────────────────●──▶ s
//
// Between two points the square of the planned speed is a straight line. Pure; linear in the number
// of points of the way, times the doublings of the tolerance.

#include <cstddef>
#include <span>
#include <vector>

#include "nav/track/path.hpp"

namespace roverd::nav {

struct PacePoint {
  EnuPoint at;
  double s_m = 0.0;
  double planned_mps = 0.0;  ///< here; 0 where it stops
  double set_mps = 0.0;      ///< the most from here on to the next point
  int item = 0;              ///< that is driven to from here on
  bool reverse = false;      ///< from here on
};

/// How far what is told may be from the way, and how many points it may take.
struct PaceBounds {
  double within_m = 0.01;
  double within_mps = 0.02;
  std::size_t most = 5'000;  ///< at least 2
};

/// @param items of each vertex of the way, not falling @param speed as it was laid with
/// @return in order; the tolerances are doubled until they are few enough, and where not even that
/// helps the rest of the way is left out
std::vector<PacePoint> pace_of(const Path& path, std::span<const int> items,
                               const SpeedParams& speed, const PaceBounds& bounds);

}  // namespace roverd::nav
