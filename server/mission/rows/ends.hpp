#pragma once
// Where the lanes of a block end, one beside the other, and how far a turn must be driven out so
// that it leads through none of them:
//
//      │ 1 │ 2 │ 3 │        from lane 1 to lane 2 as far out as 2 reaches; back at the slanted
//      │   │   │   ╱        border, from 2 to 1, the robot drives up to where 1 begins
//      │   │   ╱   .
//      │   ╱ ◀─╮   .
//      ╱   . . │
//
// Pure.

#include <array>
#include <span>
#include <vector>

#include "mission/plan.hpp"
#include "mission/rows/headland.hpp"

namespace roverd::mission {

/// A lane at the end at which it is left, and to which hand the numbers grow.
struct LaneLeft {
  int lane = 1;  ///< from 1
  bool forth = true;
  bool grows_right = true;
};

class LaneEnds {
 public:
  /// @param lanes from beginning to end, all parallel; empty: nobody knows, and all end level
  LaneEnds(const std::vector<std::array<LatLon, 2>>& lanes, double spacing_m);

  /// How far another lane reaches beyond the one that is left, as the robot points. 0: out of the
  /// block.
  double beyond_m(const LaneLeft& from, int lane) const noexcept;
  /// So much farther out than it is laid, a turn comes no nearer than `clear_m` to any other lane.
  double farther_m(const LaneLeft& from, std::span<const TurnPoint> turn, double clear_m) const;
  /// How far it comes at most beyond the ends of the lanes that it passes.
  double deepest_m(const LaneLeft& from, std::span<const TurnPoint> turn, double farther_m) const;

 private:
  int beside(const LaneLeft& from, double right_m) const noexcept;

  double spacing_m_;
  std::vector<std::array<double, 2>> along_m_;  ///< begin and end of each lane, along row 1
};

}  // namespace roverd::mission
