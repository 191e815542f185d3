#pragma once
// The planar scan out of a cloud, and the simple stop by counted rays (RaysParams): an alternative
// to protect.hpp for robots that only ever look ahead.

#include <cstdint>
#include <vector>

#include "base/result.hpp"
#include "nav/sense/params.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

/// A ray of the scan.
struct Ray {
  float bearing_rad = 0.0F;  ///< in B, left positive
  float range_m = 0.0F;      ///< from the sensor; far_as_m where nothing within far_m was met
  bool endless = true;       ///< nothing within far_m
};

/// Numbers that contradict each other: a stop that could never come. Invalid; the field is its key.
base::Result<void> check(const RaysParams& params);

/// The nearest voxel of every step, from right to left, -fan to +fan. Of all voxels but Clear and
/// Passing within ±band of the sensor's height, nearer than blind_m left out.
/// @param out its buffer is used again.
void rays_of(const Reduced& in, const RaysParams& params, std::vector<Ray>& out);

struct Counted {
  int rays = 0;              ///< within the stopping fan and shorter than stop_m
  float nearest_m = 0.0F;    ///< of those; 0: none
  float nearest_rad = 0.0F;  ///< its bearing in B, left positive
  bool stop = false;         ///< as many as stop_rays, or more
};
/// @param rays of rays_of().
Counted count_rays(const std::vector<Ray>& rays, const RaysParams& params) noexcept;

/// How near the rule is to its stop.
struct Nearing {
  int rays = 0;              ///< within the stopping fan and shorter than slow_m
  float nearest_m = 0.0F;    ///< of those; 0: none
  float nearest_rad = 0.0F;  ///< its bearing in B, left positive
  float way_m = 0.0F;        ///< so much nearer, and stop_rays of them are shorter than stop_m
  bool slows = false;        ///< there are as many as stop_rays
};
/// @param rays of rays_of(). @param ranges its buffer is used again
Nearing nearing(const std::vector<Ray>& rays, const RaysParams& params, std::vector<float>& ranges);

/// Mean of the n leftmost and rightmost rays that are not endless, for centring between rows.
struct Sides {
  float left_m = 0.0F;
  float right_m = 0.0F;
  int left = 0;  ///< rays that counted
  int right = 0;
};
Sides sides_of(const std::vector<Ray>& rays, int n) noexcept;

}  // namespace roverd::nav::sense
