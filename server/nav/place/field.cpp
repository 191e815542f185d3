#include "nav/place/field.hpp"

#include <algorithm>
#include <limits>

namespace roverd::nav::place {

namespace {

using chart::CellAt;
using chart::OccupancyMap;

constexpr std::size_t kMostSquares = 4'000'000;

bool occupied_cell(chart::Cell c) noexcept {
  return c >= chart::kSurelyOccupied;
}

/// One row of the exact transform: the lower envelope of parabolas over the columns, as deep as
/// the nearest occupied cell of each column lies away.
class Envelope {
 public:
  explicit Envelope(std::size_t columns) : at_(columns), from_(columns + 1), depth_(columns) {}

  void begin() noexcept { size_ = 0; }

  /// @param depth squared distance within the column. Columns in rising order.
  void add(std::int32_t column, double depth) noexcept {
    double from = -std::numeric_limits<double>::infinity();
    while (size_ > 0) {
      const double c = at_[size_ - 1];
      const double meets =
          ((depth + double(column) * column) - (depth_[size_ - 1] + c * c)) / (2.0 * (column - c));
      if (meets > from_[size_ - 1]) {
        from = meets;
        break;
      }
      --size_;
    }
    at_[size_] = column;
    depth_[size_] = depth;
    from_[size_] = from;
    ++size_;
    cursor_ = 0;
  }

  bool empty() const noexcept { return size_ == 0; }

  /// The column whose occupied cell is nearest. Columns in rising order.
  std::int32_t nearest(std::int32_t column) noexcept {
    while (cursor_ + 1 < size_ && from_[cursor_ + 1] < column) ++cursor_;
    return at_[cursor_];
  }

 private:
  std::vector<std::int32_t> at_;
  std::vector<double> from_;
  std::vector<double> depth_;
  std::size_t size_ = 0;
  std::size_t cursor_ = 0;
};

/// The line through weighted points, as a wall.
struct Spread {
  double weight = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;

  void add(double px, double py, double w) noexcept {
    weight += w;
    x += w * px;
    y += w * py;
    xx += w * px * px;
    xy += w * px * py;
    yy += w * py * py;
  }
};

/// @param cell_m edge of a cell: what is no longer than that across both ways is a pole.
Wall wall_of(const Spread& s, double x_m, double y_m, double cell_m) noexcept {
  const double mx = s.x / s.weight;
  const double my = s.y / s.weight;
  const double own = cell_m * cell_m / 12.0;
  const double cxx = s.xx / s.weight - mx * mx + own;
  const double cxy = s.xy / s.weight - mx * my;
  const double cyy = s.yy / s.weight - my * my + own;
  const double half = 0.5 * (cxx + cyy);
  const double root = std::hypot(0.5 * (cxx - cyy), cxy);
  const double across = std::max(half - root, own);
  const double along = std::max(half + root, own);
  const double angle = 0.5 * std::atan2(2.0 * cxy, cxx - cyy);  // of the wall
  const double nx = -std::sin(angle);
  const double ny = std::cos(angle);
  // A round heap of cells counts all around, a line across only.
  const double round = std::clamp((across / along - 0.25) / 0.5, 0.0, 1.0);
  Wall w;
  w.x_m = static_cast<float>(x_m + mx);
  w.y_m = static_cast<float>(y_m + my);
  w.xx = static_cast<float>(nx * nx + round * ny * ny);
  w.xy = static_cast<float>((1.0 - round) * nx * ny);
  w.yy = static_cast<float>(ny * ny + round * nx * nx);
  return w;
}

}  // namespace

Field::Field(const OccupancyMap& map, const FieldParams& params)
    : shape_(map.shape()),
      columns_(map.columns()),
      rows_(map.rows()),
      resolution_m_(map.resolution_m()) {
  const int reach = std::clamp(static_cast<int>(params.reach_m / resolution_m_), 1, 100);
  reach_m_ = reach * resolution_m_;
  ground_.resize(map.cells().size());
  std::transform(map.cells().begin(), map.cells().end(), ground_.begin(), [](chart::Cell c) {
    if (occupied_cell(c)) return Ground::Occupied;
    return c >= 0 && c <= chart::kSurelyFree ? Ground::Free : Ground::Unknown;
  });
  transform(map, reach);
  lay_walls(map, std::clamp(static_cast<int>(std::lround(params.wall_m / resolution_m_)), 1, 8));
  lay_levels(params.sigma_m);
}

void Field::transform(const OccupancyMap& map, int reach) {
  nearest_.assign(map.cells().size(), Offset{});
  const auto columns = static_cast<std::size_t>(columns_);
  // Along the columns first: rows to the nearest occupied cell, from below and from above.
  std::vector<std::int16_t> since(columns);
  const auto far = static_cast<std::int16_t>(reach + 1);
  const auto sweep = [&](std::int32_t row, int sign) {
    for (std::int32_t column = 0; column < columns_; ++column) {
      auto& count = since[static_cast<std::size_t>(column)];
      const bool here = ground_[index(column, row)] == Ground::Occupied;
      count = here ? std::int16_t{0} : std::min(static_cast<std::int16_t>(count + 1), far);
      Offset& o = nearest_[index(column, row)];
      const bool nearer = o.columns == kNone || count < std::abs(o.rows);
      if (count < far && nearer) o = {0, static_cast<std::int8_t>(sign * count)};
    }
  };
  std::fill(since.begin(), since.end(), far);
  for (std::int32_t row = 0; row < rows_; ++row) sweep(row, -1);
  std::fill(since.begin(), since.end(), far);
  for (std::int32_t row = rows_ - 1; row >= 0; --row) sweep(row, 1);
  // Then along the rows.
  Envelope envelope(columns);
  std::vector<Offset> vertical(columns);
  for (std::int32_t row = 0; row < rows_; ++row) {
    envelope.begin();
    for (std::int32_t column = 0; column < columns_; ++column) {
      const Offset o = nearest_[index(column, row)];
      vertical[static_cast<std::size_t>(column)] = o;
      if (o.columns != kNone) envelope.add(column, double(o.rows) * o.rows);
    }
    if (envelope.empty()) continue;
    for (std::int32_t column = 0; column < columns_; ++column) {
      const std::int32_t by = envelope.nearest(column);
      const std::int32_t dc = by - column;
      const std::int32_t dr = vertical[static_cast<std::size_t>(by)].rows;
      const bool within = dc * dc + dr * dr <= reach * reach;
      nearest_[index(column, row)] =
          within ? Offset{static_cast<std::int8_t>(dc), static_cast<std::int8_t>(dr)} : Offset{};
    }
  }
}

void Field::lay_walls(const OccupancyMap& map, int radius) {
  row_begin_.assign(static_cast<std::size_t>(rows_) + 1, 0);
  for (std::int32_t row = 0; row < rows_; ++row) {
    row_begin_[static_cast<std::size_t>(row)] = static_cast<std::uint32_t>(walls_.size());
    for (std::int32_t column = 0; column < columns_; ++column) {
      if (ground_[index(column, row)] != Ground::Occupied) continue;
      Spread spread;
      for (int dr = -radius; dr <= radius; ++dr) {
        for (int dc = -radius; dc <= radius; ++dc) {
          const int d2 = dr * dr + dc * dc;
          if (d2 > radius * radius || !occupied_cell(map.at({column + dc, row + dr}))) continue;
          spread.add(dc * resolution_m_, dr * resolution_m_, 1.0 - d2 / (radius * radius + 1.0));
        }
      }
      walls_.push_back(wall_of(spread, (column + 0.5) * resolution_m_, (row + 0.5) * resolution_m_,
                               resolution_m_));
      wall_column_.push_back(column);
    }
  }
  row_begin_.back() = static_cast<std::uint32_t>(walls_.size());
}

void Field::lay_levels(double sigma_m) {
  std::int32_t step = 1;
  while (static_cast<std::size_t>(columns_ / step + 1) *
             static_cast<std::size_t>(rows_ / step + 1) >
         kMostSquares) {
    ++step;
  }
  square_m_ = step * resolution_m_;
  square_columns_ = (columns_ + step - 1) / step;
  square_rows_ = (rows_ + step - 1) / step;
  stored_columns_ = square_columns_ + kMargin;
  stored_rows_ = square_rows_ + kMargin;
  const auto stride = static_cast<std::size_t>(stored_columns_);
  levels_[0].assign(stride * static_cast<std::size_t>(stored_rows_), 0);
  const double scale = resolution_m_ * resolution_m_ / (2.0 * sigma_m * sigma_m);
  for (std::int32_t row = 0; row < rows_; ++row) {
    for (std::int32_t column = 0; column < columns_; ++column) {
      const Offset o = nearest_[index(column, row)];
      if (o.columns == kNone) continue;
      const double d2 = double(o.columns) * o.columns + double(o.rows) * o.rows;
      const auto fit = static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-d2 * scale)));
      auto& stored = levels_[0][static_cast<std::size_t>(row / step + kMargin) * stride +
                                static_cast<std::size_t>(column / step + kMargin)];
      stored = std::max(stored, fit);
    }
  }
  for (int level = 1; level < kLevels; ++level) {
    const auto& below = levels_[static_cast<std::size_t>(level - 1)];
    auto& out = levels_[static_cast<std::size_t>(level)];
    out.assign(below.size(), 0);
    const std::int32_t half = 1 << (level - 1);
    for (std::int32_t row = 0; row < stored_rows_; ++row) {
      const std::int32_t up = std::min(row + half, stored_rows_ - 1);
      const std::uint8_t* lower = &below[static_cast<std::size_t>(row) * stride];
      const std::uint8_t* upper = &below[static_cast<std::size_t>(up) * stride];
      std::uint8_t* to = &out[static_cast<std::size_t>(row) * stride];
      for (std::int32_t column = 0; column < stored_columns_; ++column) {
        const std::int32_t right = std::min(column + half, stored_columns_ - 1);
        to[column] =
            std::max(std::max(lower[column], lower[right]), std::max(upper[column], upper[right]));
      }
    }
  }
}

bool Field::cell(double x_m, double y_m, std::int32_t& column, std::int32_t& row) const noexcept {
  const double c = x_m / resolution_m_;
  const double r = y_m / resolution_m_;
  if (!(c >= 0.0 && r >= 0.0 && c < columns_ && r < rows_)) return false;
  column = static_cast<std::int32_t>(c);
  row = static_cast<std::int32_t>(r);
  return true;
}

const Wall* Field::wall(double x_m, double y_m) const noexcept {
  std::int32_t column = 0;
  std::int32_t row = 0;
  if (!cell(x_m, y_m, column, row)) return nullptr;
  const Offset o = nearest_[index(column, row)];
  if (o.columns == kNone) return nullptr;
  const auto at = static_cast<std::size_t>(row + o.rows);
  const auto begin = wall_column_.begin() + row_begin_[at];
  const auto end = wall_column_.begin() + row_begin_[at + 1];
  const auto found = std::lower_bound(begin, end, column + o.columns);
  return &walls_[static_cast<std::size_t>(found - wall_column_.begin())];
}

double Field::distance_m(double x_m, double y_m) const noexcept {
  std::int32_t column = 0;
  std::int32_t row = 0;
  if (!cell(x_m, y_m, column, row)) return reach_m_;
  const Offset o = nearest_[index(column, row)];
  if (o.columns == kNone) return reach_m_;
  return resolution_m_ * std::hypot(double(o.columns), double(o.rows));
}

Field::Ground Field::ground(double x_m, double y_m) const noexcept {
  std::int32_t column = 0;
  std::int32_t row = 0;
  return cell(x_m, y_m, column, row) ? ground_[index(column, row)] : Ground::Unknown;
}

}  // namespace roverd::nav::place
