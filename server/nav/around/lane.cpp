#include "nav/around/lane.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav::around {

namespace {

double from_chord_m(Vec2 p, Vec2 a, Vec2 b) noexcept {
  const Vec2 e = b - a;
  const double length2 = dot(e, e);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, e) / length2, 0.0, 1.0) : 0.0;
  const Vec2 off = p - a - t * e;
  return std::hypot(off.x, off.y);
}

}  // namespace

/// Douglas and Peucker's thinning, without recursion.
void Lane::lay(std::span<const Vec2> route) {
  all_.clear();
  points_.clear();
  double along = 0.0;
  for (const Vec2 p : route) {
    if (!all_.empty()) {
      const Vec2 d = p - all_.back().at;
      const double step = std::hypot(d.x, d.y);
      along += step;
      if (step < 1e-3) continue;
    }
    all_.push_back({p, along});
  }
  if (all_.size() < 2) return;
  kept_.assign(all_.size(), false);
  kept_.front() = kept_.back() = true;
  open_.assign(1, {0, all_.size() - 1});
  while (!open_.empty()) {
    const auto [a, b] = open_.back();
    open_.pop_back();
    double most = kStraight_m;
    std::size_t at = 0;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double d = from_chord_m(all_[i].at, all_[a].at, all_[b].at);
      if (d > most) {
        most = d;
        at = i;
      }
    }
    if (at == 0) continue;
    kept_[at] = true;
    open_.emplace_back(a, at);
    open_.emplace_back(at, b);
  }
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (kept_[i]) points_.push_back(all_[i]);
  }
}

std::size_t Lane::segment(double along_m) const noexcept {
  const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, along_m,
                                      [](double s, const Point& p) { return s < p.along_m; });
  return static_cast<std::size_t>(after - points_.begin()) - 1;
}

Vec2 Lane::at(double along_m) const noexcept {
  const std::size_t i = segment(along_m);
  const Point& a = points_[i];
  const Point& b = points_[i + 1];
  const double t = std::clamp((along_m - a.along_m) / (b.along_m - a.along_m), 0.0, 1.0);
  return a.at + t * (b.at - a.at);
}

Pose2 Lane::pose(double along_m) const noexcept {
  const double s = std::clamp(along_m, points_.front().along_m, end_m());
  const Vec2 p = at(s);
  const Vec2 d = at(s + 0.05) - at(s - 0.05);
  return {p.x, p.y, std::atan2(d.y, d.x)};
}

Beside Lane::beside(Vec2 p, std::size_t i) const noexcept {
  const Point& a = points_[i];
  const Point& b = points_[i + 1];
  const Vec2 e = b.at - a.at;
  const Vec2 d = p - a.at;
  const double t = std::clamp(dot(d, e) / dot(e, e), 0.0, 1.0);
  const Vec2 off = d - t * e;
  const double distance = std::sqrt(dot(off, off));
  return {a.along_m + t * (b.along_m - a.along_m), cross(e, d) < 0.0 ? -distance : distance,
          distance};
}

Beside Lane::beside(Vec2 p) const noexcept {
  Beside best = beside(p, 0);
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    const Beside b = beside(p, i);
    if (b.distance_m < best.distance_m) best = b;
  }
  return best;
}

}  // namespace roverd::nav::around
