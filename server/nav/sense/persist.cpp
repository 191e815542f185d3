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

/// How many beams meet it. @param steps_m the distance at which it is as wide as one step
float beams(float steps_m, float away_m, float most) noexcept {
  return std::min(most, steps_m / away_m);
}
}  // namespace

Persist::Persist(const PersistParams& params, double range_m) : p_(params) {
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

std::uint32_t Persist::judge(std::vector<Voxel>& voxels, const Pose2& pose, const From& from) {
  ++scan_;
  fill(voxels, pose);
  const float wide = from.step_rad > 0.0F ? static_cast<float>(p_.least_m) / from.step_rad : 0.0F;
  const float high = from.step_up_rad > 0.0F ? kLow_m / from.step_up_rad : 0.0F;
  least_.clear();
  std::size_t i = 0;
  for (const Voxel& v : voxels) {
    if (v.kind != Kind::Obstacle) continue;
    const float away = std::max(0.05F, std::hypot(v.x_m - from.x_m, v.y_m - from.y_m));
    const float rows = std::max(1.0F, beams(high, away, kMostUp));
    // Beams are whole: what is as wide as two and a half steps is sure of two.
    least_.push_back(std::max(1.0F, std::floor(rows * beams(wide, away, kMostAcross))));
    const Around here = around(where_[i], where_[i + 1]);
    if (static_cast<float>(here.points) >= least_.back()) {
      cells_[at(where_[i], where_[i + 1])].seen |= 1U;
    }
    i += 2;
  }
  const std::uint32_t recent = (1U << static_cast<std::uint32_t>(p_.of_scans)) - 1U;
  std::uint32_t held = 0;
  i = 0;
  for (Voxel& v : voxels) {
    if (v.kind != Kind::Obstacle) continue;
    const Around here = around(where_[2 * i], where_[2 * i + 1]);
    const float at_once = static_cast<float>(p_.at_once) * least_[i];
    ++i;
    if (here.voxels >= p_.at_once && static_cast<float>(here.points) >= at_once) continue;
    if (std::popcount(here.seen & recent) >= p_.hits) continue;
    v.kind = Kind::Passing;
    ++held;
  }
  return held;
}

}  // namespace roverd::nav::sense
