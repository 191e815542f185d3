#pragma once
// The plane of a LocalFrame without its number, prepared once for many points.

#include <GeographicLib/LocalCartesian.hpp>

#include "base/geo.hpp"

namespace roverd::base {

/// East and north in metres on the plane that touches the WGS84 ellipsoid at `origin`, raised by
/// `height_m`. Points are projected along the plane's normal at that height, so distances from the
/// origin shrink by d³/6R²: 4 µm at 1 km, 4 mm at 10 km. There and back is exact to 1 µm within
/// 10 km; farther out callers must refuse. Immutable, thread-safe.
class TangentPlane {
 public:
  /// @param origin valid (is_valid).
  explicit TangentPlane(LatLon origin, double height_m = 0.0) noexcept;

  EnuPoint to_local(LatLon p) const noexcept;
  LatLon to_global(EnuPoint p) const noexcept;

 private:
  GeographicLib::LocalCartesian plane_;
  double height_m_;
  double east_radius_m_;   ///< of the ellipsoid's curvature at the origin, along its parallel
  double north_radius_m_;  ///< and along its meridian
};

}  // namespace roverd::base
