#pragma once
// Who walks up to the robot: since when that can be seen, and whose motion it is.

#include <vector>

#include "base/geo.hpp"
#include "sim/world/scene.hpp"

namespace roverd::study {

/// When he began to walk to where he is at now_s: until then he stood, or went another way, and
/// nobody sees that coming. 0, the world's begin, where he always stood there.
double set_out_s(const sim::world::Thing& who, double now_s);

/// How fast the nearest place of a body's edge comes nearer to a place outside of it; negative: it
/// goes away; 0 on the edge itself. @param outline corners in B, in turn. @param place in B
double nears_mps(const std::vector<sim::world::Vec2>& outline, sim::world::Vec2 place,
                 const base::BodyTwist& moves) noexcept;

}  // namespace roverd::study
