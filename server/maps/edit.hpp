#pragma once
// The cells of a map as a person changes and sees them. Pure; any thread.

#include <cstdint>
#include <vector>

#include "atlas/map_files.hpp"
#include "maps/words.hpp"
#include "nav/chart/map.hpp"

namespace roverd::maps {

/// Erase and Wall act on the cells whose middle lies inside of the area (even-odd where its border
/// crosses itself); Forbid on none. Effort: the rows of the map times the corners, and the cells.
void edit(nav::chart::OccupancyMap& map, const Edit& edit);

/// None of it can lie on the map: its box and the map's do not meet, along the map's own sides.
bool lies_outside(const nav::chart::MapShape& map, const Area& area) noexcept;

/// Grey values of what people are shown.
inline constexpr std::uint16_t kGreyOccupied = 0;
inline constexpr std::uint16_t kGreyForbidden = 100;
inline constexpr std::uint16_t kGreyUnknown = 205;
inline constexpr std::uint16_t kGreyFree = 254;

struct Thinned {
  atlas::Picture picture;
  std::int32_t factor = 1;  ///< so many cells to a side are one
};

/// The picture of at most `most` cells, of squares of factor x factor cells that begin at the lower
/// left corner of the map: those of the last column and the top row may be cut. In a square
/// occupied wins over forbidden, over unknown, over free; doubtful cells are unknown.
/// @param most at least 1
Thinned thinned(const nav::chart::OccupancyMap& map, const std::vector<Area>& forbidden,
                std::size_t most);

/// The words under which the map's picture loses nothing: trinary, or raw where cells are doubtful.
atlas::MapWords words_for(const nav::chart::OccupancyMap& map);

/// The map with what is forbidden as occupied, for programs that know no such thing.
nav::chart::OccupancyMap with_forbidden(nav::chart::OccupancyMap map,
                                        const std::vector<Area>& forbidden);

}  // namespace roverd::maps
