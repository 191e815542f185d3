#pragma once
// One piece of one sensor as the finding of rows needs it: what may be plants, and how far one sees
// in every direction.

#include <array>
#include <cstddef>
#include <vector>

#include "base/time.hpp"
#include "nav/rows/params.hpp"
#include "nav/sense/odometry.hpp"
#include "nav/sense/rays_rule.hpp"
#include "nav/sense/reduce.hpp"

namespace roverd::nav::rows {

struct RowScan {
  struct Point {
    float x_m = 0.0F;
    float y_m = 0.0F;
  };
  static constexpr std::size_t kBearings = 360;

  base::Time stamp;
  sense::Pose2 pose;     ///< X_OB then
  double eye_x_m = 0.0;  ///< of the sensor, in B
  double eye_y_m = 0.0;
  bool blind = false;         ///< dazzled, covered: it tells nothing
  std::vector<Point> points;  ///< in B: obstacles at the height of plants
  /// About the sensor, degrees of B from −180: so far a ray went at the height of plants before it
  /// met something; 0: none is known. One that ends on the ground went there as long as it was high
  /// enough, so where a missing echo tells nothing, the ground beyond does.
  std::array<float, kBearings> reach_m{};
  std::vector<sense::Ray> rays;  ///< the planar fan, for seeing by rays
  bool ahead = true;             ///< it looks into most of that fan at all

  /// How far one sees from the sensor towards a place of B.
  double reach_to(double x_m, double y_m) const noexcept;
};

/// @param in judged by the chain. @param out its buffers are used again.
void scan_of(const sense::Reduced& in, const RowParams& params, RowScan& out);

}  // namespace roverd::nav::rows
