#include "base/geo.hpp"

#include <cmath>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>

namespace roverd::base {
namespace {

using GeographicLib::Geodesic;
using GeographicLib::LocalCartesian;

LocalCartesian cartesian(LatLon origin, double height_m) {
  return LocalCartesian(origin.lat, origin.lon, height_m);
}

}  // namespace

bool is_valid(LatLon p) noexcept {
  return std::isfinite(p.lat) && std::isfinite(p.lon) && std::abs(p.lat) <= 90.0 &&
         std::abs(p.lon) <= 180.0;
}

LocalFrame::LocalFrame(std::uint32_t id, LatLon origin, double height_m) noexcept
    : id_(id), origin_(origin), height_m_(height_m) {}

EnuPoint LocalFrame::to_local(LatLon p) const noexcept {
  EnuPoint out;
  double up_m = 0.0;
  cartesian(origin_, height_m_).Forward(p.lat, p.lon, height_m_, out.east_m, out.north_m, up_m);
  return out;
}

LatLon LocalFrame::to_global(EnuPoint p) const noexcept {
  // The plane point lies above the ellipsoid's surface by about d²/2R. Correcting "up" once more
  // from the height that comes back puts it at the datum's height, as to_local projected it.
  const LocalCartesian plane = cartesian(origin_, height_m_);
  LatLon out;
  double up_m = 0.0;
  for (int i = 0; i < 3; ++i) {
    double height_m = 0.0;
    plane.Reverse(p.east_m, p.north_m, up_m, out.lat, out.lon, height_m);
    up_m -= height_m - height_m_;
  }
  return out;
}

DistanceBearing distance_bearing(LatLon from, LatLon to) noexcept {
  double distance_m = 0.0;
  double azimuth_from_deg = 0.0;
  double azimuth_to_deg = 0.0;
  Geodesic::WGS84().Inverse(from.lat, from.lon, to.lat, to.lon, distance_m, azimuth_from_deg,
                            azimuth_to_deg);
  if (distance_m == 0.0) return {};
  const double wrapped = azimuth_from_deg < 0.0 ? azimuth_from_deg + 360.0 : azimuth_from_deg;
  return {distance_m, wrapped >= 360.0 ? 0.0 : wrapped};
}

LatLon destination(LatLon from, double bearing_deg, double distance_m) noexcept {
  LatLon out;
  Geodesic::WGS84().Direct(from.lat, from.lon, bearing_deg, distance_m, out.lat, out.lon);
  return out;
}

double distance_m(EnuPoint a, EnuPoint b) noexcept {
  return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m);
}

}  // namespace roverd::base
