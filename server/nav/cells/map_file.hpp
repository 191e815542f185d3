#pragma once
// A map of cells as a PCD file, and any PCD file as a map of cells.
//
// Each cell is a point at its mean, so that any viewer shows the place; the further columns hold
// the rest: points, then the spread per point xx xy xz yy yz zz, m². Written binary_compressed,
// floats: means to 0.1 mm within 1 km of the origin.

#include <cstdint>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "nav/cells/cell_map.hpp"

namespace roverd::nav::cells {

/// @return TooLarge never: a map has fewer cells than a file may have points.
base::Result<std::vector<std::uint8_t>> write_map(const CellMap& map);

/// A file without the columns of spread is taken as points. @param cell_m edge of the cells
/// @return the errors of read_pcd; Invalid where not one point is a number, or all lie too far away
base::Result<CellMap> read_map(base::Bytes file, double cell_m);

}  // namespace roverd::nav::cells
