// Cells become things that people can be told of, and fewer cells.
#include "nav/sense/clusters.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace roverd::nav::sense {
namespace {

const Footprint kBoxBody = Footprint::box(1.0, 0.8, 0.5);
constexpr Way kStanding{};

/// A free square of 10 m about the origin, in cells of 5 cm.
Patch clear_field() {
  Patch p;
  p.x0 = p.y0 = -100;
  p.side = 200;
  p.cells.assign(200u * 200u, {Known::Free, 0, 3});
  return p;
}

void put(Patch& p, double x0, double x1, double y0, double y1, Patch::Cell cell) {
  for (std::int32_t y = 0; y < p.side; ++y) {
    for (std::int32_t x = 0; x < p.side; ++x) {
      const double mx = (p.x0 + x + 0.5) * p.cell_m;
      const double my = (p.y0 + y + 0.5) * p.cell_m;
      if (mx < x0 || mx > x1 || my < y0 || my > y1) continue;
      p.cells[static_cast<std::size_t>(y) * 200u + static_cast<std::size_t>(x)] = cell;
    }
  }
}

TEST(ClustersTest, AnEmptyFieldHasNone) {
  EXPECT_TRUE(clusters_of(clear_field(), {}, kBoxBody, kStanding, 64).empty());
  EXPECT_TRUE(clusters_of(Patch{}, {}, kBoxBody, kStanding, 64).empty());
}

TEST(ClustersTest, ABoxAheadIsOneThingWithItsPlaceSizeAgeAndSensor) {
  Patch p = clear_field();
  put(p, 2.0, 2.3, -0.2, 0.2, {Known::Occupied, 1, 7});
  put(p, 2.0, 2.05, 0.0, 0.05, {Known::Occupied, 2, 2});  // its youngest cell
  const auto found = clusters_of(p, {}, kBoxBody, kStanding, 64);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].known, Known::Occupied);
  EXPECT_EQ(found[0].cells, 6u * 8u);
  EXPECT_NEAR(found[0].nearest.x, 2.025, 1e-9);
  EXPECT_NEAR(found[0].clearance_m, 1.525, 1e-9);  // the body ends 0.5 m ahead of its middle
  // From middle to middle of its outermost cells 0.25 m by 0.35 m, and one cell.
  EXPECT_LE(found[0].size_m, 0.4302 + 0.05);
  EXPECT_GE(found[0].size_m, 0.98 * 0.4301 + 0.05);
  EXPECT_EQ(found[0].age_ds, 2);
  EXPECT_FALSE(found[0].on_way) << "it stands";
}

TEST(ClustersTest, OneFreeCellBetweenTwoPostsIsNoGapAndTwoAreOne) {
  Patch p = clear_field();
  put(p, 1.00, 1.05, 0.0, 0.05, {Known::Occupied, 0, 0});
  put(p, 1.10, 1.15, 0.0, 0.05, {Known::Occupied, 0, 0});
  EXPECT_EQ(clusters_of(p, {}, kBoxBody, kStanding, 64).size(), 1u);
  put(p, 1.10, 1.15, 0.0, 0.05, {Known::Free, 0, 0});
  put(p, 1.15, 1.20, 0.0, 0.05, {Known::Occupied, 0, 0});
  EXPECT_EQ(clusters_of(p, {}, kBoxBody, kStanding, 64).size(), 2u);
}

TEST(ClustersTest, ADropAndWhatStandsAtItsEdgeAreTwoThings) {
  Patch p = clear_field();
  put(p, 1.0, 1.5, 0.0, 1.0, {Known::Drop, 0, 0});
  put(p, 1.5, 1.6, 0.0, 1.0, {Known::Occupied, 0, 0});
  const auto found = clusters_of(p, {}, kBoxBody, kStanding, 64);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].known, Known::Drop);
  EXPECT_EQ(found[1].known, Known::Occupied);
}

TEST(ClustersTest, TheNearestComeFirstAndNoMoreThanAsked) {
  Patch p = clear_field();
  for (const double x : {4.0, 1.0, -2.0, 3.0}) {
    put(p, x, x + 0.1, 0.0, 0.1, {Known::Occupied, 0, 0});
  }
  const auto found = clusters_of(p, {}, kBoxBody, kStanding, 2);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].nearest.x, 1.025, 1e-9);
  EXPECT_NEAR(found[1].nearest.x, -1.925, 1e-9);
}

TEST(ClustersTest, PlacesAreToldFromTheBodyAsItStands) {
  Patch p = clear_field();
  put(p, 0.0, 0.05, 3.0, 3.05, {Known::Occupied, 0, 0});
  // One metre up the y axis, looking along it: what lay at y 3 m is two metres ahead.
  const auto found = clusters_of(p, {0.0, 1.0, std::numbers::pi / 2.0}, kBoxBody, kStanding, 64);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].nearest.x, 2.025, 1e-9);
  EXPECT_NEAR(found[0].nearest.y, -0.025, 1e-9);
}

TEST(ClustersTest, OnTheWayIsWhatTheMovingBodyWouldCloselyPass) {
  Patch p = clear_field();
  put(p, 2.0, 2.1, 0.40, 0.44, {Known::Occupied, 0, 0});  // 0.425: 2.5 cm beside the body
  put(p, 2.0, 2.1, -0.66, -0.59, {Known::Occupied, 0, 0});
  const Way ahead{.twist = {0.5, 0.0}, .side_m = 0.08, .horizon_s = 6.0};
  const auto found = clusters_of(p, {}, kBoxBody, ahead, 64);
  ASSERT_EQ(found.size(), 2u);
  for (const Cluster& c : found) EXPECT_EQ(c.on_way, c.nearest.y > 0.0) << c.nearest.y;
  const Way back{.twist = {-0.5, 0.0}, .side_m = 0.08, .horizon_s = 6.0};
  for (const Cluster& c : clusters_of(p, {}, kBoxBody, back, 64)) EXPECT_FALSE(c.on_way);
  const Way soon{.twist = {0.5, 0.0}, .side_m = 0.08, .horizon_s = 2.0};  // 1 m only
  for (const Cluster& c : clusters_of(p, {}, kBoxBody, soon, 64)) EXPECT_FALSE(c.on_way);
}

TEST(ClustersTest, AFieldFullOfPostsIsBounded) {
  Patch p = clear_field();
  for (std::size_t y = 0; y < 200; y += 4) {
    for (std::size_t x = 0; x < 200; x += 4) p.cells[y * 200 + x].known = Known::Occupied;
  }
  EXPECT_EQ(clusters_of(p, {}, kBoxBody, kStanding, 64).size(), 64u);
  EXPECT_EQ(clusters_of(p, {}, kBoxBody, kStanding, 10'000).size(), 2500u);
}

Patch square(std::int32_t x0, std::int32_t side) {
  Patch p;
  p.x0 = x0;
  p.y0 = x0;
  p.side = side;
  p.cells.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), {Known::Free});
  return p;
}

TEST(CoarserTest, TheWorstOfABlockCounts) {
  Patch p = square(0, 4);
  p.cells[0].known = Known::Unknown;
  p.cells[3].known = Known::Drop;
  p.cells[6].known = Known::Unknown;  // in the block of the drop
  p.cells[12].known = Known::Drop;
  p.cells[13].known = Known::Occupied;
  const Patch half = coarser(p, 2);
  EXPECT_EQ(half.side, 2);
  EXPECT_DOUBLE_EQ(half.cell_m, 0.1);
  EXPECT_EQ(half.at(0, 0).known, Known::Unknown) << "blind is not free";
  EXPECT_EQ(half.at(1, 0).known, Known::Drop);
  EXPECT_EQ(half.at(0, 1).known, Known::Occupied);
  EXPECT_EQ(half.at(1, 1).known, Known::Free);
}

TEST(CoarserTest, ABlockIsTheSameWhereverThePatchBegins) {
  Patch p = square(-3, 8);  // cells −3 to 4: the whole blocks of two are −1, 0 and 1
  p.cells[4 * 8 + 4].known = Known::Occupied;  // cell (1, 1): block (0, 0)
  const Patch half = coarser(p, 2);
  EXPECT_EQ(half.x0, -1);
  EXPECT_EQ(half.side, 3);
  EXPECT_EQ(half.at(0, 0).known, Known::Occupied);
  EXPECT_EQ(half.at(-1, 0).known, Known::Free);
  EXPECT_EQ(coarser(p, 20).side, 0) << "smaller than one block";
}

TEST(CoarserTest, RunLengthsAreOneByteForUpTo64EqualCells) {
  Patch p = square(0, 4);
  p.cells[5].known = Known::Occupied;
  // Five free, one occupied, ten free: Free is 1, Occupied 2, in the two upper bits.
  EXPECT_EQ(run_lengths(p), (std::vector<std::uint8_t>{0x44, 0x80, 0x49}));
}

}  // namespace
}  // namespace roverd::nav::sense
