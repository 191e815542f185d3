#pragma once
// What stands, out of clouds at known places: cells that were met by two of them at least, and not
// seen through by most. Only what is over the ground can be seen through: rays graze the ground.
//
// First all clouds are met, then all are looked through. Frame M, z up. One thread.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "nav/cells/cell_map.hpp"

namespace roverd::nav::mapping {

class Standing {
 public:
  explicit Standing(double cell_m) : cell_m_(cell_m) {}

  /// @param cloud number of this one, rising from 0. @param points in B
  void meet(std::uint32_t cloud, const cells::Cloud& points, const Eigen::Isometry3d& x_mb);
  /// @param eye_m where the lidar stood, in B
  void look_through(std::uint32_t cloud, const cells::Cloud& points, const Eigen::Isometry3d& x_mb,
                    const Eigen::Vector3d& eye_m);
  /// Of fewer than three clouds all is kept.
  cells::CellMap map() const;

 private:
  static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
  /// What the clouds say of one cell.
  struct Met {
    cells::Cell cell;
    std::uint32_t last = kNever;     ///< cloud that met it
    std::uint32_t through = kNever;  ///< cloud that saw through it
    std::uint16_t times = 0;
    std::uint16_t passed = 0;
  };
  Met* met_at(const Eigen::Vector3d& m) noexcept;
  void pass(std::uint32_t cloud, const Eigen::Vector3d& eye, const Eigen::Vector3d& end);
  double cell_m_;
  cells::KeyTable table_;
  std::vector<Met> met_;
  std::uint32_t clouds_ = 0;
};

}  // namespace roverd::nav::mapping
