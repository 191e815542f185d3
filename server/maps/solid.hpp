#pragma once
// Maps in three dimensions as this robot keeps them: a PCD file (nav/cells/map_file.hpp), and the
// plane of it, which people see and in which the whole map is searched. Frame M: metres, z up.

#include <cstdint>
#include <filesystem>

#include "base/result.hpp"
#include "nav/cells/cell_map.hpp"
#include "nav/chart/map.hpp"

namespace roverd::maps {

inline constexpr std::uintmax_t kLargestSolid = 400'000'000;  ///< bytes of a file
/// Edge of the cells in which clouds are matched (docs/figures.md).
inline constexpr double kSolidCell_m = 0.2;

/// By its name: it ends in .pcd.
bool is_solid(const std::filesystem::path& file);

/// NotFound, TooLarge, Malformed and the rest, with the file's name.
base::Result<nav::cells::CellMap> read_solid(const std::filesystem::path& file);

/// What stands 0.3 to 2 m over the lowest that was seen within about a metre is occupied; where
/// only ground was seen it is free; the rest is unknown. Cells of 5, 10 or 20 cm: the finest that
/// has room.
/// @return TooLarge: wider than a map of the plane may be. Invalid: there is nothing in it
base::Result<nav::chart::OccupancyMap> plane_of(const nav::cells::CellMap& solid);

}  // namespace roverd::maps
