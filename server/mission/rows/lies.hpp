#pragma once
// Where the rows of a block lie, from what a person draws: row 1 from its beginning to its end, or
// the corners of the whole block, of which the first two are the beginning and the end of row 1.
//
//      4 ─────────────── 3          each lane begins and ends where it meets the border
//      │  lane 3  ─ ─ ─ ▶│
//      │  lane 2  ─ ─ ─ ▶ ╲
//      1 ═══ lane 1 ═════▶ 2
//
// Pure.

#include <array>
#include <optional>
#include <vector>

#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

struct BlockPlaces {
  std::vector<LatLon> corners;  ///< 2 .. kMostCorners
  double spacing_m = 2.5;       ///< > 0
  std::optional<int> rows{};    ///< empty: as many as there is room for; needed with two corners
  std::optional<Side> turn{};   ///< empty: where the block lies; with two corners to the right
};
inline constexpr int kMostCorners = 100;

struct LaidRows {
  Side turn = Side::Right;
  double heading_deg = 0.0;  ///< along row 1
  std::vector<std::array<LatLon, 2>> lanes;
};

/// Invalid, with pointers "/block", "/block/3", "/rows", "/turn".
base::Result<LaidRows> lay_rows(const BlockPlaces& block);

}  // namespace roverd::mission
