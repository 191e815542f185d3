#include "mission/rows/ends.hpp"

#include <algorithm>
#include <cmath>

#include "base/tangent_plane.hpp"

namespace roverd::mission {
namespace {

constexpr double kLevel_m = 0.05;  // lanes on the border are cut a little inside of it

}  // namespace

LaneEnds::LaneEnds(const std::vector<std::array<LatLon, 2>>& lanes, double spacing_m)
    : spacing_m_(spacing_m) {
  if (lanes.empty()) return;
  const base::TangentPlane plane(lanes.front()[0]);
  const base::EnuPoint row = plane.to_local(lanes.front()[1]);
  const double length_m = std::hypot(row.east_m, row.north_m);
  if (!(length_m > 0.0)) return;
  const auto along_m = [&](const LatLon& place) {
    const base::EnuPoint p = plane.to_local(place);
    return (p.east_m * row.east_m + p.north_m * row.north_m) / length_m;
  };
  along_m_.reserve(lanes.size());
  for (const auto& [begin, end] : lanes) along_m_.push_back({along_m(begin), along_m(end)});
}

double LaneEnds::beyond_m(const LaneLeft& from, int lane) const noexcept {
  const auto known = static_cast<int>(along_m_.size());
  if (lane < 1 || lane > known || from.lane < 1 || from.lane > known) return 0.0;
  const auto& ours = along_m_[static_cast<std::size_t>(from.lane) - 1];
  const auto& theirs = along_m_[static_cast<std::size_t>(lane) - 1];
  const double by_m = from.forth ? theirs[1] - ours[1] : ours[0] - theirs[0];
  return std::abs(by_m) < kLevel_m ? 0.0 : by_m;
}

int LaneEnds::beside(const LaneLeft& from, double right_m) const noexcept {
  const auto lanes = static_cast<int>(std::lround(right_m / spacing_m_));
  return from.lane + (from.grows_right ? lanes : -lanes);
}

double LaneEnds::farther_m(const LaneLeft& from, std::span<const TurnPoint> turn,
                           double clear_m) const {
  double farther_m = 0.0;
  for (const TurnPoint& p : turn) {
    const int lane = beside(from, p.right_m);
    const double reaches_m = beyond_m(from, lane);
    if (lane != from.lane && reaches_m != 0.0) {
      farther_m = std::max(farther_m, reaches_m + clear_m - p.ahead_m);
    }
  }
  return farther_m;
}

double LaneEnds::deepest_m(const LaneLeft& from, std::span<const TurnPoint> turn,
                           double farther_m) const {
  const int last = std::max(1, static_cast<int>(along_m_.size()));
  double deepest_m = 0.0;
  for (const TurnPoint& p : turn) {
    const double border_m = beyond_m(from, std::clamp(beside(from, p.right_m), 1, last));
    deepest_m = std::max(deepest_m, p.ahead_m + farther_m - border_m);
  }
  return deepest_m;
}

}  // namespace roverd::mission
