#include "base/geo.hpp"

#include <cmath>

#include <GeographicLib/Geodesic.hpp>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"

namespace roverd::base {
namespace {

using GeographicLib::Geodesic;

/// The plane of the last frame that this thread asked about: to prepare one costs ten times a
/// point, and a thread hardly ever has two frames in hand.
const TangentPlane& plane_of(LatLon origin, double height_m) noexcept {
  struct Last {
    LatLon origin;
    double height_m;
    TangentPlane plane;
  };
  thread_local Last last{{}, 0.0, TangentPlane({}, 0.0)};
  const bool same =
      last.origin.lat == origin.lat && last.origin.lon == origin.lon && last.height_m == height_m;
  if (!same) last = {origin, height_m, TangentPlane(origin, height_m)};
  return last.plane;
}

}  // namespace

bool is_valid(LatLon p) noexcept {
  return std::isfinite(p.lat) && std::isfinite(p.lon) && std::abs(p.lat) <= 90.0 &&
         std::abs(p.lon) <= 180.0;
}

LocalFrame::LocalFrame(std::uint32_t id, LatLon origin, double height_m) noexcept
    : id_(id), origin_(origin), height_m_(height_m) {}

EnuPoint LocalFrame::to_local(LatLon p) const noexcept {
  return plane_of(origin_, height_m_).to_local(p);
}

LatLon LocalFrame::to_global(EnuPoint p) const noexcept {
  return plane_of(origin_, height_m_).to_global(p);
}

TangentPlane::TangentPlane(LatLon origin, double height_m) noexcept
    : plane_(origin.lat, origin.lon, height_m),
      height_m_(height_m),
      east_radius_m_(0.0),
      north_radius_m_(0.0) {
  // N = a / √(1 − e² sin² lat), M = N (1 − e²) / (1 − e² sin² lat).
  const double f = Geodesic::WGS84().Flattening();
  const double square = f * (2.0 - f);
  const double sin_lat = std::sin(rad_from_deg(origin.lat));
  const double rest = 1.0 - square * sin_lat * sin_lat;
  const double across_m = Geodesic::WGS84().EquatorialRadius() / std::sqrt(rest);
  east_radius_m_ = across_m + height_m;
  north_radius_m_ = across_m * (1.0 - square) / rest + height_m;
}

EnuPoint TangentPlane::to_local(LatLon p) const noexcept {
  EnuPoint out;
  double up_m = 0.0;
  plane_.Forward(p.lat, p.lon, height_m_, out.east_m, out.north_m, up_m);
  return out;
}

LatLon TangentPlane::to_global(EnuPoint p) const noexcept {
  // The plane point lies above the ellipsoid's surface by e²/2N + n²/2M, to 0.05 mm within 10 km.
  // Correcting "up" from the height that comes back puts it at the datum's height, as to_local
  // projected it. A height that is wrong by h moves the point by h·d/R: below 0.1 µm it is good,
  // which within 10 km it is at once.
  constexpr double kGood_m = 1e-7;
  const double east_slope = p.east_m / east_radius_m_;
  const double north_slope = p.north_m / north_radius_m_;
  // hypot() would cost a tenth of all this, to guard against overflow that cannot be here.
  const double slope = std::sqrt(east_slope * east_slope + north_slope * north_slope);
  LatLon out;
  double up_m = -0.5 * (p.east_m * east_slope + p.north_m * north_slope);
  for (int i = 0; i < 4; ++i) {
    double height_m = 0.0;
    plane_.Reverse(p.east_m, p.north_m, up_m, out.lat, out.lon, height_m);
    const double high_m = height_m - height_m_;
    if (std::abs(high_m) * slope < kGood_m) break;
    up_m -= high_m;
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
