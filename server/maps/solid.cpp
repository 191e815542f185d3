#include "maps/solid.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>

#include "maps/files.hpp"
#include "nav/cells/lowest.hpp"
#include "nav/cells/map_file.hpp"

namespace roverd::maps {

namespace {

using SolidCell = nav::cells::Cell;
using nav::cells::CellMap;

constexpr std::array kPlaneCells_m{0.05, 0.1, 0.2};  // the finest that has room
constexpr double kMargin_m = 1.0;                    // around what was seen
constexpr double kPassedBelow_m = 2.0;

struct Extent {
  double x0 = std::numeric_limits<double>::infinity();
  double y0 = x0;
  double x1 = -x0;
  double y1 = -x0;
};

Extent extent_of(const CellMap& solid) {
  Extent e;
  for (const SolidCell& c : solid.cells()) {
    e = {std::min(e.x0, c.mean_m.x()), std::min(e.y0, c.mean_m.y()), std::max(e.x1, c.mean_m.x()),
         std::max(e.y1, c.mean_m.y())};
  }
  return {e.x0 - kMargin_m, e.y0 - kMargin_m, e.x1 + kMargin_m, e.y1 + kMargin_m};
}

std::optional<nav::chart::MapShape> shape_for(const Extent& e) {
  for (const double cell_m : kPlaneCells_m) {
    const double columns = std::ceil((e.x1 - e.x0) / cell_m);
    const double rows = std::ceil((e.y1 - e.y0) / cell_m);
    if (!(columns * rows <= static_cast<double>(nav::chart::kMostCells))) continue;
    return nav::chart::MapShape{static_cast<std::int32_t>(columns),
                                static_cast<std::int32_t>(rows),
                                cell_m,
                                {e.x0, e.y0, 0.0}};
  }
  return std::nullopt;
}

/// As long as its points lie along it: else a wall would be a row of dots.
void draw_wall(const SolidCell& c, nav::chart::OccupancyMap& map) {
  const Eigen::Matrix2d spread = nav::cells::covariance_m2(c).topLeftCorner<2, 2>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  const double half_m = std::sqrt(3.0 * std::max(0.0, axes.eigenvalues()(1)));  // if evenly
  const Eigen::Vector2d along = axes.eigenvectors().col(1);
  const double step_m = 0.5 * map.resolution_m();
  const auto steps = static_cast<int>(half_m / step_m);
  for (int i = -steps; i <= steps; ++i) {
    const Eigen::Vector2d p = c.mean_m.head<2>() + i * step_m * along;
    if (const auto at = map.cell_of(p.x(), p.y())) map.set(*at, nav::chart::kOccupied);
  }
}

/// The whole of its cell, and what is left between it and the next one.
void draw_ground(const SolidCell& c, double cell_m, nav::chart::OccupancyMap& map) {
  const auto from = map.cell_of(c.mean_m.x() - 0.75 * cell_m, c.mean_m.y() - 0.75 * cell_m);
  const auto to = map.cell_of(c.mean_m.x() + 0.75 * cell_m, c.mean_m.y() + 0.75 * cell_m);
  if (!from || !to) return;
  for (std::int32_t y = from->row; y <= to->row; ++y) {
    for (std::int32_t x = from->column; x <= to->column; ++x) {
      if (map.at({x, y}) == nav::chart::kUnknown) map.set({x, y}, nav::chart::kFree);
    }
  }
}

}  // namespace

bool is_solid(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".pcd";
}

base::Result<CellMap> read_solid(const std::filesystem::path& file) {
  const auto bytes = file_bytes(file, kLargestSolid);
  if (!bytes) return tl::unexpected<base::Error>(bytes.error());
  auto map = nav::cells::read_map(*bytes, kSolidCell_m);
  if (map) return map;
  base::Error error = map.error();
  error.detail = file.string() + ": " + error.detail;
  return tl::unexpected<base::Error>(std::move(error));
}

base::Result<nav::chart::OccupancyMap> plane_of(const CellMap& solid) {
  if (solid.cells().empty()) return base::fail(base::Code::Invalid, "there is nothing in it");
  const Extent e = extent_of(solid);
  const auto shape = shape_for(e);
  if (!shape) {
    return base::fail(base::Code::TooLarge,
                      "it is wider than a map may be: one stray point will do");
  }
  auto map = nav::chart::OccupancyMap::make(*shape);
  if (!map) return map;
  nav::cells::Lowest lowest;
  for (const SolidCell& c : solid.cells()) lowest.put(c.mean_m);
  for (const SolidCell& c : solid.cells()) {
    const double over_m = lowest.over_m(c.mean_m);
    if (over_m > kPassedBelow_m) continue;
    if (over_m >= nav::cells::Lowest::kStands_m) {
      draw_wall(c, *map);
    } else {
      draw_ground(c, solid.cell_m(), *map);
    }
  }
  return map;
}

}  // namespace roverd::maps
