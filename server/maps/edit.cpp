#include "maps/edit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace roverd::maps {

namespace {

using nav::chart::Cell;
using nav::chart::OccupancyMap;
using nav::chart::Pose2;

/// Calls visit(row, begin, end) for the cells [begin, end) of each row whose middles lie inside.
/// Where a border runs through a middle, its left and lower side are in: areas that touch share no
/// cell.
template <class Visit>
void inside(const OccupancyMap& map, const Area& area, Visit visit) {
  if (area.size() < 3 || map.rows() == 0) return;
  std::vector<Corner> grid;  // in cells of G, such that middles are whole numbers
  grid.reserve(area.size());
  double low = 1e300;
  double high = -1e300;
  for (const Corner& c : area) {
    const Pose2 p = map.in_grid({c.x_m, c.y_m, 0.0});
    grid.push_back({p.x_m / map.resolution_m() - 0.5, p.y_m / map.resolution_m() - 0.5});
    low = std::min(low, grid.back().y_m);
    high = std::max(high, grid.back().y_m);
  }
  const auto bounded = [](double value, std::int32_t end) {
    return static_cast<std::int32_t>(std::clamp(std::ceil(value), 0.0, static_cast<double>(end)));
  };
  std::vector<double> crossings;
  for (std::int32_t row = bounded(low, map.rows()); row < map.rows() && row <= high; ++row) {
    crossings.clear();
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const Corner& a = grid[i];
      const Corner& b = grid[(i + 1) % grid.size()];
      if ((a.y_m <= row) == (b.y_m <= row)) continue;
      crossings.push_back(a.x_m + (row - a.y_m) / (b.y_m - a.y_m) * (b.x_m - a.x_m));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const std::int32_t begin = bounded(crossings[i], map.columns());
      const std::int32_t end = bounded(crossings[i + 1], map.columns());
      if (begin < end) visit(row, begin, end);
    }
  }
}

}  // namespace

bool lies_outside(const nav::chart::MapShape& map, const Area& area) noexcept {
  const Pose2 to_grid = nav::sense::inverse(map.origin);
  double west = 1e300;
  double east = -1e300;
  double south = 1e300;
  double north = -1e300;
  for (const Corner& c : area) {
    const Pose2 p = to_grid * Pose2{c.x_m, c.y_m, 0.0};
    west = std::min(west, p.x_m);
    east = std::max(east, p.x_m);
    south = std::min(south, p.y_m);
    north = std::max(north, p.y_m);
  }
  return east <= 0.0 || north <= 0.0 || west >= map.columns * map.resolution_m ||
         south >= map.rows * map.resolution_m;
}

namespace {

void fill(OccupancyMap& map, const Area& area, Cell value) {
  inside(map, area, [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
    for (std::int32_t column = begin; column < end; ++column) map.set({column, row}, value);
  });
}

/// Later ones win in a square of many cells.
enum class Look : std::uint8_t { Free, Unknown, Forbidden, Occupied };

Look look_of(Cell cell) noexcept {
  if (cell >= nav::chart::kSurelyOccupied) return Look::Occupied;
  return cell >= 0 && cell <= nav::chart::kSurelyFree ? Look::Free : Look::Unknown;
}

std::uint16_t grey_of_look(Look s) noexcept {
  constexpr std::array<std::uint16_t, 4> kGrey = {kGreyFree, kGreyUnknown, kGreyForbidden,
                                                  kGreyOccupied};
  return kGrey[static_cast<std::size_t>(s)];
}

std::int32_t parts(std::int32_t whole, std::int32_t factor) noexcept {
  return (whole + factor - 1) / factor;
}

std::int32_t factor_for(const OccupancyMap& map, std::size_t most) noexcept {
  const auto cells = [&map](std::int32_t factor) {
    return static_cast<std::size_t>(parts(map.columns(), factor)) *
           static_cast<std::size_t>(parts(map.rows(), factor));
  };
  std::int32_t factor = 1;
  const double ratio = static_cast<double>(cells(1)) / static_cast<double>(most);
  // The smallest one is not less than the root: what is cut at the edges only adds cells.
  if (ratio > 1.0) factor = std::max(1, static_cast<std::int32_t>(std::sqrt(ratio)));
  while (cells(factor) > most && cells(factor) > 1) ++factor;
  return factor;
}

}  // namespace

void edit(OccupancyMap& map, const Edit& e) {
  switch (e.kind) {
    case Edit::Kind::Erase:
      return fill(map, e.area, nav::chart::kFree);
    case Edit::Kind::Wall:
      return fill(map, e.area, nav::chart::kOccupied);
    case Edit::Kind::Forbid:
      return;
  }
}

Thinned thinned(const OccupancyMap& map, const std::vector<Area>& forbidden, std::size_t most) {
  Thinned out;
  out.factor = factor_for(map, std::max<std::size_t>(most, 1));
  const std::int32_t columns = parts(map.columns(), out.factor);
  const std::int32_t rows = parts(map.rows(), out.factor);
  std::vector<Look> squares(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                            Look::Free);
  const auto mark = [&](std::int32_t row, std::int32_t column, Look what) {
    const std::int32_t at_row = row / out.factor;
    const std::int32_t at_column = column / out.factor;
    Look& square = squares[static_cast<std::size_t>(at_row) * static_cast<std::size_t>(columns) +
                           static_cast<std::size_t>(at_column)];
    square = std::max(square, what);
  };
  const auto cells = map.cells();
  std::size_t i = 0;
  for (std::int32_t row = 0; row < map.rows(); ++row) {
    for (std::int32_t column = 0; column < map.columns(); ++column) {
      mark(row, column, look_of(cells[i++]));
    }
  }
  for (const Area& area : forbidden) {
    inside(map, area, [&](std::int32_t row, std::int32_t begin, std::int32_t end) {
      for (std::int32_t c = begin; c < end; c += out.factor) mark(row, c, Look::Forbidden);
      mark(row, end - 1, Look::Forbidden);
    });
  }
  out.picture.columns = static_cast<std::uint32_t>(columns);
  out.picture.rows = static_cast<std::uint32_t>(rows);
  out.picture.values.reserve(squares.size());
  for (std::int32_t row = rows - 1; row >= 0; --row) {
    const auto begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
    for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c) {
      out.picture.values.push_back(grey_of_look(squares[begin + c]));
    }
  }
  return out;
}

atlas::MapWords words_for(const OccupancyMap& map) {
  atlas::MapWords words;
  words.resolution_m = map.resolution_m();
  words.origin = map.shape().origin;
  const bool plain = std::ranges::all_of(map.cells(), [](Cell c) {
    return c == nav::chart::kUnknown || c == nav::chart::kFree || c == nav::chart::kOccupied;
  });
  words.mode = plain ? atlas::MapMode::Trinary : atlas::MapMode::Raw;
  return words;
}

OccupancyMap with_forbidden(OccupancyMap map, const std::vector<Area>& forbidden) {
  for (const Area& area : forbidden) fill(map, area, nav::chart::kOccupied);
  return map;
}

}  // namespace roverd::maps
