#include "nav/behave/breadcrumbs.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::nav {
namespace {

constexpr double kNear = 0.99;  ///< of the accuracy: so near the robot was there before
constexpr double kLoop = 4.0;   ///< a loop is longer than so many accuracies
constexpr double kGap = 2.5;    ///< crumbs farther apart than so many were not driven between
constexpr double kCoarser = 1.5;

struct Foot {
  EnuPoint at;
  double off_m2 = 0.0;  ///< squared: a root for each of them is most of the work
};

/// The nearest point of a segment.
Foot foot_on(EnuPoint p, EnuPoint a, EnuPoint b) noexcept {
  const EnuPoint d = b - a;
  const double square = d.east_m * d.east_m + d.north_m * d.north_m;
  const EnuPoint q = p - a;
  const double t =
      square > 0.0 ? std::clamp((q.east_m * d.east_m + q.north_m * d.north_m) / square, 0.0, 1.0)
                   : 0.0;
  const EnuPoint at{a.east_m + t * d.east_m, a.north_m + t * d.north_m};
  const EnuPoint off = p - at;
  return {at, off.east_m * off.east_m + off.north_m * off.north_m};
}

/// Iterative Ramer-Douglas-Peucker. The ends of a gap stay. @param keep, stack room to work in
void simplify(std::vector<Crumb>& all, double most_m, std::vector<char>& keep,
              std::vector<std::pair<std::size_t, std::size_t>>& stack) {
  if (all.size() < 3) return;
  keep.assign(all.size(), 0);
  keep.front() = keep.back() = 1;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].gap) keep[i] = keep[i - 1] = 1;
  }
  stack.clear();
  std::size_t from = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (keep[i] == 0) continue;
    stack.emplace_back(from, i);
    from = i;
  }
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    double worst_m2 = most_m * most_m;
    std::size_t worst = a;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double off_m2 = foot_on(all[i].at, all[a].at, all[b].at).off_m2;
      if (off_m2 <= worst_m2) continue;
      worst_m2 = off_m2;
      worst = i;
    }
    if (worst == a) continue;
    keep[worst] = 1;
    stack.emplace_back(a, worst);
    stack.emplace_back(worst, b);
  }
  std::size_t n = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (keep[i] != 0) all[n++] = all[i];
  }
  all.resize(n);
}

}  // namespace

std::vector<EnuPoint> way_back(std::vector<Crumb> crumbs, double accuracy_m) {
  std::vector<char> keep;
  std::vector<std::pair<std::size_t, std::size_t>> stack;
  simplify(crumbs, accuracy_m / 2.0, keep, stack);
  std::vector<EnuPoint> way;
  way.reserve(crumbs.size());
  for (auto c = crumbs.rbegin(); c != crumbs.rend(); ++c) way.push_back(c->at);
  return way;
}

Breadcrumbs::Breadcrumbs(double accuracy_m) : accuracy_m_(accuracy_m) {
  crumbs_.reserve(kMost + 4);
  keep_.reserve(kMost + 4);
  stack_.reserve(kMost + 4);
}

void Breadcrumbs::clear() noexcept {
  crumbs_.clear();
  ++changes_;
  coarse_m_ = 0.0;
  jumped_ = false;
}

void Breadcrumbs::take(EnuPoint at, double sigma_m, bool jumped, const May& may) {
  jumped_ = jumped_ || jumped;
  if (!std::isfinite(at.east_m) || !std::isfinite(at.north_m) || !(sigma_m < accuracy_m_)) return;
  if (crumbs_.empty()) {
    crumbs_.push_back({at, false});
    ++changes_;
    jumped_ = false;
    return;
  }
  const double far_m = base::distance_m(at, crumbs_.back().at);
  if (far_m < accuracy_m_) return;
  ++changes_;
  const bool gap = jumped_ || far_m > kGap * accuracy_m_;
  jumped_ = false;
  if (!gap) prune(at, may);
  // The loop may have ended where the last crumb lies.
  if (base::distance_m(at, crumbs_.back().at) > 0.2 * accuracy_m_) crumbs_.push_back({at, gap});
  if (crumbs_.size() >= kMost) thin();
}

/// Was the robot here before? Then what it did meanwhile is forgotten; the earliest time counts,
/// because it takes away most.
void Breadcrumbs::prune(EnuPoint at, const May& may) {
  // The way back to each segment grows towards the start: nearer ones are no loop yet.
  double along_m = base::distance_m(at, crumbs_.back().at);
  std::size_t end = crumbs_.size() - 1;
  while (end > 0 && along_m <= kLoop * accuracy_m_) {
    along_m += base::distance_m(crumbs_[end].at, crumbs_[end - 1].at);
    --end;
  }
  for (std::size_t i = 0; i < end; ++i) {
    if (crumbs_[i + 1].gap) continue;
    const Foot foot = foot_on(at, crumbs_[i].at, crumbs_[i + 1].at);
    if (foot.off_m2 >= kNear * kNear * accuracy_m_ * accuracy_m_) continue;
    if (may && !may(foot.at, at)) continue;
    crumbs_.resize(i + 1);
    if (base::distance_m(foot.at, crumbs_.back().at) > 0.05) crumbs_.push_back({foot.at, false});
    return;
  }
}

void Breadcrumbs::thin() {
  if (coarse_m_ <= 0.0) coarse_m_ = accuracy_m_ / 2.0;
  simplify(crumbs_, coarse_m_, keep_, stack_);
  while (crumbs_.size() > kMost * 3 / 4 && coarse_m_ < 1e3) {
    coarse_m_ *= kCoarser;
    simplify(crumbs_, coarse_m_, keep_, stack_);
  }
  // Gaps and nothing else: the oldest of them cannot be driven anyway.
  if (crumbs_.size() >= kMost) crumbs_.erase(crumbs_.begin(), crumbs_.begin() + kMost / 4);
}

std::vector<EnuPoint> Breadcrumbs::way_back() const {
  return nav::way_back(crumbs_, accuracy_m_);
}

double Breadcrumbs::longest_gap_m() const noexcept {
  double worst = 0.0;
  for (std::size_t i = 1; i < crumbs_.size(); ++i) {
    if (crumbs_[i].gap) {
      worst = std::max(worst, base::distance_m(crumbs_[i - 1].at, crumbs_[i].at));
    }
  }
  return worst;
}

double Breadcrumbs::length_m() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < crumbs_.size(); ++i) {
    sum += base::distance_m(crumbs_[i - 1].at, crumbs_[i].at);
  }
  return sum;
}

}  // namespace roverd::nav
