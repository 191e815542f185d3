#include "nav/marks/bearing.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav::marks {

Vec2 wall_target(const PlaneWall& wall, const WallParams& params) noexcept {
  Vec2 along{-wall.normal.y, wall.normal.x};
  if (along.x < 0.0) along = -1.0 * along;
  return (params.distance_m - wall.distance_m) * wall.normal + params.ahead_m * along;
}

std::optional<Vec2> landmark_target(std::span<const Vec2> places, Side side,
                                    const LandmarkParams& params) noexcept {
  const Vec2* nearest = nullptr;
  for (const Vec2& p : places) {
    const double far_m = length(p);
    if (p.x <= 0.0 || far_m < params.next_m || far_m > params.max_range_m) continue;
    if (nearest == nullptr || far_m < length(*nearest)) nearest = &p;
  }
  if (nearest == nullptr) return std::nullopt;
  const double sign = side == Side::Left ? 1.0 : -1.0;
  const Vec2 ray = (1.0 / length(*nearest)) * *nearest;
  return *nearest - (sign * params.offset_m) * Vec2{-ray.y, ray.x};
}

double turn_towards_radps(Vec2 target, double gain, double max_radps) noexcept {
  const double turn = 0.1 * gain * std::atan2(target.y, target.x);
  return std::clamp(turn, -max_radps, max_radps);
}

}  // namespace roverd::nav::marks
