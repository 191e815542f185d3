#include "nav/sense/clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "nav/sense/sweep.hpp"

namespace roverd::nav::sense {
namespace {

constexpr std::int32_t kGap = 2;        // neighbours: one cell between them is none
constexpr std::size_t kDirections = 8;  // in which a thing is measured
constexpr double kStands = 1e-3;        // m/s, rad/s
constexpr std::array<std::uint8_t, 4> kWorse{1, 0, 3, 2};  // of Unknown, Free, Occupied, Drop

bool is_thing(Known k) noexcept {
  return k == Known::Occupied || k == Known::Drop;
}

/// How far a thing reaches in each direction.
class Extent {
 public:
  Extent() {
    least_.fill(std::numeric_limits<double>::infinity());
    most_.fill(-std::numeric_limits<double>::infinity());
  }
  void take(Vec2 p) noexcept {
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double along = dot(p, directions()[i]);
      least_[i] = std::min(least_[i], along);
      most_[i] = std::max(most_[i], along);
    }
  }
  double widest() const noexcept {
    double out = 0.0;
    for (std::size_t i = 0; i < kDirections; ++i) out = std::max(out, most_[i] - least_[i]);
    return out;
  }

 private:
  static const std::array<Vec2, kDirections>& directions() noexcept {
    static const std::array<Vec2, kDirections> all = [] {
      std::array<Vec2, kDirections> made{};
      for (std::size_t i = 0; i < kDirections; ++i) {
        const double angle = std::numbers::pi * double(i) / double(kDirections);
        made[i] = {std::cos(angle), std::sin(angle)};
      }
      return made;
    }();
    return all;
  }
  std::array<double, kDirections> least_{};
  std::array<double, kDirections> most_{};
};

/// Walks from cell to cell of one thing after the other.
class Gatherer {
 public:
  Gatherer(const Patch& patch, const Pose2& pose, const Footprint& body, const Way& way)
      : patch_(patch),
        body_(body),
        way_(way),
        to_body_(inverse(pose)),
        moves_(std::abs(way.twist.linear_mps) > kStands ||
               std::abs(way.twist.angular_radps) > kStands),
        seen_(patch.cells.size(), 0) {}

  bool is_new(std::size_t i) const noexcept {
    return seen_[i] == 0 && is_thing(patch_.cells[i].known);
  }

  Cluster gather(std::size_t first) {
    Cluster out;
    out.known = patch_.cells[first].known;
    out.clearance_m = std::numeric_limits<double>::infinity();
    out.age_ds = std::numeric_limits<std::uint16_t>::max();
    Extent extent;
    seen_[first] = 1;
    open_.assign(1, first);
    while (!open_.empty()) {
      const std::size_t i = open_.back();
      open_.pop_back();
      const Vec2 p = in_body(i);
      extent.take(p);
      take(i, p, out);
      spread(i, out.known);
    }
    out.size_m = extent.widest() + patch_.cell_m;
    return out;
  }

 private:
  Vec2 in_body(std::size_t i) const noexcept {
    const auto side = static_cast<std::size_t>(patch_.side);
    const double x = (patch_.x0 + double(i % side) + 0.5) * patch_.cell_m;
    const double y = (patch_.y0 + double(i / side) + 0.5) * patch_.cell_m;
    const Pose2 p = to_body_ * Pose2{x, y, 0.0};
    return {p.x_m, p.y_m};
  }

  void take(std::size_t i, Vec2 p, Cluster& out) const noexcept {
    const Patch::Cell& cell = patch_.cells[i];
    ++out.cells;
    out.age_ds = std::min(out.age_ds, cell.age_ds);
    const double clearance_m = body_.distance_m(p);
    if (clearance_m < out.clearance_m) {
      out.clearance_m = clearance_m;
      out.nearest = p;
      out.sensor = cell.sensor;
    }
    if (out.on_way || !moves_) return;
    out.on_way = touch_s(body_, p, way_.side_m, way_.twist, way_.horizon_s).has_value();
  }

  void spread(std::size_t i, Known known) {
    const auto side = static_cast<std::int32_t>(patch_.side);
    const auto x = static_cast<std::int32_t>(i % static_cast<std::size_t>(side));
    const auto y = static_cast<std::int32_t>(i / static_cast<std::size_t>(side));
    for (std::int32_t v = std::max(0, y - kGap); v <= std::min(side - 1, y + kGap); ++v) {
      for (std::int32_t u = std::max(0, x - kGap); u <= std::min(side - 1, x + kGap); ++u) {
        const std::size_t n = static_cast<std::size_t>(v) * static_cast<std::size_t>(side) +
                              static_cast<std::size_t>(u);
        if (seen_[n] != 0 || patch_.cells[n].known != known) continue;
        seen_[n] = 1;
        open_.push_back(n);
      }
    }
  }

  const Patch& patch_;
  const Footprint& body_;
  const Way& way_;
  Pose2 to_body_;
  bool moves_;
  std::vector<std::uint8_t> seen_;
  std::vector<std::size_t> open_;
};

/// Rounded down and up, below zero as well. @param n > 0
std::int32_t floor_of(std::int32_t a, std::int32_t n) noexcept {
  return a / n - (a % n < 0 ? 1 : 0);
}
std::int32_t ceil_of(std::int32_t a, std::int32_t n) noexcept {
  return -floor_of(-a, n);
}

Patch::Cell worst_of(const Patch& patch, std::int32_t x, std::int32_t y, std::int32_t n) noexcept {
  Patch::Cell worst = patch.at(x, y);
  for (std::int32_t v = 0; v < n; ++v) {
    for (std::int32_t u = 0; u < n; ++u) {
      const Patch::Cell one = patch.at(x + u, y + v);
      const auto rank = kWorse[static_cast<std::size_t>(one.known)];
      if (rank > kWorse[static_cast<std::size_t>(worst.known)]) worst = one;
    }
  }
  return worst;
}

}  // namespace

std::vector<Cluster> clusters_of(const Patch& patch, const Pose2& pose, const Footprint& body,
                                 const Way& way, std::size_t most) {
  std::vector<Cluster> out;
  Gatherer gatherer(patch, pose, body, way);
  for (std::size_t i = 0; i < patch.cells.size(); ++i) {
    if (gatherer.is_new(i)) out.push_back(gatherer.gather(i));
  }
  std::sort(out.begin(), out.end(),
            [](const Cluster& a, const Cluster& b) { return a.clearance_m < b.clearance_m; });
  if (out.size() > most) out.resize(most);
  return out;
}

Patch coarser(const Patch& patch, std::int32_t n) {
  Patch out;
  out.stamp = patch.stamp;
  out.cell_m = patch.cell_m * n;
  out.x0 = ceil_of(patch.x0, n);
  out.y0 = ceil_of(patch.y0, n);
  const std::int32_t wide = floor_of(patch.x0 + patch.side, n) - out.x0;
  const std::int32_t high = floor_of(patch.y0 + patch.side, n) - out.y0;
  out.side = std::max(0, std::min(wide, high));
  out.cells.reserve(static_cast<std::size_t>(out.side) * static_cast<std::size_t>(out.side));
  for (std::int32_t y = 0; y < out.side; ++y) {
    for (std::int32_t x = 0; x < out.side; ++x) {
      out.cells.push_back(worst_of(patch, (out.x0 + x) * n, (out.y0 + y) * n, n));
    }
  }
  return out;
}

}  // namespace roverd::nav::sense
