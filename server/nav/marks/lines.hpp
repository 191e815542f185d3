#pragma once
// Straight pieces of a planar scan.
//
//   runs        neighbours within jump_m of each other
//   corners     a run is split where it lies farthest from the line between its ends, while that is
//               more than split_m (iterative end point fit)
//   fit         total least squares over a piece's points, twice without those farther off than
//               2.5 times their rms
//
// Total least squares: the line goes through the centroid along the larger axis of the scatter;
// σ of the direction is rms / (√n · spread along). Source: J. Weingarten et al.; any textbook.
//
// Pure; O(n log n). Frame: that of the points.

#include <vector>

#include "nav/marks/params.hpp"
#include "nav/marks/scan.hpp"

namespace roverd::nav::marks {

/// Sums over points, with which lines are fitted, joined and faded. About an origin of its own, so
/// that far away from O nothing is lost.
struct Moments {
  Vec2 origin{};
  double n = 0.0;
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(Vec2 p) noexcept;
  void add(const Moments& other) noexcept;
  void fade(double by) noexcept;
};

struct Fit {
  Vec2 centre{};
  Vec2 along{1.0, 0.0};   ///< of length 1
  double rms_m = 0.0;     ///< beside the line
  double spread_m = 0.0;  ///< rms along it
};
/// @param m of two different points at least; else the fit is of no length.
Fit fit_of(const Moments& m) noexcept;

struct Line {
  Vec2 from{};  ///< ends, in the order of the scan, on the fitted line
  Vec2 to{};
  Vec2 normal{};  ///< of length 1, to the side of the sensor
  double rms_m = 0.0;
  double sigma_m = 0.0;    ///< 1σ of its middle, beside the line
  double sigma_rad = 0.0;  ///< 1σ of its direction
  std::size_t points = 0;
  Moments moments{};
  bool from_open = false;  ///< nobody looked beyond that end: the wall may go on there
  bool to_open = false;

  double length_m() const noexcept;
  /// From a point to the line without ends, positive on the sensor's side.
  double distance_m(Vec2 p) const noexcept { return sense::dot(normal, p - from); }
};

/// @return in the order of the scan.
std::vector<Line> lines_of(const PlanarScan& scan, const WallParams& params);

}  // namespace roverd::nav::marks
