#pragma once
// What is known of walls and landmarks at one moment, in the odometry's frame O. Immutable once it
// is handed on.

#include <cstddef>
#include <vector>

#include "nav/marks/landmarks.hpp"
#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

struct View {
  base::Time stamp;  ///< of the last scan or image that told it
  /// By the sensors' numbers (Eyes): each one's last scan or image, whatever it showed.
  std::vector<base::Time> looked_at{};
  std::vector<Wall> walls;
  std::vector<Landmark> landmarks{};

  /// One of these has looked since then. @param eyes 0: anyone.
  bool looked_since(base::Time then, Eyes eyes) const noexcept {
    if (eyes == 0) return stamp >= then;
    for (std::size_t i = 0; i < looked_at.size(); ++i) {
      if ((eyes & eye_of(i)) != 0 && looked_at[i] >= then) return true;
    }
    return false;
  }
};

}  // namespace roverd::nav::marks
