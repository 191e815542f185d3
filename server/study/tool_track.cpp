#include "study/tool_track.hpp"

#include <cmath>

#include "base/angle.hpp"

namespace roverd::study {
namespace {

base::EnuPoint seen_from(base::EnuPoint at, double yaw_rad, double forward_m, double left_m) {
  return {at.east_m + forward_m * std::cos(yaw_rad) - left_m * std::sin(yaw_rad),
          at.north_m + forward_m * std::sin(yaw_rad) + left_m * std::cos(yaw_rad)};
}

}  // namespace

std::vector<nav::DrivenPoint> tool_track(std::span<const nav::DrivenPoint> vehicle,
                                         const nav::ToolParams& tool) {
  std::vector<nav::DrivenPoint> track(vehicle.begin(), vehicle.end());
  if (!tool.pulled()) {
    for (nav::DrivenPoint& p : track) {
      p.at = seen_from(p.at, p.yaw_rad, tool.forward_m, tool.left_m);
    }
    return track;
  }
  double yaw_rad = track.empty() ? 0.0 : track.front().yaw_rad;
  base::EnuPoint before{};
  for (std::size_t i = 0; i < track.size(); ++i) {
    nav::DrivenPoint& p = track[i];
    const base::EnuPoint coupling = seen_from(p.at, p.yaw_rad, -tool.hitch_m, 0.0);
    if (i > 0) {
      const base::EnuPoint by = coupling - before;
      yaw_rad += (by.north_m * std::cos(yaw_rad) - by.east_m * std::sin(yaw_rad)) / tool.trailer_m;
    }
    before = coupling;
    p.yaw_rad = base::wrap_rad(yaw_rad);
    p.at = seen_from(coupling, yaw_rad, -tool.trailer_m, tool.left_m);
  }
  return track;
}

}  // namespace roverd::study
