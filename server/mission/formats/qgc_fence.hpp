#pragma once
// The geofence and the rally points of QGroundControl's .plan.
// Source: QGroundControl developer guide, "Plan file format".

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "mission/fence/fence.hpp"
#include "mission/formats/formats.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {

/// From the whole document; without a name. Empty: there is none. Each area and point has its row;
/// what cannot be goes to `problems`.
std::optional<Fence> fence_in_plan(const nlohmann::json& root, std::vector<FileRow>& rows,
                                   Problems& problems);

/// The members "geoFence" and "rallyPoints". @param fence null: empty ones
nlohmann::json geo_fence_json(const Fence* fence);
nlohmann::json rally_points_json(const Fence* fence);

}  // namespace roverd::mission
