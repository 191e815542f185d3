#include "nav/mapping/standing.hpp"

#include <algorithm>
#include <cmath>

#include "nav/cells/lowest.hpp"

namespace roverd::nav::mapping {

namespace {

using cells::CellIndex;
using cells::KeyTable;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kBefore_m = 0.6;  // so long before its end a ray says nothing: it grazes walls
constexpr double kThrough = 0.5;   // of a cell's edge: so near to its middle a ray goes through it
constexpr int kEveryRay = 2;       // neighbours say the same
constexpr std::uint16_t kFewPassed = 2;
constexpr std::uint32_t kFewClouds = 3;

void count(std::uint32_t cloud, std::uint32_t& last, std::uint16_t& times) noexcept {
  if (last == cloud) return;
  last = cloud;
  if (times < UINT16_MAX) ++times;
}

}  // namespace

void Standing::meet(std::uint32_t cloud, const cells::Cloud& points, const Isometry3d& x_mb) {
  clouds_ = std::max(clouds_, cloud + 1);
  cells::Cell one;
  one.points = 1.0;
  for (const Eigen::Vector3f& p : points) {
    one.mean_m = x_mb * p.cast<double>();
    CellIndex index;
    if (!cells::index_of(one.mean_m, cell_m_, index)) continue;
    const auto fresh = static_cast<std::int32_t>(met_.size());
    const std::uint64_t key = cells::key_of(index);
    const bool full = met_.size() >= cells::CellMap::kMaxCells;
    const std::int32_t at = full ? table_.find(key) : table_.find_or_add(key, fresh);
    if (at < 0) continue;
    if (at == fresh) met_.emplace_back();
    Met& met = met_[static_cast<std::size_t>(at)];
    cells::merge(met.cell, one);
    count(cloud, met.last, met.times);
  }
}

Standing::Met* Standing::met_at(const Vector3d& m) noexcept {
  CellIndex index;
  if (!cells::index_of(m, cell_m_, index)) return nullptr;
  const std::int32_t at = table_.find(cells::key_of(index));
  return at < 0 ? nullptr : &met_[static_cast<std::size_t>(at)];
}

void Standing::pass(std::uint32_t cloud, const Vector3d& eye, const Vector3d& end) {
  const double length_m = (end - eye).norm();
  const Vector3d way = (end - eye) / length_m;
  for (double r = cell_m_; r < length_m - kBefore_m; r += 0.5 * cell_m_) {
    Met* met = met_at(eye + r * way);
    // A cloud that met it may have seen past it as well: map() weighs one against the other.
    if (met == nullptr || met->through == cloud) continue;
    const Vector3d to = met->cell.mean_m - eye;
    if ((to - to.dot(way) * way).norm() < kThrough * cell_m_) {
      count(cloud, met->through, met->passed);
    }
  }
}

void Standing::look_through(std::uint32_t cloud, const cells::Cloud& points, const Isometry3d& x_mb,
                            const Vector3d& eye_m) {
  const Vector3d eye = x_mb * eye_m;
  for (std::size_t i = 0; i < points.size(); i += kEveryRay) {
    pass(cloud, eye, x_mb * points[i].cast<double>());
  }
}

cells::CellMap Standing::map() const {
  cells::Lowest lowest;
  for (const Met& m : met_) lowest.put(m.cell.mean_m);
  cells::CellMap out(cell_m_);
  for (const Met& m : met_) {
    if (clouds_ >= kFewClouds) {
      if (m.times < 2) continue;
      const bool seen_through = m.passed >= kFewPassed && m.passed > m.times;
      const bool over_ground = lowest.over_m(m.cell.mean_m) >= cells::Lowest::kStands_m;
      if (seen_through && over_ground) continue;
    }
    out.add(m.cell);
  }
  return out;
}

}  // namespace roverd::nav::mapping
