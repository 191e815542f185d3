#pragma once
// Where in a window, or in the whole map, a scan fits: every place and heading is looked at, most
// of them many at a time.
//
// Branch and bound over squares of places: the field's levels say how well a point can fit at best
// anywhere in a square, so squares that cannot beat what was found are left alone. The result is
// the one that trying every cell and heading would give.
// Source: Hess, Kohler, Rapp, Andor, Real-time loop closure in 2D lidar SLAM, ICRA 2016.
//
// Frame G; poses X_GB. Pure; work is bounded by `most_looks`.

#include <cstdint>
#include <span>
#include <vector>

#include "nav/place/match.hpp"

namespace roverd::nav::place {

struct Found {
  Pose2 pose;
  double fit = 0.0;  ///< mean fit of the points, 0 to 1, less what the prior takes
};

struct WindowParams {
  double half_m = 0.45;
  double half_rad = 0.42;  ///< 24 deg
  double step_rad = 0.02;  ///< between headings
  /// Taken off the fit at the edge of the window, growing with the square: among alike places the
  /// one in the middle.
  double edge_cost = 0.05;
};

/// The best place around a pose. @param points a few dozen. @return the middle itself when nothing
/// fits at all.
Found search_window(const Field& field, std::span<const Point> points, const Pose2& middle,
                    const WindowParams& p = {});

struct WholeParams {
  double step_rad = 0.0175;  ///< 1 deg
  double least_fit = 0.35;   ///< worse is not looked for
  double below_best = 0.20;  ///< fits as far below the best are alternatives
  double apart_m = 0.5;      ///< nearer to a better one in place and heading is no alternative
  double apart_rad = 0.25;
  std::size_t most = 40;                 ///< alternatives
  std::uint64_t most_looks = 6'000'000;  ///< squares; then what was found so far is told
};

struct Whole {
  std::vector<Found> found;  ///< best first
  bool complete = true;      ///< false: the work was cut short
};

/// All places of the map where the points fit nearly as well as anywhere.
Whole search_whole(const Field& field, std::span<const Point> points, const WholeParams& p = {});

}  // namespace roverd::nav::place
