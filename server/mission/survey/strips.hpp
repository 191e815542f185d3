#pragma once
// An area cut into strips along one axis, without gaps between them:
//
//   line 3 ──────╭───╮──────────────     strip 2: one component
//   line 2 ───╭──╯   ╰──╮─╭──╮──────     strip 1: two components (or one, if they meet in it)
//   line 1 ───╰─────────╯─╰──╯──────     strip 0
//
// An interval is a stretch of a line inside the area, a component a connected piece of the area
// within one strip. Time: edges and crossings, times their logarithm on each line. Pure.

#include <cstddef>
#include <vector>

#include "mission/survey/area.hpp"

namespace roverd::mission::survey {

/// Along the first axis.
struct Interval {
  double from_m = 0.0;
  double to_m = 0.0;
};

struct Component {
  double from_m = 0.0;  ///< extent along the first axis
  double to_m = 0.0;
  double low_m = 0.0;  ///< extent across, within the strip
  double high_m = 0.0;
  std::vector<std::size_t> below;  ///< indices of intervals on the strip's lower line
  std::vector<std::size_t> above;  ///< … upper line
};

struct Strips {
  std::vector<std::vector<Interval>> lines;    ///< ascending; one more than strips
  std::vector<std::vector<Component>> strips;  ///< strip k lies between lines k and k + 1
};

/// @param area north_m runs across the strips: turn it first. @param low_m where line 0 is, not
/// above the area. @param count of strips; together they reach over the area
/// @param most_crossings of edges with lines; more: an empty result
Strips cut(const Area& area, double low_m, double width_m, std::size_t count,
           std::size_t most_crossings);

}  // namespace roverd::mission::survey
