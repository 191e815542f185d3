#pragma once
// Missions that count from a map: where that map lies, and whether the robot is known to be in it.
// Pure.

#include <optional>

#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::robot {

/// What the robot knows of the map in use.
struct MapNow {
  const std::optional<base::PlaceState>& place;
  const std::optional<base::LocalFrame>& frame;
  base::EnuPoint offset{};  ///< that the estimate adds to the map's places
};

/// Where the mission's map lies, as the robot drives by it. Conflict: another map is in use or
/// none, or nobody knows where it lies.
base::Result<base::MapLies> lies_of(const mission::MissionMap& said, const MapNow& now);

/// Whether what was laid out by it may be driven: the robot is known to be in it, and it lies as it
/// lay. Conflict otherwise.
base::Result<void> counts_from(const mission::MissionMap& laid, const MapNow& now);

}  // namespace roverd::robot
