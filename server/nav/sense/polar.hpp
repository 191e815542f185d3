#pragma once
// All sensors in one robot-centred picture: in every direction the nearest obstacle, how far it is
// known to be free, and by whom. Read from the grid, so it holds what was seen a moment ago as
// well.

#include <array>
#include <cstddef>
#include <cstdint>

#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"

namespace roverd::nav::sense {

/// One direction about the origin of B.
struct Bearing {
  float hit_m = 0.0F;   ///< to the nearest obstacle; 0: none within the range
  float free_m = 0.0F;  ///< free without a gap from the body as far as this; 0: nothing is known
  std::uint8_t sensor = 0;  ///< of the obstacle, or of the last free cell
  std::uint16_t age_ds = 0;
};

struct Polar {
  static constexpr std::size_t kBearings = 720;
  base::Time stamp;
  std::array<Bearing, kBearings> of{};  ///< from −π, as sectors.hpp: bearing_rad(i)
};

/// @param pose X_OB at the time of the patch. @param body within it everything is the robot.
void polar_of(const Patch& patch, const Pose2& pose, const Footprint& body, double range_m,
              Polar& out);

}  // namespace roverd::nav::sense
