#pragma once
// Fences in GeoJSON, which has no word for them: Features that say so by a property.
//
//   Polygon  {"fence": "inclusion" | "exclusion"}                    an area, without holes
//   Point    {"fence": "inclusion" | "exclusion", "radius_m": 12}    a circle
//   Point    {"rally": true}                                         a rally point

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "mission/fence/fence.hpp"
#include "mission/formats/formats.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {

/// Where a part of a fence stands in its file.
struct FencePlace {
  std::string row;      ///< for its account
  std::string problem;  ///< for what cannot be
};

/// Takes a Feature that is part of a fence into `fence`, with its row; what cannot be goes to
/// `problems`. @return false: it is none. @param properties, shape objects
bool take_fence_feature(const nlohmann::json& properties, const nlohmann::json& shape,
                        const FencePlace& where, Fence& fence, std::vector<FileRow>& rows,
                        Problems& problems);

/// One Feature for each area and rally point.
std::vector<nlohmann::json> fence_features(const Fence& fence);

}  // namespace roverd::mission
