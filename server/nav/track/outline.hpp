#pragma once
// A laid way in few points, to be drawn.
//
//   way   ·─·─·─·─·─·─╮·        a point is left out while one direction from the last kept one
//   kept  ●───────────●╲        passes all since within the tolerance; where the way turns back,
//                      ●        its turning point stays
//
// Pure; linear in the number of points, times the doublings of the tolerance.
// Source: Zhao, Saalfeld, "Linear-time sleeve-fitting polyline simplification algorithms",
// AutoCarto 13, 1997.

#include <cstddef>
#include <vector>

#include "nav/track/path.hpp"

namespace roverd::nav {

struct Outline {
  std::vector<EnuPoint> points;  ///< the first and the last of the way among them
  double within_m = 0.0;         ///< no point of the way is farther from it
};

/// @param within_m wanted, more than 0; doubled until at most `most` (at least 2) points are left
Outline outline(const Path& path, double within_m, std::size_t most);

}  // namespace roverd::nav
