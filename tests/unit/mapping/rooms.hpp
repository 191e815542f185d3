#pragma once
// A plan of straight walls, and a scanner that looks at them.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "nav/chart/scan.hpp"

namespace roverd::nav::mapping {

struct Wall {
  double ax_m = 0.0, ay_m = 0.0, bx_m = 0.0, by_m = 0.0;
};
using Plan = std::vector<Wall>;

inline void add_box(Plan& plan, double x0, double y0, double x1, double y1) {
  plan.insert(plan.end(), {{x0, y0, x1, y0}, {x1, y0, x1, y1}, {x1, y1, x0, y1}, {x0, y1, x0, y0}});
}

/// Two rings of walls with niches and pillars, so that no two places look alike: a way of 72 m
/// around a block.
inline Plan block_of_rooms() {
  Plan plan;
  add_box(plan, -2.0, -2.0, 24.0, 14.0);
  add_box(plan, 2.0, 2.0, 20.0, 10.0);
  add_box(plan, 5.0, -2.0, 6.1, -1.4);
  add_box(plan, 12.5, 1.5, 14.0, 2.0);
  add_box(plan, 23.2, 3.0, 24.0, 5.5);
  add_box(plan, 20.0, 7.2, 20.5, 7.9);
  add_box(plan, 15.0, 13.1, 17.2, 14.0);
  add_box(plan, 8.0, 10.0, 8.6, 10.8);
  add_box(plan, -2.0, 8.0, -1.2, 9.0);
  return plan;
}

inline double range_m(const Plan& plan, double x, double y, double angle_rad) {
  const double dx = std::cos(angle_rad);
  const double dy = std::sin(angle_rad);
  double least = std::numeric_limits<double>::infinity();
  for (const Wall& w : plan) {
    const double ex = w.bx_m - w.ax_m;
    const double ey = w.by_m - w.ay_m;
    const double det = ex * dy - ey * dx;
    if (std::abs(det) < 1e-12) continue;
    const double along = (ex * (w.ay_m - y) - ey * (w.ax_m - x)) / det;
    const double part = (dx * (w.ay_m - y) - dy * (w.ax_m - x)) / det;
    if (along > 0.0 && part >= 0.0 && part <= 1.0) least = std::min(least, along);
  }
  return least;
}

inline double to_wall_m(const Plan& plan, double x, double y) {
  double least = std::numeric_limits<double>::infinity();
  for (const Wall& w : plan) {
    const double ex = w.bx_m - w.ax_m;
    const double ey = w.by_m - w.ay_m;
    const double part = ((x - w.ax_m) * ex + (y - w.ay_m) * ey) / (ex * ex + ey * ey);
    const double at = std::clamp(part, 0.0, 1.0);
    least = std::min(least, std::hypot(x - w.ax_m - at * ex, y - w.ay_m - at * ey));
  }
  return least;
}

/// 270 degrees by one, deviation 1 cm, 20 m.
inline chart::Scan look(const Plan& plan, const sense::Pose2& pose, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.01);
  chart::Scan scan;
  for (int i = -135; i <= 135; ++i) {
    const double angle = i / 57.29577951;
    const double r = range_m(plan, pose.x_m, pose.y_m, pose.yaw_rad + angle) + noise(random);
    const bool hit = r < 20.0;
    const double told = hit ? r : 20.0;
    scan.beams.push_back({static_cast<float>(told * std::cos(angle)),
                          static_cast<float>(told * std::sin(angle)), hit});
  }
  return scan;
}

}  // namespace roverd::nav::mapping
