#pragma once
// Other people's paths: dense points, moved by noise, are driven as the smooth way that they are.
//
//   vertices ─▶ pieces between what must be met ─▶ curve of each ─▶ way: curves, and corners
//
// A piece ends at a stop, an item that asks for its turn, a change of direction, a long leg (into
// which it leads tangentially) and a corner: a turn that no bend within the tolerance and drivable
// with some speed makes. What could not be kept within the tolerance stays as it was given.
// Beside one or two of many points (0.15 m apart or less) that noise threw out, while their
// neighbours keep to it, the tolerance is 1.4 times as large (FitLimits).
// Pure. A second for 100,000 vertices.

#include <cstddef>
#include <span>
#include <vector>

#include "nav/track/path.hpp"

namespace roverd::nav {

/// A point of the way that is laid.
struct WayPoint {
  Vertex vertex;               ///< what it leads to, moved to this place
  double curvature_1pm = 0.0;  ///< of the way from here to the next point; left positive
  bool on_curve = false;       ///< inside of a curve: neither corner nor stop
};

struct SmoothedWay {
  struct Passed {
    std::size_t point = 0;  ///< this one, or
    double part = 0.0;      ///< so much of the way to the next one beyond it
  };
  std::vector<WayPoint> points;
  std::vector<Passed> passed;  ///< by vertex
  std::vector<SmoothStretch> stretches;
};

/// @param vertices neighbours are at least 1 mm apart. Those that may be passed beside (Vertex::
/// dense) and whose legs are short are smoothed, within params.track.smooth_m; 0: none.
SmoothedWay smoothed_way(std::span<const Vertex> vertices, const PathParams& params);

}  // namespace roverd::nav
