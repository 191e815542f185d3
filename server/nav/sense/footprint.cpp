#include "nav/sense/footprint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace roverd::nav::sense {

base::Result<Footprint> Footprint::of(std::span<const Vec2> corners) {
  using base::Code;
  std::vector<Vec2> p(corners.begin(), corners.end());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!(std::abs(p[i].x) <= 20.0 && std::abs(p[i].y) <= 20.0)) {
      return base::fail(Code::Invalid, "a corner of the footprint lies beyond 20 m",
                        {{"/" + std::to_string(i), "must lie within 20 m of the origin"}});
    }
  }
  std::sort(p.begin(), p.end(),
            [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  // Andrew's monotone chain: the lower side from left to right, then the upper one back.
  std::vector<Vec2> hull;
  const auto add = [&hull](Vec2 q, std::size_t keep) {
    while (hull.size() >= keep + 2 &&
           cross(hull.back() - hull[hull.size() - 2], q - hull.back()) <= 1e-12) {
      hull.pop_back();
    }
    hull.push_back(q);
  };
  for (const Vec2 q : p) add(q, 0);
  const std::size_t lower = hull.empty() ? 0 : hull.size() - 1;
  for (auto q = p.rbegin(); q != p.rend(); ++q) {
    if (q != p.rbegin()) add(*q, lower);
  }
  if (!hull.empty()) hull.pop_back();
  if (hull.size() < 3) return base::fail(Code::Invalid, "the footprint has no area");
  if (hull.size() > kMaxCorners) {
    return base::fail(Code::TooLarge, "the footprint has more than 16 corners");
  }
  Footprint f;
  std::copy(hull.begin(), hull.end(), f.corners_.begin());
  f.size_ = hull.size();
  f.finish();
  return f;
}

Footprint Footprint::box(double length_m, double width_m, double back_m) noexcept {
  Footprint f;
  const double front = length_m - back_m;
  const double side = 0.5 * width_m;
  f.corners_[0] = {-back_m, -side};
  f.corners_[1] = {front, -side};
  f.corners_[2] = {front, side};
  f.corners_[3] = {-back_m, side};
  f.size_ = 4;
  f.finish();
  return f;
}

Footprint Footprint::turned(double rad) const noexcept {
  const double c = std::cos(rad);
  const double s = std::sin(rad);
  Footprint out = *this;
  for (Vec2& p : out.corners_) p = {c * p.x - s * p.y, s * p.x + c * p.y};
  return out;
}

void Footprint::finish() noexcept {
  for (const Vec2 c : corners()) reach_m_ = std::max(reach_m_, std::hypot(c.x, c.y));
}

double Footprint::distance_m(Vec2 p) const noexcept {
  double inside = -std::numeric_limits<double>::infinity();
  double outside2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size_; ++i) {
    const Vec2 a = corners_[i];
    const Vec2 e = corners_[i + 1 == size_ ? 0 : i + 1] - a;
    const Vec2 d = p - a;
    const double length2 = dot(e, e);
    inside = std::max(inside, -cross(e, d) / std::sqrt(length2));
    const Vec2 off = d - std::clamp(dot(d, e) / length2, 0.0, 1.0) * e;
    outside2 = std::min(outside2, dot(off, off));
  }
  return inside <= 0.0 ? inside : std::sqrt(outside2);
}

}  // namespace roverd::nav::sense
