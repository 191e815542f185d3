#pragma once
// How likely something stands at a place: the points of some scans, each blurred, on a grid. Scans
// are laid into it.
//
// Frame R: the field's, in which its points are told. Metres, yaw left positive.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "nav/sense/odometry.hpp"

namespace roverd::nav::mapping {

using sense::Pose2;
using Points = std::vector<Eigen::Vector2f>;

/// One of the points in each square of that edge: the first.
Points thinned(std::span<const Eigen::Vector2f> points, double edge_m);

/// Immutable once made.
class Field {
 public:
  static constexpr double kCell_m = 0.05;
  static constexpr double kBlur_m = 0.08;  ///< deviation
  static constexpr std::int32_t kBlock = 8;
  /// Longer fields than that are cut about the middle of their points: 4 million cells at most.
  static constexpr double kMost_m = 100.0;

  /// Of no points: 0 everywhere.
  explicit Field(std::span<const Eigen::Vector2f> points);

  /// 0 to 255 at a cell; 0 outside.
  std::uint8_t at(std::int32_t column, std::int32_t row) const noexcept {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return 0;
    return cells_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
  }
  /// No cell from (column, row) to kBlock - 1 further both ways is above it. Column and row are
  /// those of a cell, which may lie outside.
  std::uint8_t bound(std::int32_t column, std::int32_t row) const noexcept;
  /// Cell of a place, not rounded.
  Eigen::Vector2d cell_of(const Eigen::Vector2d& p_m) const noexcept {
    return (p_m - corner_m_) / kCell_m;
  }
  /// Between the cells' middles, 0 to 1, and how it changes per metre.
  double sample(const Eigen::Vector2d& p_m, Eigen::Vector2d& slope_1pm) const noexcept;

 private:
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::int32_t block_columns_ = 0;
  std::int32_t block_rows_ = 0;
  Eigen::Vector2d corner_m_ = Eigen::Vector2d::Zero();
  std::vector<std::uint8_t> cells_;
  std::vector<std::uint8_t> blocks_;
};

/// Where a scan lies in the field.
struct Fit {
  Pose2 pose;          ///< X_RB
  double score = 0.0;  ///< mean of the field at its points, [0, 1]
  /// Of x, y, yaw in R (m, rad).
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
};

struct Window {
  double m = 0.4;    ///< to each side
  double rad = 0.3;  ///< to each side
  /// Deviations of the guess: the search prefers what is near it, the refinement is held by it
  /// where the scan holds nothing (a corridor). 0: it weighs nothing.
  double guess_m = 0.0;
  double guess_rad = 0.0;
};

/// The best place within the window (correlative: Olson 2009, "Real-time correlative scan
/// matching"; every place is tried or bounded, so none is missed), then refined (Gauss-Newton on
/// the field: Kohlbrecher 2011). @param points of the scan, in B. Pure.
Fit search(const Field& field, std::span<const Eigen::Vector2f> points, const Pose2& guess,
           const Window& window);

/// The refinement alone.
Fit refine(const Field& field, std::span<const Eigen::Vector2f> points, const Pose2& start,
           const Pose2& guess, const Window& window);

}  // namespace roverd::nav::mapping
