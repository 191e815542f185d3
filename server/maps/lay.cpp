#include "maps/lay.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/angle.hpp"

namespace roverd::maps {

namespace {

struct Middle {
  double x_m = 0.0;
  double y_m = 0.0;
};

}  // namespace

std::optional<Anchor> laid(std::span<const SeenAt> seen) {
  if (seen.size() < kLeastSeen) return std::nullopt;
  const double n = static_cast<double>(seen.size());
  const base::LocalFrame frame(1, seen.front().at);
  Middle m;
  Middle e;
  double sigma_m = 0.0;
  for (const SeenAt& s : seen) {
    const base::EnuPoint p = frame.to_local(s.at);
    m.x_m += s.in_map.x_m / n;
    m.y_m += s.in_map.y_m / n;
    e.x_m += p.east_m / n;
    e.y_m += p.north_m / n;
    sigma_m += s.sigma_m / n;
  }
  double dot = 0.0;
  double cross = 0.0;
  double spread2 = 0.0;
  for (const SeenAt& s : seen) {
    const base::EnuPoint p = frame.to_local(s.at);
    const double x = s.in_map.x_m - m.x_m;
    const double y = s.in_map.y_m - m.y_m;
    dot += x * (p.east_m - e.x_m) + y * (p.north_m - e.y_m);
    cross += x * (p.north_m - e.y_m) - y * (p.east_m - e.x_m);
    spread2 += (x * x + y * y) / n;
  }
  const double spread_m = std::sqrt(spread2);
  if (!(spread_m >= kLeastSpread_m) || std::hypot(dot, cross) <= 0.0) return std::nullopt;
  const double yaw = std::atan2(cross, dot);
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const base::EnuPoint origin{e.x_m - c * m.x_m + s * m.y_m, e.y_m - s * m.x_m - c * m.y_m};
  double left2 = 0.0;
  for (const SeenAt& one : seen) {
    const base::EnuPoint p = frame.to_local(one.at);
    const double x = origin.east_m + c * one.in_map.x_m - s * one.in_map.y_m - p.east_m;
    const double y = origin.north_m + s * one.in_map.x_m + c * one.in_map.y_m - p.north_m;
    left2 += (x * x + y * y) / n;
  }
  const double off_m = std::hypot(std::sqrt(left2), sigma_m);
  Anchor out;
  out.at = frame.to_global(origin);
  out.heading_deg = base::heading_from_yaw(yaw);
  out.heading_accuracy_deg = base::deg_from_rad(off_m / spread_m);
  // The origin may lie far from where the robot was.
  out.accuracy_m = std::hypot(off_m, off_m / spread_m * std::hypot(m.x_m, m.y_m));
  if (!(out.accuracy_m <= 10.0 && out.heading_accuracy_deg <= 45.0)) return std::nullopt;
  return out;
}

}  // namespace roverd::maps
