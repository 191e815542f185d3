#pragma once
// A map of cells as a PCD file, and any PCD file as a map of cells.
//
// Each cell is a point at its mean, so that any viewer shows the place; the further columns hold
// the rest: points, then the spread per point xx xy xz yy yz zz, m². Written binary_compressed,
// floats: means to 0.1 mm within 1 km of the origin.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "nav/cells/cell_map.hpp"

namespace roverd::nav::cells {

/// Holds one column beside the file.
std::vector<std::uint8_t> write_map(const CellMap& map);

/// A map, and what of its file is not in it.
struct ReadMap {
  explicit ReadMap(double cell_m) : map(cell_m) {}
  CellMap map;
  std::size_t points = 0;     ///< of the file; of a map's own file: cells
  std::size_t no_number = 0;  ///< of them, left out: NaN, infinite, or a cell that cannot be
  std::size_t too_far = 0;    ///< of them, left out: beyond reach_m()
  bool viewpoint = false;     ///< the header moves or turns the sensor; the points stay as they are
};

/// A file without the columns of spread is taken as points. Of those that are numbers at most one
/// in a hundred may lie too far away. The points are read one by one: what is held is the map.
/// @param cell_m edge of the cells. @param most_cells more are refused
/// @return the errors of read_pcd; Invalid where not one point is a number, or too many lie too far
/// away; TooLarge where it would have more than `most_cells`
base::Result<ReadMap> read_whole_map(base::Bytes file, double cell_m,
                                     std::size_t most_cells = CellMap::kMaxCells);
/// The same, where nobody asks what was left out.
base::Result<CellMap> read_map(base::Bytes file, double cell_m);

/// For people: "12 points that are no numbers".
std::vector<std::string> left_out(const ReadMap& read);

}  // namespace roverd::nav::cells
