// Areas over cells, and what is shown of a map that is too large to be shown whole.

#include "maps/edit.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace roverd;
using maps::Area;
using maps::Edit;
using nav::chart::kFree;
using nav::chart::kOccupied;
using nav::chart::kUnknown;
using nav::chart::MapShape;
using nav::chart::OccupancyMap;

/// Row by row from the top: '.' free, '#' occupied, '?' unknown.
std::string drawn(const OccupancyMap& map) {
  std::string out;
  for (std::int32_t row = map.rows() - 1; row >= 0; --row) {
    for (std::int32_t column = 0; column < map.columns(); ++column) {
      const auto cell = map.at({column, row});
      out += cell == kFree ? '.' : cell == kOccupied ? '#' : '?';
    }
    out += '\n';
  }
  return out;
}

OccupancyMap unknown_map(std::int32_t columns, std::int32_t rows, nav::chart::Pose2 origin = {}) {
  return *OccupancyMap::make(MapShape{columns, rows, 1.0, origin});
}

TEST(MapEdit, ActsOnTheCellsWhoseMiddleLiesInside) {
  // Cells of 1 m: middles at 0.5, 1.5 … A triangle with its right angle below.
  OccupancyMap map = unknown_map(5, 4);
  maps::edit(map, {Edit::Kind::Wall, {{0.9, 0.9}, {4.2, 0.9}, {0.9, 4.2}}});
  EXPECT_EQ(drawn(map),
            "?#???\n"
            "?##??\n"
            "?###?\n"
            "?????\n");
  maps::edit(map, {Edit::Kind::Erase, {{1, 1}, {2, 1}, {2, 2}, {1, 2}}});
  EXPECT_EQ(map.at({1, 1}), kFree);
  EXPECT_EQ(map.at({2, 1}), kOccupied);
}

TEST(MapEdit, HoldsToTheFrameOfATurnedMap) {
  // The grid is turned left by a quarter about (10, 20): its columns run north.
  OccupancyMap map = unknown_map(3, 2, {10.0, 20.0, 1.5707963267948966});
  maps::edit(map, {Edit::Kind::Wall, {{8.9, 21.9}, {10.1, 21.9}, {10.1, 23.1}, {8.9, 23.1}}});
  EXPECT_EQ(drawn(map),
            "???\n"
            "??#\n");
}

TEST(MapEdit, OfAreasThatTouchTakesEachCellOnce) {
  // The border runs through middles; both halves together are all cells, and share none.
  OccupancyMap left = unknown_map(4, 4);
  OccupancyMap right = unknown_map(4, 4);
  maps::edit(left, {Edit::Kind::Wall, {{-1, -1}, {1.5, -1}, {1.5, 9}, {-1, 9}}});
  maps::edit(right, {Edit::Kind::Wall, {{1.5, -1}, {9, -1}, {9, 9}, {1.5, 9}}});
  for (std::int32_t row = 0; row < 4; ++row) {
    for (std::int32_t column = 0; column < 4; ++column) {
      EXPECT_NE(left.at({column, row}) == kOccupied, right.at({column, row}) == kOccupied);
    }
  }
}

TEST(MapEdit, OfNothingOrFarAwayChangesNothing) {
  OccupancyMap map = unknown_map(3, 3);
  const std::string before = drawn(map);
  maps::edit(map, {Edit::Kind::Wall, {}});
  maps::edit(map, {Edit::Kind::Wall, {{0, 0}, {3, 3}}});
  maps::edit(map, {Edit::Kind::Wall, {{0, 0}, {3, 3}, {0, 0}}});  // a line
  maps::edit(map, {Edit::Kind::Wall, {{2e6, 0}, {1e6, 5}, {2e6, 9}}});
  maps::edit(map,
             {Edit::Kind::Forbid, {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}});  // nothing stands there
  EXPECT_EQ(drawn(map), before);
}

TEST(MapShown, IsThinnedFromTheLowerLeftCornerAndTheWorstOfASquareShows) {
  //   5 x 3 cells in squares of 2: the last column and the top row are cut.
  //   top row    . . . . #
  //              . . ? . .
  //   row 0      # . . . .
  OccupancyMap map = *OccupancyMap::make(MapShape{5, 3, 1.0, {}}, kFree);
  map.set({0, 0}, kOccupied);
  map.set({2, 1}, kUnknown);
  map.set({4, 2}, kOccupied);
  const auto thin = maps::thinned(map, {}, 6);
  EXPECT_EQ(thin.factor, 2);
  EXPECT_EQ(thin.picture.columns, 3u);
  EXPECT_EQ(thin.picture.rows, 2u);
  EXPECT_EQ(thin.picture.values, (std::vector<std::uint16_t>{254, 254, 0, 0, 205, 254}));
}

TEST(MapShown, WhatIsForbiddenShowsButHidesNoWall) {
  OccupancyMap map = *OccupancyMap::make(MapShape{4, 1, 1.0, {}}, kFree);
  map.set({1, 0}, kOccupied);
  map.set({2, 0}, kUnknown);
  map.set({3, 0}, 50);  // doubtful
  const Area left{{0, 0}, {3, 0}, {3, 1}, {0, 1}};
  const auto whole = maps::thinned(map, {left}, 100);
  EXPECT_EQ(whole.factor, 1);
  EXPECT_EQ(whole.picture.values, (std::vector<std::uint16_t>{100, 0, 100, 205}));
  EXPECT_EQ(maps::thinned(map, {left}, 1).picture.values, (std::vector<std::uint16_t>{0}));
}

TEST(MapShown, HasAtMostAsManyCellsAsAskedFor) {
  for (const auto& [columns, rows] : {std::pair{7, 7}, {1, 1000}, {999, 3}, {64, 64}}) {
    const OccupancyMap map = *OccupancyMap::make(MapShape{columns, rows, 1.0, {}}, kFree);
    for (const std::size_t most : {std::size_t{1}, std::size_t{5}, std::size_t{48}}) {
      const auto thin = maps::thinned(map, {}, most);
      EXPECT_LE(thin.picture.values.size(), most);
      EXPECT_EQ(thin.picture.values.size(), std::size_t{thin.picture.columns} * thin.picture.rows);
      if (thin.factor == 1) continue;  // and no fewer than needed
      const auto parts = [f = thin.factor - 1](int whole) { return (whole + f - 1) / f; };
      EXPECT_GT(static_cast<std::size_t>(parts(columns)) * static_cast<std::size_t>(parts(rows)),
                most);
    }
  }
}

}  // namespace
