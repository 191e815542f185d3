#include "nav/track/smooth_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

constexpr double kAnchor_m = 0.25;   // nearer than this, noise makes a way of its own
constexpr double kPiece_m = 0.25;    // of the spline
constexpr double kLongest_m = 16.0;  // stiffer than this says nothing more
constexpr double kSofter = 1.5;
constexpr int kRounds = 9;
constexpr double kBias_m = 0.003;  // between curve and points, this is not worth a bend
constexpr double kSurprise = 3.5;  // sigmas of a mean
constexpr double kChord = 1e-3;    // weight of what lies between two points
constexpr double kHeld = 1e4;
constexpr double kPullPoint = 4.0;
constexpr double kPullChord = 30.0;
constexpr int kPulls = 10;
constexpr int kPullsHard = 3;  // the last ones: with a more supple curve
constexpr double kNearTolerance = 0.97;
constexpr double kStencil_m = 0.3;
constexpr double kAlong_m = 0.4;
constexpr double kSagitta_m = 0.001;
constexpr double kThrown = 4.0;      // sigmas, by which noise throws one of many points
constexpr double kThrownMost = 1.4;  // times the tolerance
constexpr double kMany_m = 0.15;     // apart, at most: the mean of four
constexpr double kLeast_m = 0.005;   // between two points of a path

double size(EnuPoint d) noexcept {
  return std::hypot(d.east_m, d.north_m);
}

EnuPoint between(EnuPoint a, EnuPoint b, double part) noexcept {
  return {a.east_m + part * (b.east_m - a.east_m), a.north_m + part * (b.north_m - a.north_m)};
}

/// How far beside a point the curve may be. @param off_m of all points, as it is.
double room_m(std::span<const double> u, std::span<const double> off_m, std::size_t k,
              const FitLimits& limits) noexcept {
  const std::size_t last = u.size() - 1;
  if (k == 0 || k >= last) return limits.tolerance_m;
  const std::size_t from = k - std::min<std::size_t>(k, 2);
  const std::size_t to = std::min(k + 2, last);
  const bool many = u[to] - u[from] <= kMany_m * static_cast<double>(to - from);
  // One, or two side by side: of hundreds of points, noise throws a pair as well.
  const auto off = [&](std::size_t i) { return off_m[i] > limits.tolerance_m; };
  std::size_t first = k;
  while (first > from && off(first - 1)) --first;
  std::size_t end = k + 1;
  while (end <= to && off(end)) ++end;
  if (!many || end - first > 2) return limits.tolerance_m;
  return std::clamp(kThrown * limits.noise_m, limits.tolerance_m, kThrownMost * limits.tolerance_m);
}

}  // namespace

EnuPoint Chain::place(double u_m) const noexcept {
  const auto next = std::upper_bound(u.begin(), u.end(), u_m);
  if (next == u.begin()) return at.front();
  if (next == u.end()) return at.back();
  const auto i = static_cast<std::size_t>(next - u.begin());
  return between(at[i - 1], at[i], (u_m - u[i - 1]) / (u[i] - u[i - 1]));
}

Chain chain_of(std::vector<EnuPoint> points) {
  Chain chain{std::move(points), {}};
  const auto& p = chain.at;
  chain.u.assign(p.size(), 0.0);
  std::size_t anchor = 0;
  for (std::size_t k = 1; k < p.size(); ++k) {
    const double way_m = base::distance_m(p[anchor], p[k]);
    if (way_m < kAnchor_m && k + 1 < p.size()) continue;
    double all_m = 0.0;
    for (std::size_t j = anchor + 1; j <= k; ++j) all_m += base::distance_m(p[j - 1], p[j]);
    const double scale = std::max(way_m, 0.1 * all_m) / all_m;  // a way back counts as well
    for (std::size_t j = anchor + 1; j <= k; ++j) {
      chain.u[j] = chain.u[j - 1] + scale * base::distance_m(p[j - 1], p[j]);
    }
    anchor = k;
  }
  return chain;
}

double noise_m(const Chain& chain) {
  const auto& p = chain.at;
  const auto& u = chain.u;
  std::vector<double> across;
  // Neighbours nearer to each other than their noise say nothing of their order.
  const double spacing_m = u.back() / static_cast<double>(p.size() - 1);
  const auto step = static_cast<std::size_t>(
      std::clamp(std::round(kStencil_m / spacing_m), 1.0, static_cast<double>(p.size())));
  for (std::size_t k = 2 * step; k + 2 * step < p.size(); ++k) {
    // What the cubic through four points about it says of it.
    const std::size_t about[] = {k - 2 * step, k - step, k + step, k + 2 * step};
    double expected_east = 0.0;
    double expected_north = 0.0;
    double squares = 1.0;
    for (const std::size_t i : about) {
      double by = 1.0;
      for (const std::size_t j : about) {
        if (j != i) by *= (u[k] - u[j]) / (u[i] - u[j]);
      }
      expected_east += by * p[i].east_m;
      expected_north += by * p[i].north_m;
      squares += by * by;
    }
    const EnuPoint way = chain.place(u[k] + 0.5) - chain.place(u[k] - 0.5);
    const double length = size(way);
    if (!(length > 0.1) || !(squares < 1e3)) continue;
    const double off = ((p[k].north_m - expected_north) * way.east_m -
                        (p[k].east_m - expected_east) * way.north_m) /
                       length;
    across.push_back(std::abs(off) / std::sqrt(squares));
  }
  if (across.size() < 4) return 0.0;
  const auto middle = across.begin() + static_cast<std::ptrdiff_t>(across.size() / 2);
  std::nth_element(across.begin(), middle, across.end());
  return *middle / 0.6745;
}

PieceFit::PieceFit(Chain chain, const PieceEnds& ends, const FitLimits& limits)
    : chain_(std::move(chain)),
      ends_(ends),
      limits_(limits),
      spacing_m_(chain_.u.back() / static_cast<double>(chain_.at.size() - 1)),
      curve_(chain_.u.back(), std::clamp(0.5 * spacing_m_, kPiece_m, 2.0 * kPiece_m)),
      wave_m_(curve_.pieces(), kLongest_m) {
  lay_data();
  adapt();
  count_where_nearest();
  lay_data();
  refit();
  keep_tolerance();
}

/// What noise has moved along the way is not beside it.
void PieceFit::count_where_nearest() {
  auto& u = chain_.u;
  const std::size_t last = u.size() - 1;
  struct Pool {
    double sum;
    double many;
    double mean() const noexcept { return sum / many; }
  };
  std::vector<Pool> pools;  // in order: what would overtake counts where its mean does
  for (std::size_t k = 1; k < last; ++k) {
    const SplinePlace c = curve_.place(u[k]);
    const EnuPoint off = chain_.at[k] - c.at;
    const double square =
        std::max(0.01, c.first.east_m * c.first.east_m + c.first.north_m * c.first.north_m);
    const double by = (off.east_m * c.first.east_m + off.north_m * c.first.north_m) / square;
    const double nearest = u[k] + std::clamp(by, -kAlong_m, kAlong_m);
    pools.push_back({std::clamp(nearest, 0.0, u[last]), 1.0});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() >= pools.back().mean()) {
      const Pool over = pools.back();
      pools.pop_back();
      pools.back().sum += over.sum;
      pools.back().many += over.many;
    }
  }
  std::size_t k = 1;
  const double step = std::min(1e-4, 0.1 * u[last] / static_cast<double>(last));
  for (const Pool& pool : pools) {
    for (int i = 0; i < static_cast<int>(pool.many); ++i, ++k) {
      const double room = u[last] - step * static_cast<double>(last - k);
      u[k] = std::max(u[k - 1] + step, std::min(pool.mean(), room));
    }
  }
}

void PieceFit::lay_data() {
  data_.clear();
  const auto& p = chain_.at;
  const auto& u = chain_.u;
  const std::size_t last = p.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const bool held = (k == 0 && ends_.begin) || (k == last && ends_.end);
    const EnuPoint at =
        k == 0 ? ends_.begin.value_or(p[k]) : (k == last ? ends_.end.value_or(p[k]) : p[k]);
    data_.push_back({u[k], at, held ? kHeld : 1.0});
    if (k == last) break;
    const bool straight = (k == 0 && ends_.straight_in) || (k + 1 == last && ends_.straight_out);
    const auto n = static_cast<int>(std::min(64.0, std::ceil((u[k + 1] - u[k]) / kPiece_m)));
    for (int i = 1; i < n; ++i) {
      const double part = static_cast<double>(i) / n;
      const bool near_end = k == 0 && ends_.straight_in ? i <= 3 : i >= n - 3;
      data_.push_back({u[k] + part * (u[k + 1] - u[k]), between(p[k], p[k + 1], part),
                       straight ? (near_end ? kHeld : 1.0) : kChord});
    }
  }
}

std::size_t PieceFit::piece_of(double u) const noexcept {
  const auto i = static_cast<std::size_t>(std::max(0.0, u / curve_.piece()));
  return std::min(i, curve_.pieces() - 1);
}

void PieceFit::refit() {
  std::vector<double> stiffness(wave_m_.size());
  const double by = 1.0 / (spacing_m_ * std::pow(curve_.piece(), 5));
  for (std::size_t i = 0; i < wave_m_.size(); ++i) {
    const double square = wave_m_[i] * wave_m_[i] / (4.0 * base::kPi * base::kPi);
    stiffness[i] = square * square * square * by;
  }
  curve_.fit(data_, stiffness);
}

void PieceFit::adapt() {
  refit();
  for (int round = 0; round < kRounds && soften(); ++round) refit();
}

void PieceFit::soften_about(double u, double half_m, std::vector<char>& softer) const {
  const std::size_t to = piece_of(u + half_m);
  for (std::size_t i = piece_of(u - half_m); i <= to; ++i) softer[i] = 1;
}

/// Where the points lie beside the curve by more than their noise lets a mean be off.
/// @return something changed.
bool PieceFit::soften() {
  const auto& u = chain_.u;
  const std::size_t n = u.size();
  std::vector<EnuPoint> sum(n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    const bool held = (k == 0 && (ends_.begin || ends_.straight_in)) ||
                      (k + 1 == n && (ends_.end || ends_.straight_out));
    sum[k + 1] = sum[k] + (held ? EnuPoint{} : chain_.at[k] - curve_.at(u[k]));
  }
  std::vector<char> softer(wave_m_.size(), 0);
  std::size_t lo = 0;
  std::size_t hi = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double half_m = wave_m_[piece_of(u[k])] / 6.0;
    while (lo < k && u[lo] < u[k] - half_m) ++lo;
    while (lo > 0 && u[lo - 1] >= u[k] - half_m) --lo;
    hi = std::max(hi, k + 1);
    while (hi < n && u[hi] <= u[k] + half_m) ++hi;
    while (hi > k + 1 && u[hi - 1] > u[k] + half_m) --hi;
    const auto many = static_cast<double>(hi - lo);
    const double off_m = size(sum[hi] - sum[lo]) / many;
    if (off_m > kSurprise * limits_.noise_m / std::sqrt(many) + kBias_m) {
      soften_about(u[k], half_m, softer);
    }
  }
  bool changed = false;
  for (std::size_t i = 0; i < wave_m_.size(); ++i) {
    if (softer[i] == 0 || wave_m_[i] <= limits_.shortest_m) continue;
    wave_m_[i] = std::max(limits_.shortest_m, wave_m_[i] / kSofter);
    changed = true;
  }
  // From supple to stiff it goes gradually.
  for (std::size_t i = 1; i < wave_m_.size(); ++i) {
    wave_m_[i] = std::min(wave_m_[i], wave_m_[i - 1] + curve_.piece());
  }
  for (std::size_t i = wave_m_.size() - 1; i-- > 0;) {
    wave_m_[i] = std::min(wave_m_[i], wave_m_[i + 1] + curve_.piece());
  }
  return changed;
}

void PieceFit::keep_tolerance() {
  const auto& u = chain_.u;
  std::vector<double> off_m(u.size());
  for (int round = 0; round < kPulls; ++round) {
    std::vector<char> softer(wave_m_.size(), 0);
    bool pulled = false;
    for (std::size_t k = 0; k < u.size(); ++k) off_m[k] = size(curve_.at(u[k]) - chain_.at[k]);
    std::size_t k = 0;
    for (SplineDatum& d : data_) {
      while (k + 1 < u.size() && u[k] < d.u) ++k;
      const double room = d.u == u[k] ? room_m(u, off_m, k, limits_) : limits_.tolerance_m;
      if (d.weight >= kHeld || size(curve_.at(d.u) - d.at) <= kNearTolerance * room) continue;
      d.weight = std::min(kHeld, d.weight * (d.weight < 1.0 ? kPullChord : kPullPoint));
      if (round >= kPulls - kPullsHard) soften_about(d.u, 0.5, softer);
      pulled = true;
    }
    if (!pulled) return;
    for (std::size_t i = 0; i < wave_m_.size(); ++i) {
      if (softer[i] != 0) wave_m_[i] = std::max(limits_.shortest_m, wave_m_[i] / kSofter);
    }
    refit();
  }
}

std::vector<std::size_t> PieceFit::corners() const {
  constexpr double kStep_m = 0.5 * kPiece_m;
  constexpr double kBeside_m = 0.5;
  const auto& u = chain_.u;
  std::vector<std::size_t> out;
  const auto bend_1pm = [this](double at) {
    const SplinePlace c = curve_.place(at);
    const double speed = std::max(1e-3, size(c.first));
    return (c.first.east_m * c.second.north_m - c.first.north_m * c.second.east_m) /
           (speed * speed * speed);
  };
  const auto take = [&](double from, double to) {
    const EnuPoint a = chain_.place(from - kBeside_m);
    const EnuPoint d = chain_.place(to + kBeside_m) - a;
    std::size_t best = 0;
    double best_m = -1.0;
    const auto first = std::lower_bound(u.begin() + 1, u.end() - 1, from - kBeside_m);
    for (auto k = static_cast<std::size_t>(first - u.begin());
         k + 1 < u.size() && u[k] <= to + kBeside_m; ++k) {
      const EnuPoint p = chain_.at[k] - a;
      const double off = std::abs(d.east_m * p.north_m - d.north_m * p.east_m);
      if (off <= best_m) continue;
      best_m = off;
      best = k;
    }
    if (best_m >= 0.0 && (out.empty() || out.back() < best)) out.push_back(best);
  };
  double turn = 0.0;
  double begin = -1.0;
  for (double at = 0.0; at <= u.back(); at += kStep_m) {
    const double bend = bend_1pm(at);
    const bool sharp = std::abs(bend) > limits_.sharpest_1pm && (begin < 0.0 || bend * turn > 0.0);
    if (sharp) {
      if (begin < 0.0) begin = at;
      turn += bend * kStep_m * size(curve_.place(at).first);
      continue;
    }
    if (begin >= 0.0 && std::abs(turn) > limits_.corner_rad) take(begin, at);
    begin = -1.0;
    turn = 0.0;
  }
  if (begin >= 0.0 && std::abs(turn) > limits_.corner_rad) take(begin, u.back());
  return out;
}

std::vector<CurvePoint> PieceFit::points() const {
  std::vector<CurvePoint> out;
  std::vector<double> yaw;
  const auto put = [&](double u) {
    const SplinePlace c = curve_.place(u);
    const bool apart = out.empty() || base::distance_m(out.back().at, c.at) >= kLeast_m;
    if (!apart) return;
    out.push_back({c.at, u, 0.0});
    yaw.push_back(std::atan2(c.first.north_m, c.first.east_m));
  };
  for (std::size_t i = 0; i < curve_.pieces(); ++i) {
    const double from = static_cast<double>(i) * curve_.piece();
    const SplinePlace begin = curve_.place(from);
    const SplinePlace end = curve_.place(from + curve_.piece());
    const double turn =
        std::abs(base::angle_diff_rad(std::atan2(begin.first.north_m, begin.first.east_m),
                                      std::atan2(end.first.north_m, end.first.east_m)));
    const double way_m = base::distance_m(begin.at, end.at);
    const double most = std::max(turn / 0.14, std::sqrt(turn * way_m / (8.0 * kSagitta_m)));
    const int n = static_cast<int>(std::clamp(std::ceil(most), 1.0, 8.0));
    for (int k = 0; k < n; ++k) put(from + curve_.piece() * k / n);
  }
  const double end_u = chain_.u.back();
  const SplinePlace end = curve_.place(end_u);
  while (out.size() > 1 && base::distance_m(out.back().at, end.at) < kLeast_m) {
    out.pop_back();
    yaw.pop_back();
  }
  out.push_back({end.at, end_u, 0.0});
  yaw.push_back(std::atan2(end.first.north_m, end.first.east_m));
  if (ends_.begin) out.front().at = *ends_.begin;
  if (ends_.end) out.back().at = *ends_.end;
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    const double way_m = std::max(kLeast_m, base::distance_m(out[i].at, out[i + 1].at));
    out[i].curvature_1pm = base::angle_diff_rad(yaw[i], yaw[i + 1]) / way_m;
  }
  return out;
}

Apart apart(const Chain& chain, std::span<const CurvePoint> points, const FitLimits& limits) {
  const auto& u = chain.u;
  std::vector<double> off_m(u.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (; k < u.size() && u[k] <= points[i].u; ++k) {
      const CurvePoint& from = points[i == 0 ? 0 : i - 1];
      const double way = points[i].u - from.u;
      const double part = way > 0.0 ? (u[k] - from.u) / way : 0.0;
      off_m[k] = base::distance_m(between(from.at, points[i].at, part), chain.at[k]);
    }
  }
  Apart worst;
  const auto note = [&](double at, double m, double most_m) {
    worst.m = std::max(worst.m, m);
    if (m - most_m <= worst.beyond_m) return;
    worst.beyond_m = m - most_m;
    worst.u = at;
  };
  for (k = 0; k < u.size(); ++k) note(u[k], off_m[k], room_m(u, off_m, k, limits));
  k = 0;
  for (const CurvePoint& p : points) {
    while (k + 1 < u.size() && u[k + 1] <= p.u) ++k;
    const double most_m = std::max(room_m(u, off_m, k, limits), room_m(u, off_m, k + 1, limits));
    note(p.u, base::distance_m(p.at, chain.place(p.u)), most_m);
  }
  return worst;
}

}  // namespace roverd::nav
