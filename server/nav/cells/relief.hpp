#pragma once
// A map of cells made ready to be laid on another one: small pieces of surface with their
// directions, a tree that finds the nearest, and coarse cells for the start.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "nav/cells/cell_map.hpp"

namespace roverd::nav::cells {

/// A normal distribution: where a surface is, and how far it reaches in which direction.
struct Surfel {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d across = Eigen::Vector3d::UnitZ();  ///< the axis of least deviation, of length 1
  /// Variance of its direction, rad², by how much thicker than wide it was measured: much at
  /// corners, and where the two faces of a thin wall are its neighbours. [0, 1]
  double tilt_rad2 = 0.0;
};

/// Immutable once made; may be read by any number of threads.
class Relief {
 public:
  /// Edges of the coarse cells, in cells of the map, the coarsest first.
  static constexpr std::array<int, 3> kCoarser = {16, 8, 4};
  /// A piece of surface is fitted to the points of its cell where they are many and lie in a plane,
  /// else to so many cells.
  static constexpr std::size_t kNeighbours = 10;

  /// A map of no cells is a Relief of none: nothing is ever laid on it.
  explicit Relief(const CellMap& map);
  Relief(Relief&&) noexcept;
  Relief& operator=(Relief&&) noexcept;
  ~Relief();

  double cell_m() const noexcept { return cell_m_; }
  /// One for each cell of the map. Flattened: across the surface the deviation is taken as
  /// 0.16 cells, along it as 5 cells (Segal, Haehnel, Thrun 2009, "Generalized-ICP", with the
  /// ratio of variances 10^-3), whatever it was measured to be.
  const std::vector<Surfel>& surfels() const noexcept { return surfels_; }

  /// @return the surfel whose mean is nearest, and its distance; null where none is within reach.
  const Surfel* nearest(const Eigen::Vector3d& p_m, double reach_m) const noexcept;

  /// Coarse cells of five points and more, as they were measured (no thinner than a tenth of
  /// their longest deviation).
  struct Level {
    double cell_m = 0.0;
    KeyTable table;
    std::vector<Surfel> surfels;
    /// Of the cell that holds the point and its six neighbours the one whose mean is nearest;
    /// null where all are empty.
    const Surfel* nearest(const Eigen::Vector3d& p_m) const noexcept;
  };
  const std::array<Level, 3>& levels() const noexcept { return levels_; }

 private:
  struct Tree;
  void fit_surfels(const CellMap& map);
  double cell_m_;
  std::vector<Surfel> surfels_;
  std::array<Level, 3> levels_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace roverd::nav::cells
