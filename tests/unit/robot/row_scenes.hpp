#pragma once
// Scenes of a robot that drives along rows of plants: what the parameters of rows may change shows
// in one of them.

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "seeing_scenes.hpp"

namespace roverd::robot {

/// Bushes to both sides of a lane that the robot does not quite point along, and its scanner.
struct Hedges {
  struct Bush {
    double x_m, y_m, radius_m;
  };
  static constexpr double kTurned_rad = 0.12;
  static constexpr double kHalf_m = 1.2;
  static constexpr double kClear_m = 8.0;
  std::vector<Bush> bushes;
  bool told = true;  ///< what is seen of the row reaches the robot

  /// @param from_m so far ahead of the robot they begin. A gap is in the middle of both.
  Hedges(double from_m, double to_m) {
    const double middle_m = 0.5 * (from_m + to_m);
    int n = 0;
    for (double s = from_m; s <= to_m; s += 0.4, ++n) {
      if (std::abs(s - middle_m) < 0.8) continue;
      for (const double side : {1.0, -1.0}) {
        const double aside_m = side * (kHalf_m + 0.04 * ((n * (side > 0.0 ? 3 : 5)) % 7));
        bushes.push_back({s * std::cos(kTurned_rad) - aside_m * std::sin(kTurned_rad),
                          s * std::sin(kTurned_rad) + aside_m * std::cos(kTurned_rad), 0.2});
      }
    }
  }

  std::optional<double> met_m(const nav::sense::Pose2& eye, double bearing_rad) const {
    const double c = std::cos(eye.yaw_rad + bearing_rad);
    const double s = std::sin(eye.yaw_rad + bearing_rad);
    std::optional<double> out;
    for (const Bush& b : bushes) {
      const double x = b.x_m - eye.x_m;
      const double y = b.y_m - eye.y_m;
      const double along_m = c * x + s * y;
      const double beside_m = c * y - s * x;
      if (along_m < 0.0 || std::abs(beside_m) >= b.radius_m) continue;
      const double r = along_m - std::sqrt(b.radius_m * b.radius_m - beside_m * beside_m);
      if (r > 0.05 && r < kClear_m && r < out.value_or(kClear_m)) out = r;
    }
    return out;
  }

  /// The outermost beams tell nothing. To the left leaves hang higher, and nearer.
  std::shared_ptr<base::Sight> seen_from(const nav::sense::Pose2& eye) const {
    auto sight = std::make_shared<base::Sight>();
    sight->sensor = "front";
    sight->half_step_rad = 0.0044F;
    sight->clear_to_m = float(kClear_m);
    for (int i = -180; i <= 180; ++i) {
      const double bearing_rad = base::rad_from_deg(0.5 * i);
      const bool dull = std::abs(i) > 160;
      const auto met = dull ? std::nullopt : met_m(eye, bearing_rad);
      const bool leaf = met && i > 0 && i % 3 == 0;
      const double at_m = dull ? 1.0 : met.value_or(kClear_m) - (leaf ? 0.1 : 0.0);
      sight->points.push_back({float(at_m * std::cos(bearing_rad)),
                               float(at_m * std::sin(bearing_rad)), leaf ? 0.2F : 0.0F, 0.0F, 0, 0,
                               dull  ? base::Echo::Unknown
                               : met ? base::Echo::Hit
                                     : base::Echo::Clear});
    }
    return sight;
  }
};

/// Ten looks a second, and the row found in them as the program's thread finds it.
inline std::shared_ptr<Hedges> look_along_rows(Walk& w, double from_m, double to_m) {
  nav::sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = 0.6;
  eye.mount.z_m = 0.3;
  eye.planar = true;
  eye.health.rate_hz = 10.0;
  const auto begun = w.robot.config();
  auto eyes = std::make_shared<Lookout>(*nav::sense::Chain::of({}, {eye}, footprint_of({}), w.now),
                                        std::vector<std::string>{"sick"}, begun->protect.reach_m,
                                        begun->rays);
  guard_as_configured(w);
  auto hedges = std::make_shared<Hedges>(from_m, to_m);
  w.more = [&w, eyes, hedges, body = nav::sense::Pose2{}, last = std::optional<RowSeen>{},
            ticks = 0]() mutable {
    std::vector<RowQuestion> rows;
    w.robot.row_questions().take(rows);
    if (!rows.empty()) eyes->look_for(rows.back());
    std::vector<nav::sense::Odometry> moved;
    w.robot.odometry().take(moved);
    for (const auto& o : moved) {
      eyes->moved(o);
      body = o.pose;
    }
    if (ticks++ % 5 != 0 || moved.empty()) return;
    auto sight = hedges->seen_from(body * nav::sense::Pose2{0.6, 0.0, 0.0});
    sight->stamp = moved.back().stamp;
    sight->count = static_cast<std::uint64_t>(ticks);
    eyes->see(std::move(sight), w.now);
    const auto picture = eyes->picture(w.now);
    if (!picture) return;
    auto told = std::make_shared<Surroundings>(*picture);
    if (hedges->told) {
      last = told->row;
    } else {
      told->row = last;  // it grows old
    }
    w.robot.surroundings().put(std::move(told));
  };
  return hedges;
}

inline mission::Plan a_row(mission::RowSeeing seeing) {
  mission::Plan plan;
  plan.name = "row";
  mission::Row row;
  row.seeing = seeing;
  plan.items.emplace_back(row);
  return plan;
}

inline void see_all_beside(Config& c) {
  c.protect.creep_mps = 1.0;  // beside it nothing is seen
  c.rows.width_min_m = 2.0;
}

inline const std::vector<Scene> kRowScenes = {
    {"along a row to its end",
     [](Walk& w) {
       const auto hedges = look_along_rows(w, 2.0, 12.0);
       w.run(8.0);
       w.go(a_row(mission::RowSeeing::Line));
       w.run(9.0);
       w.change();
       w.run(25.0);
     },
     see_all_beside},
    {"a row is begun, and not seen for a while",
     [](Walk& w) {
       const auto hedges = look_along_rows(w, 4.0, 12.0);
       w.run(8.0);
       w.change();
       w.go(a_row(mission::RowSeeing::Line));
       w.run(15.0);
       hedges->told = false;
       w.run(8.0);
     },
     see_all_beside},
    {"along a row by rays",
     [](Walk& w) {
       const auto hedges = look_along_rows(w, -1.0, 12.0);
       w.run(8.0);
       w.go(a_row(mission::RowSeeing::Rays));
       w.run(5.0);
       w.change();
       w.run(10.0);
     },
     see_all_beside},
};

}  // namespace roverd::robot
