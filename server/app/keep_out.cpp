#include "app/keep_out.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "base/angle.hpp"
#include "base/geo.hpp"

namespace roverd {

namespace {

/// Half of what a fence may have: one may be chosen beside them.
constexpr std::size_t kMostCornersTogether = mission::kMaxFencePoints / 2;
/// What check_fence takes for something, and what the earth's shape may take off.
constexpr double kLeast_m2 = 0.011;

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

/// No wider than a hand anywhere: nobody could stand in it.
bool covers_nothing(const maps::Area& area) {
  const maps::Area hull = hull_of(area);
  double twice_m2 = 0.0;
  for (std::size_t i = 2; i < hull.size(); ++i) twice_m2 += turn_of(hull[0], hull[i - 1], hull[i]);
  return twice_m2 / 2.0 < kLeast_m2;
}

std::size_t corners_of(const mission::FenceArea& area) {
  return std::get<mission::FencePolygon>(area.shape).points.size();
}

/// Empty: no fence may have it.
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

KeepOut keep_out_of(const std::vector<maps::Area>& forbidden, const maps::Anchor& anchor) {
  const base::LocalFrame frame(1, anchor.at);
  const double yaw_rad = base::yaw_from_heading(anchor.heading_deg);
  std::size_t corners = 0;
  for (const maps::Area& area : forbidden) corners += area.size();
  const bool simply = corners > kMostCornersTogether;
  KeepOut out;
  std::size_t held = 0;
  for (const maps::Area& area : forbidden) {
    auto one = simply ? std::nullopt : area_of(area, frame, yaw_rad);
    if (!one) one = area_of(hull_of(area), frame, yaw_rad);
    if (!one && covers_nothing(area)) continue;
    const std::size_t more = one ? corners_of(*one) : 0;
    if (!one || held + more > kMostCornersTogether || out.areas.size() == mission::kMaxAreas) {
      ++out.left_out;
      continue;
    }
    held += more;
    out.areas.push_back(std::move(*one));
  }
  return out;
}

}  // namespace roverd
