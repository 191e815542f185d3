#pragma once
// Poles, posts and cones of a planar scan, by their shape: a few neighbouring hits that stand
// apart from all else and lie on a circle of a fitting radius.
//
//   ···        ···   what is behind, at least isolated_m away
//       . ⌒ .        hits on the near side of a circle
//         ▲ sensor
//
// Pure; O(n). Frame: that of the scan.

#include <vector>

#include "nav/marks/params.hpp"
#include "nav/marks/scan.hpp"

namespace roverd::nav::marks {

struct Post {
  Vec2 at{};              ///< its middle
  double radius_m = 0.0;  ///< of what the plane of the scan cuts; 0: three hits tell none
  double sigma_m = 0.0;   ///< 1σ of its place, each way
  std::size_t points = 0;
};

/// @return in the order of the scan. What touches the scan's first or last beam is left out: it may
/// go on there.
std::vector<Post> posts_of(const PlanarScan& scan, const LandmarkParams& params);

}  // namespace roverd::nav::marks
