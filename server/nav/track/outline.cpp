#include "nav/track/outline.hpp"

#include <algorithm>

#include "nav/track/sleeve.hpp"

namespace roverd::nav {

namespace {

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
