#pragma once
// What a person forbade in a map, as the robot is to keep out of it: areas of a fence, where the
// map lies on the earth. Pure.

#include <vector>

#include "maps/words.hpp"
#include "mission/fence/fence.hpp"

namespace roverd {

/// Each satisfies mission::check_fence. Of an area whose sides cross or touch, its convex hull:
/// never less than what was drawn. Areas that cover nothing are left out.
std::vector<mission::FenceArea> keep_out_of(const std::vector<maps::Area>& forbidden,
                                            const maps::Anchor& anchor);

}  // namespace roverd
