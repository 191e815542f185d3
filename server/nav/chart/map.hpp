#pragma once
// A map of the plane in square cells: what is free, what is occupied, what nobody has seen.
//
//   M   the map's frame: metres, yaw left positive; missions and poses in the map are told in it
//   G   the grid's own: origin at the lower left corner of cell (0, 0), x along a row, y from row
//       to row; X_MG is the map's origin. Row 0 is the lowest, as in ROS's OccupancyGrid; pictures
//       of a map have it at their bottom.
//
// Values. One thread at a time may change a map; what others read is const and shared.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/result.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::chart {

using sense::Pose2;

/// Per cent: 0 certainly free to 100 certainly occupied; kUnknown: not seen.
using Cell = std::int8_t;
inline constexpr Cell kUnknown = -1;
inline constexpr Cell kFree = 0;
inline constexpr Cell kOccupied = 100;

/// From this on a cell is taken for occupied, up to this for free: what lies between is doubtful.
inline constexpr Cell kSurelyOccupied = 65;
inline constexpr Cell kSurelyFree = 25;

/// 40 MB; 2 km x 50 m at 5 cm. What is larger is refused.
inline constexpr std::size_t kMostCells = 40'000'000;
inline constexpr double kFinest_m = 0.005;
inline constexpr double kCoarsest_m = 10.0;

struct CellAt {
  std::int32_t column = 0;
  std::int32_t row = 0;
  friend bool operator==(const CellAt&, const CellAt&) = default;
};

struct MapShape {
  std::int32_t columns = 0;
  std::int32_t rows = 0;
  double resolution_m = 0.05;  ///< edge of a cell
  Pose2 origin;                ///< X_MG
};

class OccupancyMap {
 public:
  /// Nothing at all: 0 x 0.
  OccupancyMap() = default;

  /// All cells alike. @return TooLarge above kMostCells; Invalid where there is no cell, the
  /// resolution lies outside of kFinest_m to kCoarsest_m, or the origin is not finite.
  static base::Result<OccupancyMap> make(const MapShape& shape, Cell fill = kUnknown);
  /// @param cells row after row from the lowest, columns x rows of them, each -1 to 100; else
  /// Invalid.
  static base::Result<OccupancyMap> make(const MapShape& shape, std::vector<Cell> cells);

  const MapShape& shape() const noexcept { return shape_; }
  std::int32_t columns() const noexcept { return shape_.columns; }
  std::int32_t rows() const noexcept { return shape_.rows; }
  double resolution_m() const noexcept { return shape_.resolution_m; }
  std::span<const Cell> cells() const noexcept { return cells_; }

  bool holds(CellAt c) const noexcept {
    return c.column >= 0 && c.row >= 0 && c.column < shape_.columns && c.row < shape_.rows;
  }
  /// Unknown outside of the map.
  Cell at(CellAt c) const noexcept { return holds(c) ? cells_[index(c)] : kUnknown; }
  /// @param value -1 to 100. Nothing outside of the map.
  void set(CellAt c, Cell value) noexcept {
    if (holds(c)) cells_[index(c)] = value;
  }
  /// The cell under a point of M; it may lie outside of the map. Empty: not finite, or further
  /// away than a cell can be counted.
  std::optional<CellAt> cell_of(double x_m, double y_m) const noexcept;
  /// Of a cell, in M; yaw as the grid's.
  Pose2 centre_of(CellAt c) const noexcept;

  /// X_GB of X_MB and back.
  Pose2 in_grid(const Pose2& in_map) const noexcept { return inverse(shape_.origin) * in_map; }
  Pose2 in_map(const Pose2& in_grid) const noexcept { return shape_.origin * in_grid; }

 private:
  std::size_t index(CellAt c) const noexcept {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(shape_.columns) +
           static_cast<std::size_t>(c.column);
  }

  MapShape shape_{};
  std::vector<Cell> cells_;
};

}  // namespace roverd::nav::chart
