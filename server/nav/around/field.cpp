#include "nav/around/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace roverd::nav::around {

namespace {

constexpr double kCoarse_m = 0.1;
constexpr double kUnseenAbout_m = 0.35;  // beside the body nobody sees; it stands there already
constexpr double kBeside_m = 0.4;        // as wide is the way that was answered last
constexpr float kOther = 1.17F;          // elsewhere a metre costs this
constexpr float kNear = 1.5F;            // more, where a thing is touched almost
constexpr float kBucket_m = 0.05F;
constexpr std::size_t kBuckets = 2400;

}  // namespace

void Field::lay(const sense::Patch& patch, const Question& q, const Lane& lane) {
  cell_m_ = patch.cell_m;
  side_ = patch.side;
  k_ = std::max(1, static_cast<std::int32_t>(std::lround(kCoarse_m / cell_m_)));
  n_ = (side_ + k_ - 1) / k_;
  coarse_m_ = k_ * cell_m_;
  per_cell_ = 1.0 / cell_m_;
  per_coarse_ = 1.0 / coarse_m_;
  x0_m_ = patch.x0 * cell_m_;
  y0_m_ = patch.y0 * cell_m_;
  sense::clearance(patch, false, kFar_m, clear_);
  lay_corridor(q, lane);
  lay_fence(q);
  mark_unseen(patch, q);
  mark_before(q);
}

bool Field::inside(double x, double y, double margin_m) const noexcept {
  const double size = side_ * cell_m_;
  return x >= x0_m_ + margin_m && y >= y0_m_ + margin_m && x <= x0_m_ + size - margin_m &&
         y <= y0_m_ + size - margin_m;
}

bool Field::unseen(double x, double y) const noexcept {
  const std::size_t i = coarse(x, y);
  return i == kNowhere || unseen_[i] != 0;
}

bool Field::any_unseen(Vec2 low, Vec2 high) const noexcept {
  if (!inside(low.x, low.y, 0.0) || !inside(high.x, high.y, 0.0)) return true;
  const auto n = static_cast<std::size_t>(n_);
  const auto part = [&](double v, double v0) {
    return std::min(n - 1, static_cast<std::size_t>((v - v0) * per_coarse_));
  };
  const std::size_t from = part(low.x, x0_m_);
  const std::size_t size = part(high.x, x0_m_) - from + 1;
  for (std::size_t y = part(low.y, y0_m_); y <= part(high.y, y0_m_); ++y) {
    if (std::memchr(unseen_.data() + y * n + from, 1, size) != nullptr) return true;
  }
  return false;
}

void Field::mark_unseen(const sense::Patch& patch, const Question& q) {
  const auto n = static_cast<std::size_t>(n_);
  unseen_.assign(n * n, 0);
  for (std::int32_t y = 0; y < side_; ++y) {
    const auto* row =
        patch.cells.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(side_);
    auto* out = unseen_.data() + static_cast<std::size_t>(y / k_) * n;
    for (std::int32_t x = 0; x < side_; ++x) {
      if (row[x].known == sense::Known::Unknown) out[x / k_] = 1;
    }
  }
  const Pose2 ob = sense::inverse(q.pose);
  const double reach = q.body.reach_m() + kUnseenAbout_m;
  const auto low = [&](double v, double v0) {
    return std::max(0, static_cast<std::int32_t>((v - reach - v0) * per_coarse_));
  };
  const auto high = [&](double v, double v0) {
    return std::min(n_ - 1, static_cast<std::int32_t>((v + reach - v0) * per_coarse_));
  };
  for (std::int32_t y = low(q.pose.y_m, y0_m_); y <= high(q.pose.y_m, y0_m_); ++y) {
    for (std::int32_t x = low(q.pose.x_m, x0_m_); x <= high(q.pose.x_m, x0_m_); ++x) {
      const Vec2 m = middle(x, y);
      const Pose2 in = ob * Pose2{m.x, m.y, 0.0};
      if (q.body.distance_m({in.x_m, in.y_m}) > kUnseenAbout_m) continue;
      unseen_[static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)] = 0;
    }
  }
}

void Field::mark_before(const Question& q) {
  const auto n = static_cast<std::size_t>(n_);
  before_.clear();
  if (q.before.empty()) return;
  before_.assign(n * n, 0);
  const auto r = static_cast<std::int32_t>(kBeside_m * per_coarse_);
  Vec2 last{1e9, 1e9};
  for (const Place& p : q.before) {
    const Vec2 at{p.pose.x_m, p.pose.y_m};
    if (!inside(at.x, at.y, 0.0) || dot(at - last, at - last) < 0.04) continue;
    last = at;
    const auto cx = static_cast<std::int32_t>((at.x - x0_m_) * per_coarse_);
    const auto cy = static_cast<std::int32_t>((at.y - y0_m_) * per_coarse_);
    for (std::int32_t y = std::max(0, cy - r); y <= std::min(n_ - 1, cy + r); ++y) {
      for (std::int32_t x = std::max(0, cx - r); x <= std::min(n_ - 1, cx + r); ++x) {
        if ((x - cx) * (x - cx) + (y - cy) * (y - cy) > r * r) continue;
        before_[static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)] = 1;
      }
    }
  }
}

void Field::price_all(const Question& q, double inner_m, double least_m, Borders borders) {
  const auto n = static_cast<std::size_t>(n_);
  room_.resize(n * n);
  for (std::size_t i = 0; i < n * n; ++i) {
    float room = kFar_m;
    if (borders.corridor) room = corridor_[i];
    if (borders.fence && fenced_) room = std::min(room, fence_[i]);
    room_[i] = room;
  }
  price_.resize(n * n);
  const auto inner = static_cast<float>(inner_m);
  const auto wanted = static_cast<float>(q.wanted_m);
  // A cell may be passed if any place in it may.
  const auto half = static_cast<float>(0.71 * coarse_m_);
  const float fits = inner + static_cast<float>(least_m);
  for (std::int32_t y = 0; y < n_; ++y) {
    for (std::int32_t x = 0; x < n_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x);
      float clear = 0.0F;
      for (std::int32_t fy = y * k_; fy < std::min(side_, (y + 1) * k_); ++fy) {
        for (std::int32_t fx = x * k_; fx < std::min(side_, (x + 1) * k_); ++fx) {
          clear = std::max(clear,
                           clear_[static_cast<std::size_t>(fy) * static_cast<std::size_t>(side_) +
                                  static_cast<std::size_t>(fx)]);
        }
      }
      if (clear < fits || room_[i] < inner - half) {
        price_[i] = 0.0F;
        continue;
      }
      const float lack = std::clamp((wanted + inner - clear) / wanted, 0.0F, 1.0F);
      float price = 1.0F + kNear * lack * lack;
      if (unseen_[i] != 0) price *= static_cast<float>(q.unknown_cost);
      if (!before_.empty() && before_[i] == 0) price *= kOther;
      price_[i] = price;
    }
  }
}

void Field::relax(std::size_t cell, float cost) {
  if (cost >= to_go_[cell]) return;
  const auto bucket = static_cast<std::size_t>(cost / kBucket_m);
  if (bucket >= kBuckets) return;
  to_go_[cell] = cost;
  buckets_[bucket].push_back(static_cast<std::uint32_t>(cell));
}

/// Dijkstra with buckets: no step is shorter than one, so what is in the lowest is final.
void Field::flood(std::span<const Goal> goals, Vec2 from, float beyond) {
  const auto n = static_cast<std::size_t>(n_);
  to_go_.assign(n * n, kNever);
  buckets_.resize(kBuckets);
  for (auto& b : buckets_) b.clear();
  for (const Goal& g : goals) {
    const std::size_t i = coarse(g.at.x, g.at.y);
    if (i != kNowhere) relax(i, g.cost);
  }
  const std::size_t start = coarse(from.x, from.y);
  const auto step = static_cast<float>(coarse_m_);
  const float slant = step * 1.41421356F;
  for (std::size_t b = 0; b < kBuckets; ++b) {
    const float reached = start == kNowhere ? kNever : to_go_[start];
    if (static_cast<float>(b) * kBucket_m > reached + beyond) return;
    for (std::size_t j = 0; j < buckets_[b].size(); ++j) {
      const std::size_t i = buckets_[b][j];
      const float cost = to_go_[i];
      if (static_cast<std::size_t>(cost / kBucket_m) != b) continue;  // reached more cheaply since
      const auto x = i % n;
      const auto y = i / n;
      if (x == 0 || y == 0 || x + 1 == n || y + 1 == n) continue;
      const auto to = [&](std::size_t k, float way) {
        // Where the robot stands already it fits, and so it may start beside a wall.
        const float price = k == start ? std::max(1.0F, price_[k]) : price_[k];
        if (price > 0.0F) relax(k, cost + way * price);
      };
      to(i - 1, step);
      to(i + 1, step);
      to(i - n, step);
      to(i + n, step);
      to(i - n - 1, slant);
      to(i - n + 1, slant);
      to(i + n - 1, slant);
      to(i + n + 1, slant);
    }
  }
}

bool Field::edge_reached(double after_m) const noexcept {
  const auto n = static_cast<std::size_t>(n_);
  const auto reached = [&](std::size_t i) {
    return to_go_[i]<kNever&& static_cast<double>(along_[i])> after_m;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (reached(i) || reached((n - 1) * n + i) || reached(i * n) || reached(i * n + n - 1)) {
      return true;
    }
  }
  return false;
}

void Field::across(double from_m, double to_m, float cost, std::vector<Goal>& out) const {
  const auto n = static_cast<std::size_t>(n_);
  for (std::int32_t y = 0; y < n_; ++y) {
    for (std::int32_t x = 0; x < n_; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x);
      const auto along = static_cast<double>(along_[i]);
      if (price_[i] > 0.0F && along >= from_m && along <= to_m) out.push_back({middle(x, y), cost});
    }
  }
}

}  // namespace roverd::nav::around
