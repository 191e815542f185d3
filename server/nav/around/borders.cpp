// The corridor and the fence, as room that is left to them. Exact in the middle of every coarse
// cell; tiles of 1 m first look which parts of a border can be nearest at all.
#include <algorithm>
#include <cmath>

#include "nav/around/field.hpp"

namespace roverd::nav::around {

namespace {

constexpr std::int32_t kTile = 10;  // coarse cells

double to_edge_m(Vec2 p, Vec2 a, Vec2 b) noexcept {
  const Vec2 e = b - a;
  const double length2 = dot(e, e);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, e) / length2, 0.0, 1.0) : 0.0;
  const Vec2 off = p - a - t * e;
  return std::sqrt(dot(off, off));
}

bool within(const Ring& ring, Vec2 p) noexcept {
  bool in = false;
  Vec2 a = ring.back();
  for (const Vec2 b : ring) {
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) in = !in;
    a = b;
  }
  return in;
}

}  // namespace

void Field::lay_corridor(const Question& q, const Lane& lane) {
  const auto n = static_cast<std::size_t>(n_);
  corridor_.resize(n * n);
  along_.resize(n * n);
  const double tile_m = kTile * coarse_m_;
  const double spread_m = 1.4143 * tile_m;
  const std::size_t segments = lane.points().size() - 1;
  std::vector<float>& distances = ring_;
  distances.resize(std::max(segments, n * n));
  for (std::int32_t ty = 0; ty < n_; ty += kTile) {
    for (std::int32_t tx = 0; tx < n_; tx += kTile) {
      const Vec2 c{x0_m_ + tx * coarse_m_ + 0.5 * tile_m, y0_m_ + ty * coarse_m_ + 0.5 * tile_m};
      double least = 1e9;
      for (std::size_t i = 0; i < segments; ++i) {
        const double d = lane.beside(c, i).distance_m;
        distances[i] = static_cast<float>(d);
        least = std::min(least, d);
      }
      near_.clear();
      for (std::size_t i = 0; i < segments; ++i) {
        if (static_cast<double>(distances[i]) <= least + spread_m + 1e-3) {
          near_.push_back(static_cast<std::uint32_t>(i));
        }
      }
      for (std::int32_t y = ty; y < std::min(n_, ty + kTile); ++y) {
        for (std::int32_t x = tx; x < std::min(n_, tx + kTile); ++x) {
          const Vec2 m = middle(x, y);
          Beside best = lane.beside(m, near_.front());
          for (const std::uint32_t i : near_) {
            const Beside b = lane.beside(m, i);
            if (b.distance_m < best.distance_m) best = b;
          }
          const std::size_t i = static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x);
          const double room = std::min(q.left_m - best.left_m, q.right_m + best.left_m);
          corridor_[i] = std::clamp(static_cast<float>(room), -kFar_m, kFar_m);
          along_[i] = static_cast<float>(best.along_m);
        }
      }
    }
  }
}

void Field::lay_fence(const Question& q) {
  const auto n = static_cast<std::size_t>(n_);
  fenced_ = !q.keep_in.empty() || !q.keep_out.empty();
  if (!fenced_) return;
  fence_.assign(n * n, q.keep_in.empty() ? kFar_m : -kFar_m);
  for (const Ring& r : q.keep_in) lay_ring(r, true);
  for (const Ring& r : q.keep_out) lay_ring(r, false);
  const auto margin = static_cast<float>(q.fence_margin_m);
  for (float& f : fence_) f -= margin;
}

void Field::lay_ring(const Ring& ring, bool keep_in) {
  const auto n = static_cast<std::size_t>(n_);
  const double tile_m = kTile * coarse_m_;
  const double spread_m = 1.4143 * tile_m;
  const double far = static_cast<double>(kFar_m);
  const Vec2 low{x0_m_ - far, y0_m_ - far};
  const Vec2 high{x0_m_ + n_ * coarse_m_ + far, y0_m_ + n_ * coarse_m_ + far};
  edges_.clear();
  Vec2 a = ring.back();
  for (const Vec2 b : ring) {
    const bool off = std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x ||
                     std::max(a.y, b.y) < low.y || std::min(a.y, b.y) > high.y;
    if (!off) edges_.emplace_back(a, b);
    a = b;
  }
  for (std::int32_t ty = 0; ty < n_; ty += kTile) {
    for (std::int32_t tx = 0; tx < n_; tx += kTile) {
      const Vec2 c{x0_m_ + tx * coarse_m_ + 0.5 * tile_m, y0_m_ + ty * coarse_m_ + 0.5 * tile_m};
      const bool tile_in = within(ring, c);
      double least = far + spread_m;
      for (const auto& [e, f] : edges_) least = std::min(least, to_edge_m(c, e, f));
      near_.clear();
      for (std::size_t i = 0; i < edges_.size() && least < far + spread_m; ++i) {
        if (to_edge_m(c, edges_[i].first, edges_[i].second) <= least + spread_m) {
          near_.push_back(static_cast<std::uint32_t>(i));
        }
      }
      const bool mixed = least <= 0.5 * spread_m;
      for (std::int32_t y = ty; y < std::min(n_, ty + kTile); ++y) {
        for (std::int32_t x = tx; x < std::min(n_, tx + kTile); ++x) {
          const Vec2 m = middle(x, y);
          double d = far;
          for (const std::uint32_t i : near_) {
            d = std::min(d, to_edge_m(m, edges_[i].first, edges_[i].second));
          }
          const bool in = mixed ? within(ring, m) : tile_in;
          const auto room = static_cast<float>(in == keep_in ? d : -d);
          float& f = fence_[static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)];
          f = keep_in ? std::max(f, room) : std::min(f, room);
        }
      }
    }
  }
}

}  // namespace roverd::nav::around
