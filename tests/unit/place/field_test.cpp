// The likelihood field against the slow way of computing it; searching and matching in it.

#include "nav/place/field.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "nav/place/match.hpp"
#include "nav/place/search.hpp"
#include "unit/place/shed.hpp"

namespace {

using namespace roverd;
using nav::chart::OccupancyMap;
using nav::place::Field;
using nav::sense::Pose2;

OccupancyMap speckled(std::uint32_t seed) {
  std::mt19937 random(seed);
  auto map = OccupancyMap::make({70, 50, 0.05, {}}, nav::chart::kFree);
  std::uniform_int_distribution<std::int32_t> column(0, 69);
  std::uniform_int_distribution<std::int32_t> row(0, 49);
  for (int i = 0; i < 12; ++i) map->set({column(random), row(random)}, nav::chart::kOccupied);
  return std::move(*map);
}

TEST(Field, DistancesAreThoseOfTryingEveryOccupiedCell) {
  const OccupancyMap map = speckled(7);
  const Field field(map);
  for (std::int32_t row = 0; row < map.rows(); ++row) {
    for (std::int32_t column = 0; column < map.columns(); ++column) {
      double nearest = field.reach_m() + 0.001;
      for (std::int32_t r = 0; r < map.rows(); ++r) {
        for (std::int32_t c = 0; c < map.columns(); ++c) {
          if (map.at({c, r}) != nav::chart::kOccupied) continue;
          nearest = std::min(nearest, 0.05 * std::hypot(c - column, r - row));
        }
      }
      const auto centre = map.centre_of({column, row});
      ASSERT_NEAR(field.distance_m(centre.x_m, centre.y_m), std::min(nearest, field.reach_m()),
                  1e-9)
          << column << " " << row;
      if (std::abs(nearest - field.reach_m()) < 1e-9) continue;  // just within, or none
      ASSERT_EQ(field.wall(centre.x_m, centre.y_m) == nullptr, nearest > field.reach_m());
    }
  }
  EXPECT_EQ(field.distance_m(-0.1, 0.0), field.reach_m()) << "outside nothing is near";
  EXPECT_EQ(field.distance_m(std::nan(""), 0.0), field.reach_m());
}

TEST(Field, LevelsHoldTheBestOfTheirSquares) {
  const Field field(speckled(8));
  for (const int level : {1, 3, 5}) {
    for (std::int32_t row = -9; row < 50; row += 7) {
      for (std::int32_t column = -9; column < 70; column += 7) {
        std::uint8_t best = 0;
        for (std::int32_t r = row; r < row + (1 << level); ++r) {
          for (std::int32_t c = column; c < column + (1 << level); ++c) {
            best = std::max(best, field.fit(0, c, r));
          }
        }
        ASSERT_EQ(field.fit(level, column, row), best);
      }
    }
  }
}

TEST(Field, AWallCountsAcrossItAndNotAlong) {
  const auto field = tests::field_of({{0, 0, 6, 0}}, 6.0, 1.0);
  const nav::place::Wall* wall = field->wall(1.0 + 3.0, 1.0 + 0.2);
  ASSERT_NE(wall, nullptr);
  EXPECT_NEAR(wall->xx, 0.0F, 0.01F);
  EXPECT_NEAR(wall->yy, 1.0F, 0.01F);
  EXPECT_NEAR(wall->y_m, 1.025F, 1e-3F) << "the middle of its cells";
}

TEST(Search, AroundAPlaceTooFarForAnyCellNothingFits) {
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  const std::vector<nav::place::Point> few(8);
  for (const double far_m : {1e12, -1e12}) {
    EXPECT_EQ(nav::place::search_window(*field, few, {far_m, 2.0, 0.1}).fit, 0.0);
  }
}

TEST(Search, FindsWhatTryingEveryPlaceFinds) {
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  tests::Scanner scanner(3);
  const Pose2 truth{5.0, 3.0, 0.4};
  const auto few = nav::place::spread_hits(scanner.look(tests::shed(), truth, 1.0), 0.2, 40);
  const Pose2 middle{5.0 + 1.0 + 0.3, 3.0 + 1.0 - 0.2, 0.4 + 0.15};
  nav::place::WindowParams p;
  p.edge_cost = 0.0;
  const auto found = nav::place::search_window(*field, few, middle, p);
  double best = 0.0;
  for (int turn = -21; turn <= 21; ++turn) {
    for (int column = -9; column <= 9; ++column) {
      for (int row = -9; row <= 9; ++row) {
        const Pose2 at{middle.x_m + 0.05 * column, middle.y_m + 0.05 * row,
                       middle.yaw_rad + 0.02 * turn};
        double sum = 0.0;
        for (const auto& point : few) {
          // Moves are by whole cells of where the hits lie in the middle.
          const Pose2 hit =
              Pose2{middle.x_m, middle.y_m, at.yaw_rad} * Pose2{point.x_m, point.y_m, 0.0};
          sum += field->fit(0, static_cast<int>(std::floor(hit.x_m / 0.05)) + column,
                            static_cast<int>(std::floor(hit.y_m / 0.05)) + row);
        }
        best = std::max(best, sum / (255.0 * static_cast<double>(few.size())));
      }
    }
  }
  EXPECT_NEAR(found.fit, best, 1e-6);
  EXPECT_NEAR(found.pose.x_m, truth.x_m + 1.0, 0.08);
  EXPECT_NEAR(found.pose.y_m, truth.y_m + 1.0, 0.08);
}

TEST(Match, IsFinerThanTheCells) {
  const auto field = tests::field_of(tests::shed(), 12.0, 8.0);
  tests::Scanner scanner(4);
  for (const Pose2& truth : {Pose2{5.0, 3.0, 0.4}, Pose2{3.37, 6.12, -2.0}, Pose2{9.5, 6.0, 3.0}}) {
    const auto scan = scanner.look(tests::shed(), truth, 1.0);
    const Pose2 in_grid{truth.x_m + 1.0, truth.y_m + 1.0, truth.yaw_rad};
    const Pose2 start{in_grid.x_m + 0.12, in_grid.y_m - 0.1, in_grid.yaw_rad + 0.06};
    const auto match = nav::place::refine(*field, nav::place::hits_of(scan, 720), start, {});
    // Walls are drawn into the cells to the right of and above them: half a cell.
    EXPECT_NEAR(match.pose.x_m, in_grid.x_m + 0.025, 0.03);
    EXPECT_NEAR(match.pose.y_m, in_grid.y_m + 0.025, 0.03);
    EXPECT_NEAR(match.pose.yaw_rad, in_grid.yaw_rad, 0.006);
    EXPECT_TRUE(match.settled);
    EXPECT_LT(std::sqrt(match.covariance(0, 0)), 0.05);
    EXPECT_GT(nav::place::agreement(*field, scan, match.pose).explained, 0.95);
  }
}

TEST(Match, IsUncertainAlongACorridor) {
  // 60 m long: the ends lie out of sight.
  const std::vector<tests::Segment> walls = {{0, 0, 60, 0}, {0, 2, 60, 2}};
  const auto field = tests::field_of(walls, 60.0, 2.0);
  tests::Scanner scanner(5);
  const auto scan = scanner.look(walls, {30.0, 0.9, 0.0}, 1.0);
  const auto match =
      nav::place::refine(*field, nav::place::hits_of(scan, 720), {31.0, 1.95, 0.02}, {});
  EXPECT_GT(std::sqrt(match.covariance(0, 0)), 0.5) << "along";
  EXPECT_LT(std::sqrt(match.covariance(1, 1)), 0.04) << "across";
  EXPECT_LT(std::sqrt(match.covariance(2, 2)), 0.02);
}

}  // namespace
