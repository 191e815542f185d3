#include "nav/marks/ends.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace roverd::nav::marks {
namespace {

constexpr double kOneEnd_m = 0.3;
/// A ray must cross the line so close beyond the end: farther on the wall may be there again.
constexpr double kBeyond_m = 0.5;
/// Behind the line by more than this, growing with the range, and by the wall's own roughness.
constexpr double kDeep_m = 0.06;
constexpr double kDeepPerMetre = 0.02;
constexpr double kRough = 3.0;
constexpr int kMostOfAScan = 3;  // one scan alone is no witness
constexpr std::size_t kMostEnds = 16;

struct Edge {
  double wall_m = 0.0;  ///< where the wall is known to reach
  double scan_m = 0.0;  ///< where this scan sees it end
  bool ahead = false;
  int hits = 0;
};

Edge edge_of(const Stretch& s, bool ahead, std::span<const Stretch> now) noexcept {
  const double at_m = ahead ? s.to_m : s.from_m;
  Edge edge{at_m, at_m, ahead, 0};
  double least_m = kOneEnd_m;
  for (const Stretch& n : now) {
    const double now_m = ahead ? n.to_m : n.from_m;
    if (std::abs(now_m - at_m) > least_m) continue;
    least_m = std::abs(now_m - at_m);
    edge.scan_m = now_m;
  }
  return edge;
}

}  // namespace

bool Wall::ends_at(double along_m, bool ahead) const noexcept {
  return std::ranges::any_of(ends, [&](const SeenEnd& e) {
    return e.ahead == ahead && e.hits >= kEndsHits && std::abs(e.at_m - along_m) < kOneEnd_m;
  });
}

void tell_end(Wall& wall, const SeenEnd& end) {
  for (SeenEnd& e : wall.ends) {
    if (e.ahead != end.ahead || std::abs(e.at_m - end.at_m) > kOneEnd_m) continue;
    // It stands where it was seen last: the way counted may be off by then.
    e.at_m = end.at_m;
    e.hits = std::min(kEndsHits, e.hits + end.hits);
    return;
  }
  if (wall.ends.size() == kMostEnds) wall.ends.erase(wall.ends.begin());
  wall.ends.push_back(end);
}

void look_past(Wall& wall, std::span<const Stretch> now, double rms_m, const PlanarScan& scan) {
  const Vec2 eye = placed(scan.pose, scan.eye);
  const double eye_m = wall.distance_m(eye);
  if (eye_m <= 0.0) return;
  std::vector<Edge> edges;
  for (const Stretch& s : wall.seen) {
    for (const bool ahead : {false, true}) edges.push_back(edge_of(s, ahead, now));
  }
  for (const Beam& beam : scan.beams) {
    if (!beam.echo) continue;
    const Vec2 hit = placed(scan.pose, beam.at);
    const double hit_m = wall.distance_m(hit);
    if (-hit_m < std::max(kDeep_m, kRough * rms_m) + kDeepPerMetre * beam.range_m) continue;
    const Vec2 met = eye + (eye_m / (eye_m - hit_m)) * (hit - eye);
    const double at_m = sense::dot(wall.along, met - wall.anchor);
    for (Edge& e : edges) {
      const double beyond_m = e.ahead ? at_m - e.scan_m : e.scan_m - at_m;
      if (beyond_m > 0.0 && beyond_m < kBeyond_m) ++e.hits;
    }
  }
  for (const Edge& e : edges) {
    if (e.hits > 0) tell_end(wall, {e.wall_m, e.ahead, std::min(e.hits, kMostOfAScan)});
  }
}

}  // namespace roverd::nav::marks
