#pragma once
// The simple rule of the first field robots: a target point out of one image, and a turn in
// proportion to its bearing. It needs neither odometry nor memory, and knows no corner: where
// there is an odometry, ways.hpp drives better.
//
//   wall       the point at `distance_m` from the wall and `ahead_m` further along it
//   landmark   the point `offset_m` beside the nearest one that is not nearer than next_m
//
// Pure. Frame B, FLU.

#include <optional>
#include <span>

#include "nav/marks/params.hpp"
#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

/// Ahead is where along the wall x grows.
Vec2 wall_target(const PlaneWall& wall, const WallParams& params) noexcept;

/// @param places landmarks. @param side where they are passed. Empty: none is far enough and ahead.
std::optional<Vec2> landmark_target(std::span<const Vec2> places, Side side,
                                    const LandmarkParams& params) noexcept;

/// Turn rate, left positive: a tenth of the gain for each radian of bearing, at most max_radps.
double turn_towards_radps(Vec2 target, double gain, double max_radps) noexcept;

}  // namespace roverd::nav::marks
