#pragma once
// How much of a field a path covers. Pure.

#include <vector>

#include "mission/survey/area.hpp"

namespace roverd::mission::survey {

struct Cover {
  double covered = 0.0;    ///< share of the field that is within reach of the path
  double reachable = 0.0;  ///< … of the area where the path may be
};

/// By 100,000 points spread evenly over the field's box (quasi-random: M. Roberts 2018, R2), about
/// as many looked at within the field: good to about 0.1 %. @param path at least one point
Cover cover_of(const Area& field, const Area& drivable, const std::vector<EnuPoint>& path,
               double reach_m);

}  // namespace roverd::mission::survey
