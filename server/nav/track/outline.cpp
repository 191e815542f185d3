#include "nav/track/outline.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {

namespace {

/// The directions from one point that pass all points since within the tolerance.
class Sleeve {
 public:
  explicit Sleeve(EnuPoint from) : from_(from) {}

  /// @return false: no direction passes this one as well, or it lies back
  bool take(EnuPoint to, double within_m) {
    const double east = to.east_m - from_.east_m;
    const double north = to.north_m - from_.north_m;
    const double away = std::hypot(east, north);
    if (!open_ && away <= within_m) return true;  // none yet is farther than makes a difference
    if (away < farthest_m_) return false;
    farthest_m_ = away;
    if (away <= within_m) return true;
    const double yaw = std::atan2(north, east);
    const double half = std::asin(within_m / away);
    if (!open_) {
      open_ = true;
      middle_ = yaw;
      low_ = -half;
      high_ = half;
      return true;
    }
    const double turn = base::wrap_rad(yaw - middle_);
    const bool passes = turn >= low_ && turn <= high_;
    low_ = std::max(low_, turn - half);
    high_ = std::min(high_, turn + half);
    return passes;
  }

 private:
  EnuPoint from_;
  double farthest_m_ = 0.0;
  bool open_ = false;
  double middle_ = 0.0;
  double low_ = 0.0;  ///< from the middle
  double high_ = 0.0;
};

std::vector<EnuPoint> thinned(const std::vector<PathPoint>& way, double within_m,
                              std::size_t most) {
  std::vector<EnuPoint> kept;
  if (way.empty()) return kept;
  kept.push_back(way.front().at);
  Sleeve sleeve(kept.back());
  for (std::size_t i = 1; i < way.size() && kept.size() <= most; ++i) {
    if (sleeve.take(way[i].at, within_m)) continue;
    kept.push_back(way[i - 1].at);
    sleeve = Sleeve(kept.back());
    (void)sleeve.take(way[i].at, within_m);
  }
  kept.push_back(way.back().at);
  return kept;
}

}  // namespace

Outline outline(const Path& path, double within_m, std::size_t most) {
  Outline out{thinned(path.points, within_m, most), within_m};
  while (out.points.size() > std::max<std::size_t>(most, 2)) {
    out.within_m *= 2.0;
    out.points = thinned(path.points, out.within_m, most);
  }
  return out;
}

}  // namespace roverd::nav
