#pragma once
// Positions on earth and in local metres. All geodesy is GeographicLib's; nothing here derives it.

#include <cstdint>
#include <optional>

#include "base/result.hpp"

namespace roverd::base {

/// WGS84, degrees. lat in [−90, 90], lon in [−180, 180].
struct LatLon {
  double lat = 0.0;
  double lon = 0.0;
  friend bool operator==(const LatLon&, const LatLon&) = default;
};

/// Metres east and north in one LocalFrame. Values of two frames must not be mixed.
struct EnuPoint {
  double east_m = 0.0;
  double north_m = 0.0;
  friend bool operator==(const EnuPoint&, const EnuPoint&) = default;
};

/// Body frame FLU: forward, left, up.
struct BodyTwist {
  double linear_mps = 0.0;     ///< forward positive
  double angular_radps = 0.0;  ///< counter-clockwise (left) positive
  friend bool operator==(const BodyTwist&, const BodyTwist&) = default;
};

/// finite and in range
bool is_valid(LatLon p) noexcept;

/// A tangent plane (ENU) at a datum on the WGS84 ellipsoid. Points are projected at the datum's
/// height, so equal lat/lon meet whatever a receiver says of altitude. Exact to below 1 mm over a
/// round trip of 10 km; beyond that north turns noticeably and callers must refuse.
/// Immutable, cheap to copy, thread-safe.
class LocalFrame {
 public:
  static constexpr double kReach_m = 10'000.0;

  /// @param id distinguishes frames; 0 is never used. @param origin valid (is_valid).
  LocalFrame(std::uint32_t id, LatLon origin, double height_m = 0.0) noexcept;

  std::uint32_t id() const noexcept { return id_; }
  LatLon origin() const noexcept { return origin_; }
  double height_m() const noexcept { return height_m_; }

  EnuPoint to_local(LatLon p) const noexcept;
  LatLon to_global(EnuPoint p) const noexcept;

 private:
  std::uint32_t id_;
  LatLon origin_;
  double height_m_;
};

struct DistanceBearing {
  double distance_m = 0.0;
  double bearing_deg = 0.0;  ///< compass, [0, 360); 0 when the points coincide
};

/// Geodesic on the ellipsoid, any two valid points.
DistanceBearing distance_bearing(LatLon from, LatLon to) noexcept;
/// The point a geodesic reaches from `from`.
LatLon destination(LatLon from, double bearing_deg, double distance_m) noexcept;

inline EnuPoint operator+(EnuPoint a, EnuPoint b) noexcept {
  return {a.east_m + b.east_m, a.north_m + b.north_m};
}
inline EnuPoint operator-(EnuPoint a, EnuPoint b) noexcept {
  return {a.east_m - b.east_m, a.north_m - b.north_m};
}
/// Euclidean, same frame.
double distance_m(EnuPoint a, EnuPoint b) noexcept;

}  // namespace roverd::base
