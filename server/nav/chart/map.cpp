#include "nav/chart/map.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace roverd::nav::chart {

namespace {

base::Result<std::size_t> cells_of(const MapShape& shape) {
  if (shape.columns <= 0 || shape.rows <= 0) {
    return base::fail(base::Code::Invalid, "a map has at least one cell",
                      {{"/size", "must be at least 1 x 1"}});
  }
  if (!(shape.resolution_m >= kFinest_m && shape.resolution_m <= kCoarsest_m)) {
    return base::fail(base::Code::Invalid, "the resolution must be 0.005 to 10 m",
                      {{"/resolution", "must be 0.005 to 10 m"}});
  }
  const Pose2& o = shape.origin;
  if (!std::isfinite(o.x_m) || !std::isfinite(o.y_m) || !std::isfinite(o.yaw_rad)) {
    return base::fail(base::Code::Invalid, "the origin must be finite numbers",
                      {{"/origin", "must be finite numbers"}});
  }
  const std::size_t count =
      static_cast<std::size_t>(shape.columns) * static_cast<std::size_t>(shape.rows);
  if (count > kMostCells) {
    return base::fail(base::Code::TooLarge,
                      std::to_string(shape.columns) + " x " + std::to_string(shape.rows) +
                          " cells are more than the " + std::to_string(kMostCells) +
                          " that a map may have",
                      {{"/size", "must be at most " + std::to_string(kMostCells) + " cells"}});
  }
  return count;
}

}  // namespace

base::Result<OccupancyMap> OccupancyMap::make(const MapShape& shape, Cell fill) {
  const auto count = cells_of(shape);
  if (!count) return tl::unexpected<base::Error>(count.error());
  OccupancyMap map;
  map.shape_ = shape;
  map.cells_.assign(*count, fill);
  return map;
}

base::Result<OccupancyMap> OccupancyMap::make(const MapShape& shape, std::vector<Cell> cells) {
  const auto count = cells_of(shape);
  if (!count) return tl::unexpected<base::Error>(count.error());
  if (cells.size() != *count) {
    return base::fail(
        base::Code::Invalid,
        std::to_string(cells.size()) + " cells where the map has " + std::to_string(*count),
        {{"/cells", "must be as many as columns times rows"}});
  }
  const bool in_range = std::all_of(cells.begin(), cells.end(),
                                    [](Cell c) { return c >= kUnknown && c <= kOccupied; });
  if (!in_range) {
    return base::fail(base::Code::Invalid, "a cell is -1 (unknown) or 0 to 100",
                      {{"/cells", "must be -1 to 100"}});
  }
  OccupancyMap map;
  map.shape_ = shape;
  map.cells_ = std::move(cells);
  return map;
}

std::optional<CellAt> OccupancyMap::cell_of(double x_m, double y_m) const noexcept {
  if (cells_.empty()) return std::nullopt;
  const Pose2 p = in_grid({x_m, y_m, 0.0});
  const double column = std::floor(p.x_m / shape_.resolution_m);
  const double row = std::floor(p.y_m / shape_.resolution_m);
  constexpr double kFar = 1e9;
  if (!(std::abs(column) < kFar && std::abs(row) < kFar)) return std::nullopt;
  return CellAt{static_cast<std::int32_t>(column), static_cast<std::int32_t>(row)};
}

Pose2 OccupancyMap::centre_of(CellAt c) const noexcept {
  return in_map({(c.column + 0.5) * shape_.resolution_m, (c.row + 0.5) * shape_.resolution_m, 0.0});
}

}  // namespace roverd::nav::chart
