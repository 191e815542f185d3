#pragma once
// What is known of walls at one moment, in the odometry's frame O. Immutable once it is handed on.

#include <vector>

#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

struct View {
  base::Time stamp;  ///< of the last scan that told it
  std::vector<Wall> walls;
};

}  // namespace roverd::nav::marks
