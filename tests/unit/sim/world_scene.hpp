#pragma once
// Small worlds for the tests of rays, touches and sensors.

#include <initializer_list>
#include <utility>

#include "sim/world/scene.hpp"

namespace roverd::sim::world {

inline Thing thing(Kind kind, std::vector<Vec2> points) {
  Thing t;
  t.kind = kind;
  t.points = std::move(points);
  return t;
}
inline Thing pole(Vec2 at, double radius_m, double height_m = 2.0) {
  Thing t = thing(Kind::Pole, {at});
  t.radius_m = radius_m;
  t.height_m = height_m;
  return t;
}
inline Thing box(Vec2 at, double length_m, double width_m, double height_m, double yaw_rad = 0.0) {
  Thing t = thing(Kind::Box, {at});
  t.length_m = length_m;
  t.width_m = width_m;
  t.height_m = height_m;
  t.yaw_rad = yaw_rad;
  return t;
}
inline World world_of(std::initializer_list<Thing> things, Ground ground = {}) {
  World w;
  w.ground = std::move(ground);
  w.things = things;
  return w;
}
inline Vec3 unit(double x, double y, double z) {
  const double n = std::sqrt(x * x + y * y + z * z);
  return {x / n, y / n, z / n};
}
/// One ray, always with the same draws.
inline Hit cast(const Scene& scene, Vec3 from, Vec3 dir, double max_m = 100.0, double at_s = 0.0) {
  Draw draw(7);
  return scene.cast({from, dir}, max_m, scene.at(at_s), draw);
}

}  // namespace roverd::sim::world
