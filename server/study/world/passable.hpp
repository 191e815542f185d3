#pragma once
// Is there a way through a world, whoever looks for it? What a way around is measured by.
//
// Searched in the truth, by a body that turns on the spot and drives straight: on squares of 10 cm,
// along the sixteen directions that lead from one to another within two of them. So a way that is
// found can be driven, with all of its room; not each one that there is, is found.

#include "base/geo.hpp"
#include "sim/world/contact.hpp"

namespace roverd::study {

/// A straight way, and what may be driven of it.
struct Passage {
  base::EnuPoint from, to;
  double side_m = 3.0;  ///< every part of the body stays within this of the line
  double room_m = 0.3;  ///< and keeps this from all that is solid
};

/// From its begin, pointing along it, to its end. Bounded: looks at each place and direction once.
/// Pure; metres, in the world's frame (ENU about the start). Who moves stands as at its begin.
bool passable(const sim::world::Scene& scene, const sim::world::Body& body, const Passage& passage);

}  // namespace roverd::study
