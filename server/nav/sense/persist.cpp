#include "nav/sense/persist.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace roverd::nav::sense {

namespace {
constexpr float kLow_m = 0.08F;  // nothing lower is looked for
// More is not asked for, whatever step was told: with too small a step all would be drops.
constexpr float kMostAcross = 6.0F;
constexpr float kMostUp = 16.0F;

constexpr float kStep_m = 0.25F;
constexpr float kView_rad = 4.7F;  // of a scanner; a lidar sees more, and has less rain before it
constexpr float kSmooth = 0.1F;
constexpr double kBelieved = 1e-9;  // at one place in one scan, of drops
constexpr int kMostHits = 7;
constexpr int kMostScans = 8;
constexpr float kMostMore = 4.0F;
// Three by three cells saw something when one of them did, each with those about it.
constexpr double kAnyOf = 3.0;
constexpr float kFastest_m = 0.5F;  // in a scan: more is a jump

/// So many or more, of those that come singly. Its series from the first term on.
double poisson_tail(double mean, int from) noexcept {
  double term = std::exp(-mean);
  for (int i = 1; i <= from; ++i) term *= mean / i;
  double sum = term;
  for (int i = from + 1; i < from + 24; ++i) sum += term *= mean / i;
  return std::min(sum, 1.0);
}

/// So many or more of n.
double binomial_tail(double p, int from, int n) noexcept {
  double ways = 1.0;
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) {
    if (i >= from) sum += ways * std::pow(p, i) * std::pow(1.0 - p, n - i);
    ways *= static_cast<double>(n - i) / (i + 1);
  }
  return sum;
}

/// How many beams meet it. @param steps_m the distance at which it is as wide as one step
float beams(float steps_m, float away_m, float most) noexcept {
  return std::min(most, steps_m / away_m);
}
}  // namespace

Persist::Persist(const PersistParams& params, double range_m)
    : p_(params), range_m_(static_cast<float>(range_m)) {
  const auto across = static_cast<std::uint32_t>(std::ceil(2.0 * range_m / p_.cell_m)) + 3;
  const auto side = std::bit_ceil(std::clamp(across, 8U, 2048U));
  mask_ = static_cast<std::int32_t>(side) - 1;
  cells_.resize(static_cast<std::size_t>(side) * side);
}

std::size_t Persist::at(std::int32_t ix, std::int32_t iy) const noexcept {
  return static_cast<std::size_t>(iy & mask_) * static_cast<std::size_t>(mask_ + 1) +
         static_cast<std::size_t>(ix & mask_);
}

void Persist::fill(const std::vector<Voxel>& voxels, const Pose2& pose) {
  where_.clear();
  const double c = std::cos(pose.yaw_rad) / p_.cell_m;
  const double s = std::sin(pose.yaw_rad) / p_.cell_m;
  const double x0 = pose.x_m / p_.cell_m;
  const double y0 = pose.y_m / p_.cell_m;
  for (const Voxel& v : voxels) {
    if (v.kind != Kind::Obstacle) continue;
    const auto x = static_cast<double>(v.x_m);
    const auto y = static_cast<double>(v.y_m);
    const auto ix = static_cast<std::int32_t>(std::floor(x0 + c * x - s * y));
    const auto iy = static_cast<std::int32_t>(std::floor(y0 + s * x + c * y));
    where_.push_back(ix);
    where_.push_back(iy);
    Cell& cell = cells_[at(ix, iy)];
    if (cell.scan != scan_) {
      const std::uint32_t ago = scan_ - cell.scan;
      cell.seen = ago > 15 ? std::uint16_t{0} : static_cast<std::uint16_t>(cell.seen << ago);
      cell.scan = scan_;
      cell.voxels = 0;
      cell.points = 0;
    }
    if (cell.voxels < 0xFFFFU) ++cell.voxels;
    cell.points += v.points;
  }
}

Persist::Around Persist::around(std::int32_t ix, std::int32_t iy) const noexcept {
  Around out;
  for (std::int32_t dy = -1; dy <= 1; ++dy) {
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      const Cell& cell = cells_[at(ix + dx, iy + dy)];
      const std::uint32_t ago = scan_ - cell.scan;
      if (ago > 15) continue;
      out.seen |= static_cast<std::uint32_t>(cell.seen) << ago;
      if (ago != 0) continue;
      out.voxels += cell.voxels;
      out.points += cell.points;
    }
  }
  return out;
}

float Persist::least_of(float away_m, const From& from) const noexcept {
  const float wide = from.step_rad > 0.0F ? static_cast<float>(p_.least_m) / from.step_rad : 0.0F;
  const float high = from.step_up_rad > 0.0F ? kLow_m / from.step_up_rad : 0.0F;
  const float rows = std::max(1.0F, beams(high, away_m, kMostUp));
  // Beams are whole: what is as wide as two and a half steps is sure of two.
  return std::max(1.0F, std::floor(rows * beams(wide, away_m, kMostAcross)));
}

/// Of drops, by those that were counted as far away.
double Persist::per_m2(float away_m) const noexcept {
  const auto metre = std::min(static_cast<std::size_t>(away_m), fresh_by_.size() - 1);
  const float area_m2 = kView_rad * (static_cast<float>(metre) + 0.5F);
  return static_cast<double>(fresh_by_[metre] / area_m2);
}

/// @param drops that lie about a place, in the mean @param least echoes that count there
bool Persist::drops_pass(const Asked& a, double drops, float least) const noexcept {
  if (drops < 1e-4) return false;  // a dry day
  const auto hit = [&](double mean) {
    return std::min(0.9, kAnyOf * poisson_tail(mean, static_cast<int>(least + a.more)));
  };
  // Of many drops some fall where one was lately: these were not counted.
  double all = drops;
  for (int i = 0; i < 3; ++i) {
    all = std::min(4.0 * drops, drops / std::pow(1.0 - hit(all), p_.of_scans));
  }
  return binomial_tail(hit(all), a.hits, a.of_scans) > kBelieved;
}

void Persist::ask(const From& from) {
  const double side = 3.0 * p_.cell_m;
  const auto scans = [this](int hits) { return hits <= p_.of_scans ? p_.of_scans : kMostScans; };
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    Asked& a = asked_[i];
    const float away = std::max(0.05F, kStep_m * static_cast<float>(i));  // the nearer end
    a = {p_.hits, p_.of_scans, p_.at_once, 0.0F};
    double drops = side * side * static_cast<double>(fresh_ / (kView_rad * range_m_ * away));
    if (from.step_up_rad > 0.0F) {
      drops = std::max(drops, side * side * per_m2(away));
      // The fewest that counted there, since the first of the scans.
      const float least = least_of(away + kStep_m + kMostScans * step_m_, from);
      while (drops_pass(a, drops, least) && a.hits < kMostHits) a.of_scans = scans(++a.hits);
      while (a.more < kMostMore && drops_pass(a, drops, least)) a.more += 1.0F;
    } else {
      const double hit = poisson_tail(drops, static_cast<int>(least_of(away + kStep_m, from)));
      while (a.hits < kMostHits && binomial_tail(hit, a.hits, a.of_scans) > kBelieved) {
        a.of_scans = scans(++a.hits);
      }
    }
    while (a.at_once < 3 * p_.at_once && poisson_tail(drops, a.at_once) > kBelieved) ++a.at_once;
  }
}

const Persist::Asked& Persist::asked(float away_m) const noexcept {
  const auto i = static_cast<std::size_t>(away_m / kStep_m);
  return asked_[std::min(i, asked_.size() - 1)];
}

std::uint32_t Persist::judge(std::vector<Voxel>& voxels, const Pose2& pose, const From& from) {
  ++scan_;
  step_m_ = static_cast<float>(std::hypot(pose.x_m - before_.x_m, pose.y_m - before_.y_m));
  if (!(step_m_ < kFastest_m)) step_m_ = 0.0F;
  before_ = pose;
  fill(voxels, pose);
  away_.clear();
  const std::uint32_t lately = ((1U << static_cast<std::uint32_t>(p_.of_scans)) - 1U) << 1U;
  float fresh = 0.0F;
  std::array<float, 16> fresh_by{};
  std::size_t i = 0;
  for (const Voxel& v : voxels) {
    if (v.kind != Kind::Obstacle) continue;
    away_.push_back(std::max(0.05F, std::hypot(v.x_m - from.x_m, v.y_m - from.y_m)));
    const Around here = around(where_[i], where_[i + 1]);
    const float least = least_of(away_.back(), from) + asked(away_.back()).more;
    if (static_cast<float>(here.points) >= least) {
      cells_[at(where_[i], where_[i + 1])].seen |= 1U;
    }
    if ((here.seen & lately) == 0 && here.voxels < p_.at_once) {
      fresh += 1.0F;
      const auto metre = static_cast<std::size_t>(away_.back());
      if (metre < fresh_by.size()) fresh_by[metre] += 1.0F;
    }
    i += 2;
  }
  // All is new to the first scan.
  if (scan_ > 1) {
    fresh_ += kSmooth * (fresh - fresh_);
    for (std::size_t k = 0; k < fresh_by.size(); ++k) {
      fresh_by_[k] += kSmooth * (fresh_by[k] - fresh_by_[k]);
    }
  }
  ask(from);
  std::uint32_t held = 0;
  i = 0;
  for (Voxel& v : voxels) {
    if (v.kind != Kind::Obstacle) continue;
    const Around here = around(where_[2 * i], where_[2 * i + 1]);
    const Asked& a = asked(away_[i]);
    const float points = static_cast<float>(a.at_once) * least_of(away_[i], from);
    ++i;
    if (here.voxels >= a.at_once && static_cast<float>(here.points) >= points) continue;
    const std::uint32_t recent = (1U << static_cast<std::uint32_t>(a.of_scans)) - 1U;
    if (std::popcount(here.seen & recent) >= a.hits) continue;
    v.kind = Kind::Passing;
    ++held;
  }
  return held;
}

}  // namespace roverd::nav::sense
