#include "nav/track/pace.hpp"

#include <algorithm>
#include <cmath>

#include "nav/track/sleeve.hpp"

namespace roverd::nav {
namespace {

constexpr double kSamePlace_m = 1e-3;  // nearer than this two places are one
constexpr int kDoublings = 12;         // of the tolerances

double squared(double x) noexcept {
  return x * x;
}

/// Walks along a way and tells every place where its speed bends.
class Pacer {
 public:
  Pacer(const Path& path, std::span<const int> items, const SpeedParams& speed)
      : path_(path), items_(items), speed_(speed) {}

  std::vector<PacePoint> all() {
    points_.reserve(path_.points.size() + 2 * path_.legs.size());
    for (const Leg& leg : path_.legs) {
      reverse_ = leg.reverse;
      for (std::size_t i = leg.first; i < leg.last; ++i) segment(i);
    }
    if (!path_.legs.empty()) {
      PacePoint end = points_.back();
      end.at = path_.points.back().at;
      end.s_m = path_.points.back().s_m;
      end.planned_mps = 0.0;
      points_.push_back(end);
    }
    return std::move(points_);
  }

 private:
  /// From point i to the next: where it speeds up until, where it brakes from, where items begin.
  void segment(std::size_t i) {
    const PathPoint& a = path_.points[i];
    const PathPoint& b = path_.points[i + 1];
    const double ds = b.s_m - a.s_m;
    if (!(ds > 0.0)) return;
    const double up = 2.0 * speed_.accel_mps2;
    const double down = 2.0 * speed_.decel_mps2;
    const double v0 = squared(a.plan_mps);
    const double v1 = squared(b.plan_mps);
    // Where the two ramps meet: v0 + up·x = v1 + down·(ds − x).
    const double peak = (up * v1 + down * v0 + up * down * ds) / (up + down);
    const double top = std::max({v0, v1, std::min(peak, squared(a.segment_mps))});
    const double up_m = std::clamp((top - v0) / up, 0.0, ds);
    const double down_m = std::clamp((top - v1) / down, 0.0, ds - up_m);
    const double marks_m[] = {0.0, up_m, ds - down_m};
    const double squares[] = {v0, top, top};
    const auto at = [&](double x_m) {
      if (x_m < up_m) return v0 + up * x_m;
      return x_m <= ds - down_m ? top : v1 + down * (ds - x_m);
    };
    for (int k = 0; k < 3; ++k) {
      if (k > 0 && marks_m[k] - marks_m[k - 1] < kSamePlace_m) continue;
      for (; next_ < items_.size() && path_.vertex_m[next_] < a.s_m + marks_m[k]; ++next_) {
        if (begins_after(next_)) add(i, path_.vertex_m[next_] - a.s_m, at, next_ + 1);
      }
      while (next_ < items_.size() && path_.vertex_m[next_] <= a.s_m + marks_m[k] + kSamePlace_m) {
        ++next_;
      }
      push(i, marks_m[k], squares[k], next_);
    }
    for (; next_ < items_.size() && path_.vertex_m[next_] < b.s_m - kSamePlace_m; ++next_) {
      if (begins_after(next_)) add(i, path_.vertex_m[next_] - a.s_m, at, next_ + 1);
    }
  }

  bool begins_after(std::size_t vertex) const noexcept {
    return vertex + 1 < items_.size() && items_[vertex + 1] != items_[vertex];
  }

  template <class Squared>
  void add(std::size_t i, double x_m, const Squared& at, std::size_t vertex) {
    if (x_m > 0.0) push(i, x_m, at(x_m), vertex);
  }

  void push(std::size_t i, double x_m, double mps_squared, std::size_t vertex) {
    const PathPoint& a = path_.points[i];
    const PathPoint& b = path_.points[i + 1];
    const double share = x_m / (b.s_m - a.s_m);
    const int item = items_.empty() ? 0 : items_[std::min(vertex, items_.size() - 1)];
    points_.push_back({{a.at.east_m + share * (b.at.east_m - a.at.east_m),
                        a.at.north_m + share * (b.at.north_m - a.at.north_m)},
                       a.s_m + x_m,
                       std::sqrt(std::max(0.0, mps_squared)),
                       a.segment_mps,
                       item,
                       reverse_});
  }

  const Path& path_;
  std::span<const int> items_;
  const SpeedParams& speed_;
  std::vector<PacePoint> points_;
  std::size_t next_ = 0;  ///< vertex that is not passed yet
  bool reverse_ = false;
};

/// What may be left out since the last point that was kept.
class Since {
 public:
  explicit Since(const PacePoint& from)
      : from_(from), place_(from.at), squared_(from.s_m, squared(from.planned_mps)) {}

  bool take(const PacePoint& p, double within_m, double within_mps) {
    const double v = p.planned_mps;
    const bool near = place_.take(p.at, within_m);
    return squared_.take(p.s_m, v * v, squared(std::max(0.0, v - within_mps)),
                         squared(v + within_mps)) &&
           near;
  }
  /// It goes on as it was; else the point at which it does not is kept.
  bool alike(const PacePoint& p, double within_mps, bool items) const {
    return p.reverse == from_.reverse && std::abs(p.set_mps - from_.set_mps) <= within_mps &&
           (!items || p.item == from_.item);
  }

 private:
  PacePoint from_;
  Sleeve place_;
  SlopeSleeve squared_;
};

std::vector<PacePoint> thinned_pace(const std::vector<PacePoint>& all, const PaceBounds& b,
                                    bool items) {
  std::vector<PacePoint> kept;
  if (all.empty()) return kept;
  std::size_t last = 0;
  kept.push_back(all[0]);
  Since since(all[0]);
  for (std::size_t i = 1; i < all.size() && kept.size() <= b.most; ++i) {
    if (!since.take(all[i], b.within_m, b.within_mps) && i - 1 > last) {
      last = i - 1;
      kept.push_back(all[last]);
      since = Since(all[last]);
      (void)since.take(all[i], b.within_m, b.within_mps);
    }
    if (i + 1 == all.size() || !since.alike(all[i], b.within_mps, items)) {
      last = i;
      kept.push_back(all[i]);
      since = Since(all[i]);
    }
  }
  return kept;
}

}  // namespace

std::vector<PacePoint> pace_of(const Path& path, std::span<const int> items,
                               const SpeedParams& speed, const PaceBounds& bounds) {
  const std::vector<PacePoint> all = Pacer(path, items, speed).all();
  PaceBounds b = bounds;
  std::vector<PacePoint> kept = thinned_pace(all, b, true);
  for (int k = 0; kept.size() > b.most && k < kDoublings; ++k) {
    // Items that begin have no point of their own any more.
    b.within_m *= 2.0;
    b.within_mps *= 2.0;
    kept = thinned_pace(all, b, false);
  }
  if (kept.size() > b.most) kept.resize(b.most);
  return kept;
}

}  // namespace roverd::nav
