#pragma once
// Scenes of a robot that drives along walls: what the parameters of walls may change shows in one
// of them.

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/angle.hpp"
#include "base/vision.hpp"
#include "seeing_scenes.hpp"

namespace roverd::robot {

/// Walls that are not quite straight, and the robot's scanner.
struct Walled {
  struct Slab {
    double x0_m, y0_m, x1_m, y1_m;
  };
  struct Post {
    double x_m, y_m, radius_m;
  };
  static constexpr double kClear_m = 12.0;
  std::vector<Slab> slabs;
  std::vector<Post> posts{};
  std::optional<base::VisionPlane> plane{};  ///< a camera at the body's origin tells it
  bool dark = false;                         ///< to the left nothing comes back
  bool told = true;                          ///< what is seen of walls reaches the robot

  std::optional<double> met_m(const nav::sense::Pose2& eye, double bearing_rad) const {
    const double c = std::cos(eye.yaw_rad + bearing_rad);
    const double s = std::sin(eye.yaw_rad + bearing_rad);
    std::optional<double> out;
    for (const Slab& w : slabs) {
      const double ux = w.x1_m - w.x0_m;
      const double uy = w.y1_m - w.y0_m;
      const double det = c * uy - s * ux;
      if (std::abs(det) < 1e-9) continue;
      const double x = w.x0_m - eye.x_m;
      const double y = w.y0_m - eye.y_m;
      const double r = (x * uy - y * ux) / det;
      const double part = (x * s - y * c) / det;
      if (r < 0.05 || r > kClear_m || part < 0.0 || part > 1.0) continue;
      if (r < out.value_or(kClear_m)) out = r;
    }
    for (const Post& p : posts) {
      const double x = p.x_m - eye.x_m;
      const double y = p.y_m - eye.y_m;
      const double off = c * y - s * x;
      const double to = c * x + s * y;
      if (to < 0.05 || std::abs(off) >= p.radius_m) continue;
      const double r = to - std::sqrt(p.radius_m * p.radius_m - off * off);
      if (r < out.value_or(kClear_m)) out = r;
    }
    return out;
  }

  std::shared_ptr<base::Sight> seen_from(const nav::sense::Pose2& eye) const {
    auto sight = std::make_shared<base::Sight>();
    sight->sensor = "front";
    sight->half_step_rad = 0.0044F;
    sight->clear_to_m = float(kClear_m);
    for (int i = -180; i <= 180; ++i) {
      const double bearing_rad = base::rad_from_deg(0.5 * i);
      const bool unseen = dark && i > 0;
      const auto met = unseen ? std::nullopt : met_m(eye, bearing_rad);
      // Rough by up to 16 mm, always the same.
      const double rough_m = 0.002 * double((i * 37 + 720) % 17 - 8);
      const double at_m = unseen ? 1.0 : met ? *met + rough_m : kClear_m;
      sight->points.push_back({float(at_m * std::cos(bearing_rad)),
                               float(at_m * std::sin(bearing_rad)), 0.0F, 0.0F, 0, 0,
                               unseen ? base::Echo::Unknown
                               : met  ? base::Echo::Hit
                                      : base::Echo::Clear});
    }
    return sight;
  }
};

/// Ten looks a second, and the walls found in them as the program's thread finds them.
inline std::shared_ptr<Walled> look_along_walls(Walk& w, std::vector<Walled::Slab> slabs) {
  nav::sense::SensorSetup eye;
  eye.name = "front";
  eye.mount.x_m = 0.6;
  eye.mount.z_m = 0.3;
  eye.planar = true;
  eye.health.rate_hz = 10.0;
  eye.health.max_unknown_part = 1.0;
  const auto begun = w.robot.config();
  auto eyes = std::make_shared<Lookout>(*nav::sense::Chain::of({}, {eye}, footprint_of({}), w.now),
                                        std::vector<std::string>{"sick"}, begun->protect.reach_m,
                                        begun->rays);
  eyes->watch_by({Camera{"camera", {}, 1.0}});
  guard_as_configured(w);
  auto walled = std::make_shared<Walled>();
  walled->slabs = std::move(slabs);
  w.more = [&w, eyes, walled, body = nav::sense::Pose2{},
            last = std::shared_ptr<const nav::marks::View>{}, ticks = 0]() mutable {
    eyes->follow(w.robot.config()->wall, w.robot.config()->landmarks);
    std::vector<nav::sense::Odometry> moved;
    w.robot.odometry().take(moved);
    for (const auto& o : moved) {
      eyes->moved(o);
      body = o.pose;
    }
    if (ticks++ % 5 != 0 || moved.empty()) return;
    if (walled->plane) {
      auto image = std::make_shared<base::Vision>();
      image->sensor = "camera";
      image->stamp = moved.back().stamp;
      image->planes = {*walled->plane};
      eyes->recognise(std::move(image));
    }
    auto sight = walled->seen_from(body * nav::sense::Pose2{0.6, 0.0, 0.0});
    sight->stamp = moved.back().stamp;
    sight->count = static_cast<std::uint64_t>(ticks);
    eyes->see(std::move(sight), w.now);
    const auto picture = eyes->picture(w.now);
    if (!picture) return;
    auto around = std::make_shared<Surroundings>(*picture);
    if (walled->told) {
      last = around->beside;
    } else {
      around->beside = last;  // it grows old
    }
    w.robot.surroundings().put(std::move(around));
  };
  return walled;
}

inline mission::Plan a_wall() {
  mission::Plan plan;
  plan.name = "wall";
  mission::Wall wall;
  wall.side = mission::Side::Left;
  plan.items.emplace_back(wall);
  return plan;
}

inline void creep_beside_walls(Config& c) {
  c.protect.creep_mps = 1.0;  // beside it nothing is seen
}

inline const std::vector<Scene> kWallScenes = {
    {"along a wall, past a door, into a corner",
     [](Walk& w) {
       const auto walled = look_along_walls(
           w, {{-3.0, 0.9, 4.0, 0.9}, {5.2, 0.9, 9.0, 0.9}, {9.0, 0.9, 9.0, -4.0}});
       w.run(8.0);
       w.go(a_wall());
       w.run(3.0);
       w.change();
       w.run(22.0);
     },
     creep_beside_walls},
    {"along a wall that is not seen any more",
     [](Walk& w) {
       const auto walled = look_along_walls(w, {{-3.0, 0.9, 14.0, 0.9}});
       w.run(8.0);
       w.go(a_wall());
       w.run(4.0);
       w.change();
       walled->dark = true;
       w.run(10.0);
     },
     creep_beside_walls},
    {"along a wall of which nothing is told any more",
     [](Walk& w) {
       const auto walled = look_along_walls(w, {{-3.0, 0.9, 14.0, 0.9}});
       w.run(8.0);
       w.go(a_wall());
       w.run(4.0);
       w.change();
       walled->told = false;
       w.run(10.0);
     },
     creep_beside_walls},
    {"along a wall that a camera tells",
     [](Walk& w) {
       const auto walled = look_along_walls(w, {});
       walled->plane = base::VisionPlane{{1.2, 0.9, 0.0}, {0.0, -1.0, 0.0}, 5000.0};
       w.run(8.0);
       w.go(a_wall());
       w.run(3.0);
       w.change();
       w.run(8.0);
     },
     creep_beside_walls},
    {"where there is no wall",
     [](Walk& w) {
       const auto walled = look_along_walls(w, {{-3.0, -0.9, 14.0, -0.9}});
       w.run(8.0);
       w.go(a_wall());
       w.run(2.0);
       w.change();
       w.run(14.0);
     },
     creep_beside_walls},
};

}  // namespace roverd::robot
