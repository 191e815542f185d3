#pragma once
// How well a point fits a map: the likelihood field of an occupancy map, and what is needed to
// search in it fast and to measure in it finely.
//
//   distance    of every cell to the nearest occupied one, exact, cut at the reach
//   fit         255 exp(-d^2 / 2 sigma^2), and its greatest value over squares of 2^h cells: an
//               upper bound for every place in such a square (levels 0 to kLevels - 1)
//   walls       for each occupied cell the line through the occupied cells around it: where
//               within the cells the wall stands, and which way it looks
//
// Sources: Thrun, Burgard, Fox, Probabilistic Robotics, 6.4 (likelihood fields); Felzenszwalb and
// Huttenlocher 2012 (distance transform); Hess et al., ICRA 2016 (levels of greatest values).
//
// Frame G, the map's grid (nav/chart/map.hpp); metres. Immutable once made: read by any thread.
// Holds at most about 11 bytes a cell.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "nav/chart/map.hpp"

namespace roverd::nav::place {

using sense::Pose2;

struct FieldParams {
  double reach_m = 0.50;  ///< further from every wall nothing is said; at most 100 cells
  double sigma_m = 0.10;  ///< of the fit
  double wall_m = 0.11;   ///< cells as far as this make a wall's line
};

/// The map's surface near an occupied cell.
struct Wall {
  float x_m = 0.0F;  ///< a point of it, in G
  float y_m = 0.0F;
  float xx = 0.0F;  ///< how much a metre off counts, by direction: 1 across a wall, 0 along it,
  float xy = 0.0F;  ///< 1 all around for what is no wall (a pole, a corner)
  float yy = 0.0F;
};

class Field {
 public:
  static constexpr int kLevels = 8;

  explicit Field(const chart::OccupancyMap& map, const FieldParams& params = {});

  double resolution_m() const noexcept { return resolution_m_; }
  double width_m() const noexcept { return columns_ * resolution_m_; }
  double height_m() const noexcept { return rows_ * resolution_m_; }
  double reach_m() const noexcept { return reach_m_; }
  std::size_t occupied() const noexcept { return walls_.size(); }
  const chart::MapShape& shape() const noexcept { return shape_; }

  /// The wall nearest to a point; null: none within reach, or outside of the map.
  const Wall* wall(double x_m, double y_m) const noexcept;
  /// To the middle of the nearest occupied cell, from the middle of the point's; reach_m() if none.
  double distance_m(double x_m, double y_m) const noexcept;
  /// What the map says of the point's cell; unknown outside.
  enum class Ground : std::uint8_t { Unknown, Free, Occupied };
  Ground ground(double x_m, double y_m) const noexcept;

  /// Squares of the search: edge of one at level 0, a multiple of the map's cell where the map is
  /// very large.
  double square_m() const noexcept { return square_m_; }
  std::int32_t square_columns() const noexcept { return square_columns_; }
  std::int32_t square_rows() const noexcept { return square_rows_; }
  /// The greatest fit over the squares [column, column + 2^level) x [row, row + 2^level). Any
  /// indices.
  std::uint8_t fit(int level, std::int32_t column, std::int32_t row) const noexcept {
    const std::int32_t c = column + kMargin;
    const std::int32_t r = row + kMargin;
    if (c < 0 || r < 0 || c >= stored_columns_ || r >= stored_rows_) return 0;
    return levels_[static_cast<std::size_t>(level)]
                  [static_cast<std::size_t>(r) * static_cast<std::size_t>(stored_columns_) +
                   static_cast<std::size_t>(c)];
  }

 private:
  static constexpr std::int32_t kMargin = 1 << (kLevels - 1);

  struct Offset {  ///< to the nearest occupied cell, in cells
    std::int8_t columns = kNone;
    std::int8_t rows = 0;
  };
  static constexpr std::int8_t kNone = 127;

  void transform(const chart::OccupancyMap& map, int reach);
  void lay_walls(const chart::OccupancyMap& map, int radius);
  void lay_levels(double sigma_m);
  std::size_t index(std::int32_t column, std::int32_t row) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  bool cell(double x_m, double y_m, std::int32_t& column, std::int32_t& row) const noexcept;

  chart::MapShape shape_;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  double resolution_m_ = 0.05;
  double reach_m_ = 0.5;
  std::vector<Offset> nearest_;
  std::vector<Ground> ground_;
  std::vector<Wall> walls_;                ///< row after row
  std::vector<std::int32_t> wall_column_;  ///< of each wall
  std::vector<std::uint32_t> row_begin_;   ///< in walls_; rows_ + 1 of them
  double square_m_ = 0.05;
  std::int32_t square_columns_ = 0;
  std::int32_t square_rows_ = 0;
  std::int32_t stored_columns_ = 0;
  std::int32_t stored_rows_ = 0;
  std::array<std::vector<std::uint8_t>, kLevels> levels_;
};

}  // namespace roverd::nav::place
