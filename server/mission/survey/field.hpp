#pragma once
// The polygon of a survey: checked and laid out in metres.

#include <optional>
#include <vector>

#include "base/result.hpp"
#include "base/tangent_plane.hpp"
#include "mission/survey/area.hpp"

namespace roverd::mission::survey {

struct Field {
  base::TangentPlane plane;
  Area area;  ///< one part: the outer ring first
};

/// @param rings as they came. Invalid, with pointers /polygon/RING/POINT; see survey.hpp.
base::Result<Field> field_of(const std::vector<std::vector<base::LatLon>>& rings);

}  // namespace roverd::mission::survey
