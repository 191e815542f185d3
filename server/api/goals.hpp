#pragma once
// Places and goals in request bodies.

#include <optional>

#include "api/body.hpp"
#include "robot/robot.hpp"

namespace roverd::api {

/// At most one of the two; neither: the body names no place.
struct Place {
  std::optional<base::LatLon> at;       ///< lat, lon
  std::optional<base::EnuPoint> local;  ///< east_m, north_m of the robot's map
};

/// Half a place, or both kinds at once, is complained about.
Place read_place(Members& members);
/// A place, heading_deg, speed_mps and reverse.
robot::GoTo read_goal(Members& members);

}  // namespace roverd::api
