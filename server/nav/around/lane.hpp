#pragma once
// The route as far as the window reaches, asked by distance along it and by nearness.

#include <cstddef>
#include <span>
#include <vector>

#include "nav/sense/footprint.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::around {

using sense::Pose2;
using sense::Vec2;

/// Where a point is, seen from the route.
struct Beside {
  double along_m = 0.0;
  double left_m = 0.0;  ///< of it
  double distance_m = 0.0;
};

/// A polyline without needless points; distances along it are those of the polyline it was made of.
class Lane {
 public:
  struct Point {
    Vec2 at;
    double along_m = 0.0;
  };
  static constexpr double kStraight_m =
      0.01;  ///< points nearer than this to a straight are left out

  void lay(std::span<const Vec2> route);

  bool empty() const noexcept { return points_.size() < 2; }
  std::span<const Point> points() const noexcept { return points_; }
  double end_m() const noexcept { return points_.back().along_m; }
  Vec2 at(double along_m) const noexcept;
  /// Pointing along it, corners within 5 cm evened out.
  Pose2 pose(double along_m) const noexcept;
  /// To segment i, from points()[i] on.
  Beside beside(Vec2 p, std::size_t i) const noexcept;
  /// The nearest place at all.
  Beside beside(Vec2 p) const noexcept;

 private:
  std::size_t segment(double along_m) const noexcept;

  std::vector<Point> points_;
  std::vector<Point> all_;
  std::vector<std::pair<std::size_t, std::size_t>> open_;
  std::vector<bool> kept_;
};

}  // namespace roverd::nav::around
