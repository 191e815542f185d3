#pragma once
// Parallel tracks over an area, the cells that they make, and the order in which to drive them.
// Everything here lies in a plane that is turned so that tracks run along its first axis. Pure.

#include <cstddef>
#include <vector>

#include "mission/survey/area.hpp"

namespace roverd::mission::survey {

struct Track {
  double from_m = 0.0;  ///< along the first axis
  double to_m = 0.0;
  double across_m = 0.0;

  EnuPoint begin() const noexcept { return {from_m, across_m}; }
  EnuPoint end() const noexcept { return {to_m, across_m}; }
};
/// Tracks that follow on each other, one spacing apart.
using Cell = std::vector<Track>;

inline constexpr std::size_t kMostCrossings = 2'000'000;

/// Every piece of the area within a strip gets a track as long as itself, so that all of the area
/// is nearer than half a spacing to one. Tracks leave the area by less than that.
/// Empty: more than kMostCrossings.
std::vector<Cell> covering_cells(const Area& area, double spacing_m);

/// Tracks at most one spacing apart that nowhere leave the area. Empty: as above.
std::vector<Cell> inner_cells(const Area& area, double spacing_m);

/// A track to be driven, from `begin` to `end`.
struct Drive {
  EnuPoint begin;
  EnuPoint end;
};

/// The order in which a vehicle drives `count` tracks beside each other so that it passes over
/// `skip` of them at each turn, where there are enough: 0, k, 1, k + 1 … k − 1, then the next block
/// of 2k − 1, with k = skip + 2. skip 0: one after the other. Each comes once.
std::vector<std::size_t> track_order(std::size_t count, int skip);

/// All tracks of all cells, from `start`: always the nearest corner of what is left.
std::vector<Drive> drives_from(EnuPoint start, const std::vector<Cell>& cells, int skip);

}  // namespace roverd::mission::survey
