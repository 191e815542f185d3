#pragma once
// Where a wall was seen to end (SeenEnd, walls.hpp). Frame O. Pure; O(beams · stretches).

#include <span>

#include "nav/marks/walls.hpp"

namespace roverd::nav::marks {

/// Counts the echoes that a scan has from behind the wall's line close beyond the ends of what was
/// seen of it.
/// @param now what this scan shows of it: its ends count before those of earlier scans, which the
/// odometry has moved
/// @param rms_m of its points beside its line
void look_past(Wall& wall, std::span<const Stretch> now, double rms_m, const PlanarScan& scan);

/// The same end, told again, counts together.
void tell_end(Wall& wall, const SeenEnd& end);

}  // namespace roverd::nav::marks
