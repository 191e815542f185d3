#pragma once
// Where a course stops, and how it turns on the spot there, as far as its items tell. Pure.

#include <cstddef>
#include <optional>
#include <vector>

#include "nav/behave/route.hpp"

namespace roverd::nav {

struct TurnOnTheSpot {
  std::optional<double> from_yaw_rad;  ///< empty: as it comes
  double to_yaw_rad = 0.0;
  double by_rad = 0.0;     ///< left positive; 0 where nobody knows from where
  double above_rad = 0.0;  ///< from nobody knows where: only if it points away by more than this
};

struct CourseStop {
  EnuPoint at;
  double s_m = 0.0;  ///< along the course
  int item = 0;      ///< that is there
  std::vector<TurnOnTheSpot> turns{};
};

struct CourseStops {
  std::vector<CourseStop> stops;  ///< in order; the begin is one of them
  std::size_t left_out = 0;       ///< stops and turns behind the ones that are told
};

/// In the order of driving, jumps left out. How the robot comes to the begin, and to where it goes
/// on behind what has no place (home, a move, what is driven by sight), nobody knows before.
/// @param most of stops and turns together. Linear in the steps.
CourseStops stops_of(const Course& course, std::size_t most);

}  // namespace roverd::nav
