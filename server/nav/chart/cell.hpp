#pragma once
// The number of a cell, for places that may lie anywhere.

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace roverd::nav::chart {

/// A place told in cells, rounded down. What is too far away for a number (odometry that jumped, a
/// pose that somebody typed), or is none, becomes one that no map holds: +-1e9, so that blocks may
/// still be added. Pure.
inline std::int32_t whole_cell(double cells) noexcept {
  constexpr double kFarthest = 1e9;
  if (!(cells > -kFarthest)) return -static_cast<std::int32_t>(kFarthest);  // NaN, too
  return static_cast<std::int32_t>(std::floor(std::min(cells, kFarthest)));
}

}  // namespace roverd::nav::chart
