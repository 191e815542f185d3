#pragma once
// Buildings of straight walls for tests: drawn into a map, and seen by a scanner whose rays meet
// the walls themselves, not the cells.

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "base/angle.hpp"
#include "nav/chart/map.hpp"
#include "nav/chart/scan.hpp"
#include "nav/place/field.hpp"

namespace roverd::tests {

using nav::sense::Pose2;

struct Segment {
  double ax_m = 0.0, ay_m = 0.0, bx_m = 0.0, by_m = 0.0;
};

//   12 m x 8 m, no two corners alike:
//   +-----------------+-------+
//   |                 |       |
//   |    #                    |
//   |                 |   +---|
//   |  ##             |       |
//   +-------+  +------+-------+
inline std::vector<Segment> shed() {
  return {{0, 0, 5, 0},   {6.5, 0, 12, 0},    {12, 0, 12, 8},    {12, 8, 0, 8},
          {0, 8, 0, 0},   {8, 0, 8, 4},       {8, 5.2, 8, 8},    {10, 3, 12, 3},
          {2, 5, 2.6, 5}, {2.6, 5, 2.6, 5.5}, {1, 1.5, 2.4, 1.9}};
}
inline std::vector<Segment> other_building() {
  return {{0, 0, 9, 0},       {9, 0, 9, 3.4}, {9, 3.4, 4.2, 3.4}, {4.2, 3.4, 4.2, 7.7},
          {4.2, 7.7, 0, 7.7}, {0, 7.7, 0, 0}, {3, 1, 3.4, 1.8}};
}

inline nav::chart::OccupancyMap drawn(const std::vector<Segment>& walls, double width_m,
                                      double height_m) {
  constexpr double kMargin_m = 1.0;
  constexpr double kCell_m = 0.05;
  const auto cells = [&](double m) {
    return static_cast<std::int32_t>((m + 2.0 * kMargin_m) / kCell_m);
  };
  auto map = nav::chart::OccupancyMap::make(
      {cells(width_m), cells(height_m), kCell_m, {-kMargin_m, -kMargin_m, 0.0}}, nav::chart::kFree);
  for (const Segment& s : walls) {
    const double length = std::hypot(s.bx_m - s.ax_m, s.by_m - s.ay_m);
    for (double d = 0.0; d <= length; d += 0.01) {
      const double part = d / length;
      const auto cell = map->cell_of(s.ax_m + part * (s.bx_m - s.ax_m) + 1e-6,
                                     s.ay_m + part * (s.by_m - s.ay_m) + 1e-6);
      map->set(*cell, nav::chart::kOccupied);
    }
  }
  return std::move(*map);
}

/// To the nearest wall along a ray; 0: none.
inline double range_m(const std::vector<Segment>& walls, double x_m, double y_m, double angle_rad) {
  const double ux = std::cos(angle_rad);
  const double uy = std::sin(angle_rad);
  double nearest = 0.0;
  for (const Segment& s : walls) {
    const double wx = s.bx_m - s.ax_m;
    const double wy = s.by_m - s.ay_m;
    const double across = ux * wy - uy * wx;
    if (std::abs(across) < 1e-12) continue;
    const double qx = s.ax_m - x_m;
    const double qy = s.ay_m - y_m;
    const double t = (qx * wy - qy * wx) / across;
    const double u = (qx * uy - qy * ux) / across;
    if (t > 0.02 && u >= 0.0 && u <= 1.0 && (nearest == 0.0 || t < nearest)) nearest = t;
  }
  return nearest;
}

/// 270 deg, 1 deg apart, 1 cm of noise, as far as 20 m.
class Scanner {
 public:
  explicit Scanner(std::uint32_t seed) : random_(seed) {}

  nav::chart::Scan look(const std::vector<Segment>& walls, const Pose2& at, double time_s) {
    nav::chart::Scan scan;
    scan.stamp = base::Time{} + base::from_seconds(time_s);
    std::normal_distribution<double> noise(0.0, 0.01);
    for (int i = -135; i <= 135; ++i) {
      const double angle = base::rad_from_deg(i);
      const double range = range_m(walls, at.x_m, at.y_m, at.yaw_rad + angle);
      if (range <= 0.0 || range > 20.0) continue;
      const double seen = range + noise(random_);
      scan.beams.push_back({static_cast<float>(seen * std::cos(angle)),
                            static_cast<float>(seen * std::sin(angle)), true});
    }
    return scan;
  }

 private:
  std::mt19937 random_;
};

inline std::shared_ptr<const nav::place::Field> field_of(const std::vector<Segment>& walls,
                                                         double width_m, double height_m) {
  return std::make_shared<nav::place::Field>(drawn(walls, width_m, height_m));
}

}  // namespace roverd::tests
