#include "nav/sense/polar.hpp"

#include <cmath>

namespace roverd::nav::sense {

void polar_of(const Patch& patch, const Pose2& pose, const Footprint& body, double range_m,
              Polar& out) {
  out.stamp = patch.stamp;
  const double x0 = pose.x_m / patch.cell_m;
  const double y0 = pose.y_m / patch.cell_m;
  const auto steps = static_cast<int>(range_m / patch.cell_m);
  for (std::size_t i = 0; i < Polar::kBearings; ++i) {
    Bearing& b = out.of[i];
    b = {};
    const double angle = bearing_rad(i);
    const Vec2 ahead{std::cos(angle), std::sin(angle)};
    const double dx = std::cos(pose.yaw_rad + angle);
    const double dy = std::sin(pose.yaw_rad + angle);
    // The body ends where its edge crosses this direction: found by halves, it is convex.
    double inside = 0.0;
    double outside = body.reach_m() + patch.cell_m;
    for (int n = 0; n < 8; ++n) {
      const double middle = 0.5 * (inside + outside);
      (body.distance_m(middle * ahead) < 0.0 ? inside : outside) = middle;
    }
    bool gap = false;
    for (int n = static_cast<int>(outside / patch.cell_m) + 1; n < steps; ++n) {
      const Patch::Cell c = patch.at(static_cast<std::int32_t>(std::floor(x0 + dx * n)),
                                     static_cast<std::int32_t>(std::floor(y0 + dy * n)));
      const auto here = static_cast<float>(n * patch.cell_m);
      if (c.known == Known::Occupied || c.known == Known::Drop) {
        b.hit_m = here;
        b.sensor = c.sensor;
        b.age_ds = c.age_ds;
        break;
      }
      if (c.known == Known::Unknown) gap = true;
      if (gap) continue;
      b.free_m = here;
      b.sensor = c.sensor;
      b.age_ds = c.age_ds;
    }
  }
}

}  // namespace roverd::nav::sense
