#pragma once
// Missions that count from a map: where that map lies, and whether the robot is known to be in it.
// Pure.

#include <optional>

#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "base/result.hpp"
#include "mission/plan.hpp"
#include "nav/behave/route.hpp"

namespace roverd::robot {

/// What the robot knows of the map in use.
struct MapNow {
  const std::optional<base::PlaceState>& place;
  const std::optional<base::LocalFrame>& frame;
  base::EnuPoint offset{};  ///< that the estimate adds to the map's places
  base::Time now{};
};

/// Where the mission's map lies, as the robot drives by it. Conflict: another map is in use or
/// none, or nobody knows where it lies.
base::Result<base::MapLies> lies_of(const mission::MissionMap& said, const MapNow& now);

/// The step leads to a point of the map. @param step null: one does, who knows.
bool leads_into_map(const mission::Plan& plan, const nav::RouteStep* step) noexcept;

/// Whether what was laid out by it may be driven: it lies as it lay, and who is led into it is
/// known to be in it, by what was seen within kSeen_s. Conflict otherwise.
base::Result<void> counts_from(const mission::MissionMap& laid, const MapNow& now, bool into_it);
inline constexpr double kSeen_s = 3.0;

/// Where the robot is in the map, by what was seen within kSeen_s. Conflict: another map is in use
/// or none, or it is not known to be in it.
base::Result<base::MapPlace> found_in(const mission::MissionMap& said,
                                      const std::optional<base::PlaceState>& place, base::Time now);

}  // namespace roverd::robot
