#pragma once
// What the grid knows, as people are told of it: things instead of cells, and fewer cells.
//
// Pure; O(cells). Frames: O of the patch, B of the body (footprint.hpp).

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/geo.hpp"
#include "nav/sense/footprint.hpp"
#include "nav/sense/grid.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::sense {

/// Cells of one kind that hang together, gaps of one cell left aside.
struct Cluster {
  Known known = Known::Occupied;  ///< or Drop
  Vec2 nearest{};                 ///< of its cells to the body's outline, in B
  double clearance_m = 0.0;       ///< from the outline to that cell's middle; negative: within
  double size_m = 0.0;            ///< across, where it is widest; a cell and 2 % too small at most
  std::uint32_t cells = 0;
  std::uint8_t sensor = 0;   ///< that told the nearest cell last
  std::uint16_t age_ds = 0;  ///< of its youngest cell, tenths of a second at the patch's stamp
  bool on_way = false;       ///< see Way
};

/// Which way the body goes: a cell is on it that comes within side_m of the body within horizon_s
/// of the twist. Standing, nothing is.
struct Way {
  base::BodyTwist twist{};
  double side_m = 0.08;
  double horizon_s = 6.0;
};

/// @param pose X_OB. @return the nearest to the body's outline first, at most `most`.
std::vector<Cluster> clusters_of(const Patch& patch, const Pose2& pose, const Footprint& body,
                                 const Way& way, std::size_t most);

/// Blocks of n by n cells as one; whole blocks only, and always the same cells in one, wherever the
/// patch lies. The worst of a block counts: Occupied, Drop, Unknown, Free. @param n from 1.
Patch coarser(const Patch& patch, std::int32_t n);

}  // namespace roverd::nav::sense
