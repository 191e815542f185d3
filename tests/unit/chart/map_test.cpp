// Cells of the plane: where they lie, what is refused.

#include "nav/chart/map.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace {

using namespace roverd;
using nav::chart::Cell;
using nav::chart::CellAt;
using nav::chart::MapShape;
using nav::chart::OccupancyMap;

//   y ^            origin (10, 20), 0.5 m cells, 4 columns, 3 rows
//     | . . . .    (11.9, 21.4) is the last cell, (10, 20) the lower left corner of the first
//     | . . . .
//     | . . . .  > x
TEST(Map, CellsLieFromTheLowerLeftCornerUpwards) {
  auto map = OccupancyMap::make({4, 3, 0.5, {10.0, 20.0, 0.0}});
  ASSERT_TRUE(map);
  EXPECT_EQ(map->cell_of(10.0, 20.0), (CellAt{0, 0}));
  EXPECT_EQ(map->cell_of(11.9, 21.4), (CellAt{3, 2}));
  EXPECT_EQ(map->cell_of(9.99, 20.0), (CellAt{-1, 0}));
  EXPECT_DOUBLE_EQ(map->centre_of({3, 2}).x_m, 11.75);
  EXPECT_DOUBLE_EQ(map->centre_of({3, 2}).y_m, 21.25);
  map->set({3, 2}, nav::chart::kOccupied);
  EXPECT_EQ(map->cells()[11], 100) << "row after row from the lowest";
  EXPECT_EQ(map->at({4, 2}), nav::chart::kUnknown) << "outside nothing is known";
  map->set({-1, 0}, nav::chart::kOccupied);  // nothing happens
}

// The grid may stand askew on the map: a quarter turn lays its rows along the map's y.
TEST(Map, ATurnedGridIsFoundWhereItLies) {
  auto map = OccupancyMap::make({10, 10, 1.0, {0.0, 0.0, base::rad_from_deg(90.0)}});
  ASSERT_TRUE(map);
  EXPECT_EQ(map->cell_of(-0.5, 3.5), (CellAt{3, 0}));
  const auto centre = map->centre_of({3, 0});
  EXPECT_NEAR(centre.x_m, -0.5, 1e-12);
  EXPECT_NEAR(centre.y_m, 3.5, 1e-12);
}

TEST(Map, WhatCannotBeAMapIsRefusedByName) {
  const auto huge = OccupancyMap::make({10'000, 10'000, 0.05, {}});
  ASSERT_FALSE(huge);
  EXPECT_EQ(huge.error().code, base::Code::TooLarge);
  EXPECT_NE(huge.error().detail.find("10000 x 10000"), std::string::npos);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(OccupancyMap::make({4, 4, nan, {}}).error().fields.at(0).pointer, "/resolution");
  EXPECT_EQ(OccupancyMap::make({4, 4, 0.05, {nan, 0.0, 0.0}}).error().fields.at(0).pointer,
            "/origin");
  EXPECT_EQ(OccupancyMap::make({0, 4, 0.05, {}}).error().fields.at(0).pointer, "/size");
  EXPECT_EQ(
      OccupancyMap::make({2, 2, 0.05, {}}, std::vector<Cell>(5, 0)).error().fields.at(0).pointer,
      "/cells");
  EXPECT_FALSE(OccupancyMap::make({2, 2, 0.05, {}}, std::vector<Cell>(4, 101)));
  EXPECT_FALSE(OccupancyMap{}.cell_of(0.0, 0.0));
}

TEST(Map, FarAndForeignPointsHaveNoCell) {
  auto map = OccupancyMap::make({4, 3, 0.5, {}});
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->cell_of(1e300, 0.0));
  EXPECT_FALSE(map->cell_of(std::numeric_limits<double>::quiet_NaN(), 0.0));
  EXPECT_FALSE(map->cell_of(0.0, -std::numeric_limits<double>::infinity()));
}

}  // namespace
