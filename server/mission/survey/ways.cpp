#include "mission/survey/ways.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roverd::mission::survey {
namespace {

double cross(EnuPoint a, EnuPoint b) noexcept {
  return a.east_m * b.north_m - a.north_m * b.east_m;
}

/// Touching counts.
bool meet(EnuPoint a, EnuPoint b, const EdgeGrid::Edge& e) noexcept {
  const double c = cross(b - a, e.a - a);
  const double d = cross(b - a, e.b - a);
  if ((c > 0.0 && d > 0.0) || (c < 0.0 && d < 0.0)) return false;
  const double f = cross(e.b - e.a, a - e.a);
  const double g = cross(e.b - e.a, b - e.a);
  return !((f > 0.0 && g > 0.0) || (f < 0.0 && g < 0.0));
}

EnuPoint between(EnuPoint a, EnuPoint b, double share) noexcept {
  return {a.east_m + share * (b.east_m - a.east_m), a.north_m + share * (b.north_m - a.north_m)};
}

}  // namespace

EdgeGrid::EdgeGrid(std::vector<Edge> edges, double least_m) : edges_(std::move(edges)) {
  if (edges_.empty()) return;
  Box box{edges_.front().a, edges_.front().a};
  double length_m = 0.0;
  for (const Edge& e : edges_) {
    for (const EnuPoint p : {e.a, e.b}) {
      box.low = {std::min(box.low.east_m, p.east_m), std::min(box.low.north_m, p.north_m)};
      box.high = {std::max(box.high.east_m, p.east_m), std::max(box.high.north_m, p.north_m)};
    }
    length_m += base::distance_m(e.a, e.b);
  }
  low_ = box.low;
  const EnuPoint span = box.high - box.low;
  // As many cells as edges, and no more places in cells than a few times that or a million.
  const double count = static_cast<double>(edges_.size()) + 16.0;
  constexpr double kPlaces = 1e6;
  size_m_ =
      std::max({std::sqrt(span.east_m * span.north_m / count), (span.east_m + span.north_m) / count,
                length_m / std::max(count, kPlaces), least_m, 1e-3});
  columns_ = static_cast<std::size_t>(span.east_m / size_m_) + 1;
  rows_ = static_cast<std::size_t>(span.north_m / size_m_) + 1;
  begin_.assign(columns_ * rows_ + 1, 0);
  for (const Edge& e : edges_) {
    visit(e.a, e.b, [this](std::size_t cell) { return ++begin_[cell + 1], false; });
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  held_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t i = 0; i < edges_.size(); ++i) {
    visit(edges_[i].a, edges_[i].b,
          [&](std::size_t cell) { return held_[next[cell]++] = i, false; });
  }
}

EdgeGrid::Cell EdgeGrid::cell_of(EnuPoint p) const noexcept {
  const auto index = [this](double along_m, std::size_t count) {
    const double k = std::floor(along_m / size_m_);
    return static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(count - 1)));
  };
  return {index(p.east_m - low_.east_m, columns_), index(p.north_m - low_.north_m, rows_)};
}

std::vector<EdgeGrid::Edge> edges_of(const Area& area) {
  std::vector<EdgeGrid::Edge> out;
  for (const Ring& ring : area) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      out.push_back({ring[j], ring[i]});
    }
  }
  return out;
}

double square_from_edge(EnuPoint p, const EdgeGrid::Edge& edge) noexcept {
  const EnuPoint ab = edge.b - edge.a;
  const EnuPoint ap = p - edge.a;
  const double square = ab.east_m * ab.east_m + ab.north_m * ab.north_m;
  const double dot = ap.east_m * ab.east_m + ap.north_m * ab.north_m;
  const double along = square > 0.0 ? std::clamp(dot / square, 0.0, 1.0) : 0.0;
  const EnuPoint off{ap.east_m - along * ab.east_m, ap.north_m - along * ab.north_m};
  return off.east_m * off.east_m + off.north_m * off.north_m;
}

Ways::Ways(const Part& part, double slack_m, double sagitta_m)
    : walls_(edges_of(offset(part.area(), slack_m, sagitta_m))),
      rings_(offset(part.area(), slack_m / 2.0, sagitta_m)) {
  for (const Ring& ring : rings_) {
    std::vector<double>& run = run_m_.emplace_back();
    double sum = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      run.push_back(sum);
      sum += base::distance_m(ring[i], ring[(i + 1) % ring.size()]);
    }
    run.push_back(sum);
  }
}

bool Ways::clear(EnuPoint a, EnuPoint b) const {
  return !walls_.along(a, b, [&](const EdgeGrid::Edge& e) { return meet(a, b, e); });
}

double Ways::share_clear(EnuPoint a, EnuPoint b) const {
  if (clear(a, b)) return 1.0;
  const auto all = hits(a, b);
  return all.empty() ? 0.0 : all.front().along;
}

std::vector<Ways::Hit> Ways::hits(EnuPoint a, EnuPoint b) const {
  std::vector<Hit> out;
  const EnuPoint ab = b - a;
  for (std::size_t r = 0; r < rings_.size(); ++r) {
    const Ring& ring = rings_[r];
    for (std::size_t j = ring.size() - 1, i = 0; i < ring.size(); j = i++) {
      const double before = cross(ab, ring[j] - a);
      const double after = cross(ab, ring[i] - a);
      if ((before >= 0.0) == (after >= 0.0)) continue;
      const EnuPoint at = between(ring[j], ring[i], before / (before - after));
      const EnuPoint way = at - a;
      const double along = (way.east_m * ab.east_m + way.north_m * ab.north_m) /
                           (ab.east_m * ab.east_m + ab.north_m * ab.north_m);
      if (along > 0.0 && along < 1.0) out.push_back({along, r, j, at});
    }
  }
  std::sort(out.begin(), out.end(), [](const Hit& x, const Hit& y) { return x.along < y.along; });
  return out;
}

void Ways::follow(const Hit& from, const Hit& to, std::vector<EnuPoint>& out) const {
  const Ring& ring = rings_[from.ring];
  const auto& run = run_m_[from.ring];
  const std::size_t n = ring.size();
  const double at_from = run[from.edge] + base::distance_m(ring[from.edge], from.at);
  const double at_to = run[to.edge] + base::distance_m(ring[to.edge], to.at);
  double forward_m = at_to - at_from;
  if (forward_m < 0.0) forward_m += run.back();
  out.push_back(from.at);
  if (forward_m <= run.back() - forward_m) {
    const bool same = from.edge == to.edge && at_to >= at_from;
    for (std::size_t k = from.edge; !same;) {
      k = (k + 1) % n;
      out.push_back(ring[k]);
      if (k == to.edge) break;
    }
  } else {
    const bool same = from.edge == to.edge && at_to <= at_from;
    for (std::size_t k = from.edge; !same; k = (k + n - 1) % n) {
      out.push_back(ring[k]);
      if ((k + n - 1) % n == to.edge) break;
    }
  }
  out.push_back(to.at);
}

std::vector<EnuPoint> Ways::pulled(const std::vector<EnuPoint>& points) const {
  std::vector<EnuPoint> out{points.front()};
  std::size_t from = 0;
  const std::size_t last = points.size() - 1;
  while (from < last) {
    // As far as can be seen, by doubling the step and then halving it.
    std::size_t good = from + 1;
    std::size_t step = 2;
    while (from + step <= last && clear(points[from], points[from + step])) {
      good = from + step;
      step *= 2;
    }
    for (std::size_t half = step / 2; half > 0; half /= 2) {
      if (good + half <= last && clear(points[from], points[good + half])) good += half;
    }
    out.push_back(points[good]);
    from = good;
  }
  return out;
}

std::vector<EnuPoint> Ways::way(EnuPoint a, EnuPoint b) const {
  if (clear(a, b)) return {a, b};
  std::vector<EnuPoint> points{a};
  const auto all = hits(a, b);
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
    if (all[i].ring == all[i + 1].ring) follow(all[i], all[i + 1], points);
  }
  points.push_back(b);
  for (int pass = 0; pass < 2; ++pass) {
    points = pulled(points);
    std::reverse(points.begin(), points.end());
  }
  return points;
}

}  // namespace roverd::mission::survey
