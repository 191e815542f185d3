#include "nav/cells/cell_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace roverd::nav::cells {

namespace {

constexpr std::int32_t kHalf = 1 << 20;  // cells on either side of the origin
constexpr double kFar = kHalf - 2;       // neighbours have keys, too

}  // namespace

bool finite(const Cell& c) noexcept {
  const bool spread = std::all_of(c.spread_m2.begin(), c.spread_m2.end(),
                                  [](double v) { return std::isfinite(v); });
  return spread && std::isfinite(c.points) && c.points > 0.0 && c.mean_m.allFinite();
}

KeyTable::KeyTable(std::size_t expected)
    : slots_(std::bit_ceil(std::max<std::size_t>(expected + expected / 3 + 1, 64))) {}

std::size_t KeyTable::place(std::uint64_t key) const noexcept {
  std::size_t i = first_slot(key, std::countr_zero(slots_.size()));
  while (slots_[i].at >= 0 && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
  return i;
}

std::int32_t KeyTable::find(std::uint64_t key) const noexcept {
  return slots_[place(key)].at;
}

std::int32_t KeyTable::find_or_add(std::uint64_t key, std::int32_t fresh) {
  if (4 * used_ >= 3 * slots_.size()) grow();
  Slot& slot = slots_[place(key)];
  if (slot.at < 0) {
    slot = {key, fresh};
    ++used_;
  }
  return slot.at;
}

void KeyTable::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (slot.at >= 0) slots_[place(slot.key)] = slot;
  }
}

void merge(Cell& into, const Cell& more) noexcept {
  const double all = into.points + more.points;
  if (!(all > 0.0)) return;
  const Eigen::Vector3d d = more.mean_m - into.mean_m;
  const double w = into.points * more.points / all;
  const std::array<double, 6> between = {d.x() * d.x(), d.x() * d.y(), d.x() * d.z(),
                                         d.y() * d.y(), d.y() * d.z(), d.z() * d.z()};
  for (std::size_t i = 0; i < 6; ++i) into.spread_m2[i] += more.spread_m2[i] + w * between[i];
  into.mean_m += d * (more.points / all);
  into.points = all;
}

Eigen::Matrix3d covariance_m2(const Cell& c) noexcept {
  if (!(c.points > 0.0)) return Eigen::Matrix3d::Zero();
  const auto& s = c.spread_m2;
  Eigen::Matrix3d m;
  m << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  return m / c.points;
}

std::uint64_t key_of(const CellIndex& c) noexcept {
  const auto axis = [](std::int32_t i) { return static_cast<std::uint64_t>(i + kHalf); };
  return axis(c.x) << 42U | axis(c.y) << 21U | axis(c.z);
}

double reach_m(double cell_m) noexcept {
  return cell_m * kFar;
}

bool index_of(const Eigen::Vector3d& p_m, double cell_m, CellIndex& out) noexcept {
  const Eigen::Vector3d at = p_m / cell_m;
  // Written so that NaN is refused.
  if (!(std::abs(at.x()) < kFar && std::abs(at.y()) < kFar && std::abs(at.z()) < kFar)) {
    return false;
  }
  out = {static_cast<std::int32_t>(std::floor(at.x())),
         static_cast<std::int32_t>(std::floor(at.y())),
         static_cast<std::int32_t>(std::floor(at.z()))};
  return true;
}

CellMap::CellMap(double cell_m) : cell_m_(std::clamp(cell_m, 1e-3, 100.0)) {}

CellMap::Added CellMap::add(std::span<const Eigen::Vector3f> cloud) {
  Added added;
  for (const Eigen::Vector3f& p : cloud) {
    Cell one;
    one.points = 1.0;
    one.mean_m = p.cast<double>();
    CellIndex index;
    if (!index_of(one.mean_m, cell_m_, index)) {
      ++added.no_number;
    } else if (add(one)) {
      ++added.taken;
    } else {
      ++added.no_room;
    }
  }
  return added;
}

void CellMap::expect(std::size_t cells) {
  cells_.reserve(std::min(cells, kMaxCells));
}

bool CellMap::add(const Cell& cell) {
  CellIndex index;
  if (!finite(cell) || !index_of(cell.mean_m, cell_m_, index)) return false;
  const std::uint64_t key = key_of(index);
  std::int32_t at = -1;
  if (cells_.size() < kMaxCells) {
    at = table_.find_or_add(key, static_cast<std::int32_t>(cells_.size()));
  } else {
    at = table_.find(key);
  }
  if (at < 0) return false;
  if (static_cast<std::size_t>(at) == cells_.size()) cells_.emplace_back();
  merge(cells_[static_cast<std::size_t>(at)], cell);
  return true;
}

CellMap CellMap::coarser(int times) const {
  CellMap out(cell_m_ * std::max(times, 1));
  for (const Cell& cell : cells_) out.add(cell);
  return out;
}

}  // namespace roverd::nav::cells
