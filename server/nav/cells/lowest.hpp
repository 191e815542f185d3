#pragma once
// How low the ground lies about a place of a map of cells: the lowest of what was seen in squares
// of a metre. What rises kStands_m over it stands on it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "nav/cells/cell_map.hpp"

namespace roverd::nav::cells {

/// Not shared between threads while it is filled.
class Lowest {
 public:
  static constexpr double kStands_m = 0.3;

  /// @param m z up, within what a CellMap takes
  void put(const Eigen::Vector3d& m) {
    const auto fresh = static_cast<std::int32_t>(low_m_.size());
    const std::int32_t at = table_.find_or_add(key(m, 0, 0), fresh);
    if (at == fresh) low_m_.push_back(m.z());
    double& low = low_m_[static_cast<std::size_t>(at)];
    low = std::min(low, m.z());
  }
  /// How high it is over the lowest of its square and those beside it; 0 where it is that itself.
  double over_m(const Eigen::Vector3d& m) const noexcept {
    double low = m.z();
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const std::int32_t at = table_.find(key(m, dx, dy));
        if (at >= 0) low = std::min(low, low_m_[static_cast<std::size_t>(at)]);
      }
    }
    return m.z() - low;
  }

 private:
  static constexpr double kSquare_m = 1.0;
  static std::uint64_t key(const Eigen::Vector3d& m, int dx, int dy) noexcept {
    CellIndex index;
    (void)index_of({m.x(), m.y(), 0.0}, kSquare_m, index);  // it is in a finer cell
    return key_of({index.x + dx, index.y + dy, 0});
  }
  KeyTable table_;
  std::vector<double> low_m_;
};

}  // namespace roverd::nav::cells
