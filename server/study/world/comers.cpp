#include "study/world/comers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/angle.hpp"

namespace roverd::study {

namespace world = sim::world;

double set_out_s(const world::Thing& who, double now_s) {
  constexpr double kStep_s = 0.02;
  double since_s = now_s;
  while (since_s > 0.0 && world::on_path(who, since_s).speed_mps == 0.0) since_s -= kStep_s;
  const double yaw_rad = world::on_path(who, since_s).yaw_rad;
  while (since_s > 0.0) {
    const world::OnPath before = world::on_path(who, since_s - kStep_s);
    const double turned_rad = base::angle_diff_rad(before.yaw_rad, yaw_rad);
    if (before.speed_mps == 0.0 || std::abs(turned_rad) > base::kPi / 2.0) break;
    since_s -= kStep_s;
  }
  return std::max(0.0, since_s);
}

double nears_mps(const std::vector<world::Vec2>& outline, world::Vec2 place,
                 const base::BodyTwist& moves) noexcept {
  world::Vec2 nearest{};
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const world::Vec2 a = outline[i];
    const world::Vec2 edge = outline[(i + 1) % outline.size()] - a;
    const double long2 = dot(edge, edge);
    const double part = long2 > 0.0 ? std::clamp(dot(place - a, edge) / long2, 0.0, 1.0) : 0.0;
    const world::Vec2 at = a + part * edge;
    if (length(place - at) >= nearest_m) continue;
    nearest_m = length(place - at);
    nearest = at;
  }
  if (nearest_m <= 0.0) return 0.0;
  const world::Vec2 at_mps{moves.linear_mps - moves.angular_radps * nearest.y,
                           moves.angular_radps * nearest.x};
  return dot(at_mps, place - nearest) / nearest_m;
}

}  // namespace roverd::study
