#include "app/keep_out.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/angle.hpp"
#include "base/geo.hpp"

namespace roverd {

namespace {

double turn_of(const maps::Corner& a, const maps::Corner& b, const maps::Corner& c) noexcept {
  return (b.x_m - a.x_m) * (c.y_m - a.y_m) - (b.y_m - a.y_m) * (c.x_m - a.x_m);
}

/// Source: Andrew 1979, the monotone chain.
maps::Area hull_of(maps::Area corners) {
  std::sort(corners.begin(), corners.end(), [](const maps::Corner& a, const maps::Corner& b) {
    return std::pair(a.x_m, a.y_m) < std::pair(b.x_m, b.y_m);
  });
  maps::Area out;
  const auto chain = [&out](const maps::Corner& next, std::size_t from) {
    while (out.size() >= from + 2 && turn_of(out[out.size() - 2], out.back(), next) <= 0.0) {
      out.pop_back();
    }
    out.push_back(next);
  };
  for (const maps::Corner& c : corners) chain(c, 0);
  const std::size_t lower = out.empty() ? 0 : out.size() - 1;
  for (auto c = corners.rbegin(); c != corners.rend(); ++c) chain(*c, lower);
  if (!out.empty()) out.pop_back();
  return out;
}

/// Empty: it covers nothing.
std::optional<mission::FenceArea> area_of(const maps::Area& ring, const base::LocalFrame& frame,
                                          double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  mission::FencePolygon polygon;
  for (const maps::Corner& p : ring) {
    polygon.points.push_back(frame.to_global({c * p.x_m - s * p.y_m, s * p.x_m + c * p.y_m}));
  }
  mission::FenceArea out{mission::AreaKind::Exclusion, std::move(polygon)};
  if (!mission::check_fence({"forbidden", {out}, {}})) return std::nullopt;
  return out;
}

}  // namespace

std::vector<mission::FenceArea> keep_out_of(const std::vector<maps::Area>& forbidden,
                                            const maps::Anchor& anchor) {
  const base::LocalFrame frame(1, anchor.at);
  const double yaw_rad = base::yaw_from_heading(anchor.heading_deg);
  std::vector<mission::FenceArea> out;
  for (const maps::Area& area : forbidden) {
    auto one = area_of(area, frame, yaw_rad);
    if (!one) one = area_of(hull_of(area), frame, yaw_rad);
    if (one) out.push_back(std::move(*one));
  }
  return out;
}

}  // namespace roverd
