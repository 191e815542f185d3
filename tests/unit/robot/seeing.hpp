#pragma once
// A robot that looks around: tests say what stands there, and whether its sensor sees.

#include <cmath>
#include <memory>
#include <optional>

#include "field.hpp"
#include "robot/guard/guard.hpp"

namespace roverd::robot {

using nav::sense::Known;

/// The ground around the robot: all seen and free, but what a test puts there.
class Seeing : public ::testing::Test {
 protected:
  Seeing() {
    field.robot.guard_by({});
    field.more = [this] { look(); };
  }

  /// A wall across the way, so far ahead of where the robot was at the begin; 1 m thick.
  void wall_at(double north_m) { wall_m = north_m; }

  void look() {
    std::vector<nav::sense::Odometry> moved;
    field.robot.odometry().take(moved);
    for (const auto& o : moved) pose = o.pose;
    if (!sees) return;
    auto s = std::make_shared<Surroundings>();
    s->patch.stamp = field.now;
    s->patch.side = 280;
    s->patch.x0 = static_cast<std::int32_t>(std::floor(pose.x_m / 0.05)) - 140;
    s->patch.y0 = static_cast<std::int32_t>(std::floor(pose.y_m / 0.05)) - 140;
    s->patch.cells.assign(280 * 280, {seen, 0, 0});
    if (wall_m) {
      for (std::int32_t y = 0; y < 280; ++y) {
        for (std::int32_t x = 0; x < 280; ++x) {
          const double ahead_m = (s->patch.x0 + x) * 0.05;
          if (ahead_m < *wall_m || ahead_m > *wall_m + 1.0) continue;
          if (std::abs((s->patch.y0 + y) * 0.05 - wall_mid_m) > 0.5 * wall_wide_m) continue;
          s->patch.cells[std::size_t(y * 280 + x)].known = wall_is;
        }
      }
    }
    if (walker) {
      nav::sense::Mover m = *walker;
      m.at = m.at + base::seconds(field.now - m.seen) * m.v_mps;
      m.seen = field.now;
      s->movers.push_back(m);
    }
    base::SensorState state;
    state.name = "front";
    state.kind = "velodyne";
    state.health = health;
    state.reason = "the glass is blocked";
    if (!heard) state.health = base::SensorHealth::Silent;
    if (heard) state.seen = s->seen = field.now;
    s->rays = rays;
    s->row = row;
    s->sensors = std::make_shared<const std::vector<base::SensorState>>(1, state);
    field.robot.surroundings().put(std::move(s));
  }

  /// From the origin of the body to the wall, less half of the body.
  double gap_m() const { return *wall_m - 0.5 * VehicleLength - driven_m(); }
  double driven_m() const { return field.at.north_m; }

  static constexpr double VehicleLength = 1.023;
  static constexpr double VehicleWidth = 0.778;
  Field field;
  bool sees = true;
  bool heard = true;
  Known seen = Known::Free;
  base::SensorHealth health = base::SensorHealth::Good;
  std::optional<double> wall_m;
  double wall_wide_m = 1e3;
  double wall_mid_m = 0.0;  ///< of it, to the left
  Known wall_is = Known::Occupied;
  std::optional<RowSeen> row;               ///< what is seen of the row that was asked for
  std::optional<nav::sense::Mover> walker;  ///< as he was at `seen`, in the odometry's frame
  std::optional<RaysStop> rays;             ///< what the stop by counted rays says
  nav::sense::Pose2 pose;
};

}  // namespace roverd::robot
