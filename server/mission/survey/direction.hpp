#pragma once
// In which direction tracks run. Pure.

#include "mission/survey/area.hpp"

namespace roverd::mission::survey {

/// A plane turned so that its first axis looks along `yaw_rad` of the old one.
class Rotation {
 public:
  explicit Rotation(double yaw_rad) noexcept;

  EnuPoint forth(EnuPoint p) const noexcept {
    return {p.east_m * c_ + p.north_m * s_, p.north_m * c_ - p.east_m * s_};
  }
  EnuPoint back(EnuPoint p) const noexcept {
    return {p.east_m * c_ - p.north_m * s_, p.north_m * c_ + p.east_m * s_};
  }
  Area forth(const Area& area) const;

 private:
  double c_;
  double s_;
};

/// The direction in which a cover of the area costs least: driven metres, and for each turn and
/// each new cell some more. Tried are the directions of the longest edges and every 15°.
/// @return compass, [0, 180)
double best_direction_deg(const Area& area, double spacing_m);

}  // namespace roverd::mission::survey
