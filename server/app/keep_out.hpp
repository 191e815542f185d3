#pragma once
// What a person forbade in a map, as the robot is to keep out of it: areas of a fence, where the
// map lies on the earth. Pure.

#include <cstddef>
#include <vector>

#include "maps/words.hpp"
#include "mission/fence/fence.hpp"

namespace roverd {

struct KeepOut {
  std::vector<mission::FenceArea> areas;
  std::size_t left_out = 0;  ///< that no fence may have: wider than 20 km, or too many corners
};

/// All together satisfy mission::check_fence. Of an area whose sides cross or touch, its convex
/// hull, and so of all where they have more than 5000 corners together: never less than what was
/// drawn. Areas that cover nothing do not count. May take tenths of a second: not on the web
/// thread.
KeepOut keep_out_of(const std::vector<maps::Area>& forbidden, const maps::Anchor& anchor);

}  // namespace roverd
