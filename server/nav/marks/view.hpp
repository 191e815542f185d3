#pragma once
// What is known of walls and landmarks at one moment, in the odometry's frame O. Immutable once it
// is handed on.

#include <vector>

#include "nav/marks/landmarks.hpp"
#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

struct View {
  base::Time stamp;  ///< of the last scan or image that told it
  std::vector<Wall> walls;
  std::vector<Landmark> landmarks{};
};

}  // namespace roverd::nav::marks
