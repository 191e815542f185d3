#include "nav/mapping/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include "nav/chart/cell.hpp"

namespace roverd::nav::mapping {

namespace {

constexpr std::int32_t kReach = 5;  // cells that one point blurs to each side: 3 deviations

std::array<std::uint8_t, (2 * kReach + 1) * (2 * kReach + 1)> blurred() {
  std::array<std::uint8_t, (2 * kReach + 1) * (2 * kReach + 1)> out{};
  std::size_t i = 0;
  for (std::int32_t y = -kReach; y <= kReach; ++y) {
    for (std::int32_t x = -kReach; x <= kReach; ++x) {
      const double square_m2 = double(x * x + y * y) * Field::kCell_m * Field::kCell_m;
      const double value = std::exp(-square_m2 / (2.0 * Field::kBlur_m * Field::kBlur_m));
      out[i++] = static_cast<std::uint8_t>(std::lround(255.0 * value));
    }
  }
  return out;
}

std::int32_t down(std::int32_t value, std::int32_t by) noexcept {
  return value >= 0 ? value / by : -((by - 1 - value) / by);
}

}  // namespace

Points thinned(std::span<const Eigen::Vector2f> points, double edge_m) {
  Points out;
  std::unordered_set<std::uint64_t> taken;
  for (const auto& p : points) {
    constexpr float kFar_m = 1e5F;
    if (!(std::abs(p.x()) < kFar_m && std::abs(p.y()) < kFar_m)) continue;
    const auto cell = [&](float v) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(double{v} / edge_m)));
    };
    if (taken.insert(std::uint64_t{cell(p.x())} << 32U | cell(p.y())).second) out.push_back(p);
  }
  return out;
}

Field::Field(std::span<const Eigen::Vector2f> points) {
  if (points.empty()) return;
  Eigen::Vector2f low = points.front();
  Eigen::Vector2f high = low;
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d middle = 0.5 * (low + high).cast<double>();
  const Eigen::Vector2d size =
      ((high - low).cast<double>() + Eigen::Vector2d::Constant(2.0 * (kReach + 1) * kCell_m))
          .cwiseMin(kMost_m);
  corner_m_ = middle - 0.5 * size;
  columns_ = static_cast<std::int32_t>(std::ceil(size.x() / kCell_m));
  rows_ = static_cast<std::int32_t>(std::ceil(size.y() / kCell_m));
  cells_.assign(std::size_t(columns_) * std::size_t(rows_), 0);
  static const auto kernel = blurred();
  for (const auto& p : points) {
    const Eigen::Vector2d c = cell_of(p.cast<double>());
    const std::int32_t column = chart::whole_cell(c.x());
    const std::int32_t row = chart::whole_cell(c.y());
    if (column < kReach || row < kReach || column + kReach >= columns_ || row + kReach >= rows_) {
      continue;
    }
    std::size_t k = 0;
    for (std::int32_t y = row - kReach; y <= row + kReach; ++y) {
      std::uint8_t* line = &cells_[std::size_t(y) * std::size_t(columns_)];
      for (std::int32_t x = column - kReach; x <= column + kReach; ++x, ++k) {
        line[x] = std::max(line[x], kernel[k]);
      }
    }
  }
  block_columns_ = columns_ / kBlock + 2;  // one before, for places that reach in from outside
  block_rows_ = rows_ / kBlock + 2;
  blocks_.assign(std::size_t(block_columns_) * std::size_t(block_rows_), 0);
  for (std::int32_t y = 0; y < rows_; ++y) {
    for (std::int32_t x = 0; x < columns_; ++x) {
      const std::uint8_t value = at(x, y);
      if (value == 0) continue;
      // Of the blocks from which a step of less than one block leads here.
      for (const std::int32_t by : {y / kBlock, y / kBlock + 1}) {
        for (const std::int32_t bx : {x / kBlock, x / kBlock + 1}) {
          auto& b = blocks_[std::size_t(by) * std::size_t(block_columns_) + std::size_t(bx)];
          b = std::max(b, value);
        }
      }
    }
  }
}

std::uint8_t Field::bound(std::int32_t column, std::int32_t row) const noexcept {
  const std::int32_t x = down(column, kBlock) + 1;
  const std::int32_t y = down(row, kBlock) + 1;
  if (x < 0 || y < 0 || x >= block_columns_ || y >= block_rows_) return 0;
  return blocks_[std::size_t(y) * std::size_t(block_columns_) + std::size_t(x)];
}

double Field::sample(const Eigen::Vector2d& p_m, Eigen::Vector2d& slope_1pm) const noexcept {
  slope_1pm.setZero();
  const Eigen::Vector2d c = cell_of(p_m) - Eigen::Vector2d::Constant(0.5);
  if (!(c.x() > 0.0 && c.y() > 0.0 && c.x() < columns_ - 1 && c.y() < rows_ - 1)) return 0.0;
  const auto column = static_cast<std::int32_t>(c.x());
  const auto row = static_cast<std::int32_t>(c.y());
  const double fx = c.x() - column;
  const double fy = c.y() - row;
  const double a = at(column, row);
  const double b = at(column + 1, row);
  const double d = at(column, row + 1);
  const double e = at(column + 1, row + 1);
  constexpr double kUnit = 1.0 / 255.0;
  slope_1pm =
      Eigen::Vector2d((b - a) * (1.0 - fy) + (e - d) * fy, (d - a) * (1.0 - fx) + (e - b) * fx) *
      (kUnit / kCell_m);
  return ((a * (1.0 - fx) + b * fx) * (1.0 - fy) + (d * (1.0 - fx) + e * fx) * fy) * kUnit;
}

}  // namespace roverd::nav::mapping
