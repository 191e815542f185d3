// Closed loop: scanner, chain, finder, drive and a slipping robot between simulated rows.

#include <gtest/gtest.h>

#include "field.hpp"

namespace roverd::nav::rows::tests {
namespace {

constexpr double kEndWithin_m = 0.5;

void expect_driven(const DriveTold& t, double end_m) {
  EXPECT_TRUE(t.done) << t.reason;
  EXPECT_LT(t.rms_m, 0.04);
  EXPECT_LT(t.worst_m, 0.15) << "at " << t.worst_at_m;
  EXPECT_EQ(t.touched, 0U);
  EXPECT_NEAR(t.stopped_m, end_m, kEndWithin_m);
}

//   ▓▓ ▓▓▓    ▓▓▓▓ ▓  ▓▓▓      gaps up to 2 m, leaves ±15 cm, weeds at the sides
//  ─▶─────────────────────|
//   ▓▓▓▓  ▓▓▓▓     ▓▓ ▓▓▓▓
TEST(RowDriving, StaysInTheMiddleToTheEndAndKnowsHowWell) {
  const Block block({.bends = {{30.0, 0.0}}, .seed = 3});
  const DriveTold t = drive_row(block, {});
  expect_driven(t, block.end_m());
  // What it says of itself holds: (error/sigma)² is about one.
  EXPECT_LT(t.nees, 2.5);
  EXPECT_GT(t.nees, 0.2);
}

// From before the first plants on: of a line that is made of those ahead it tells no offset.
TEST(RowDriving, TellsAnOffsetOnlyWhereItKnowsOne) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Block block({.bends = {{10.0, 0.0}}, .seed = seed});
    DriveSetup setup;
    setup.start_s_m = -2.0;
    setup.start_turned_rad = seed % 2 == 0 ? 0.05 : -0.05;
    setup.seed = seed;
    const DriveTold t = drive_row(block, setup);
    EXPECT_TRUE(t.done) << t.reason;
    EXPECT_LT(t.told_wrong_m, 0.12) << seed << " at " << t.told_wrong_at_m;
    EXPECT_GT(t.told_part, 0.9) << seed;
  }
}

TEST(RowDriving, TellsAnOffsetByRaysToo) {
  const Block block({.bends = {{16.0, 0.0}}, .seed = 3});
  DriveSetup setup;
  setup.order.seeing = Seeing::Rays;
  const DriveTold t = drive_row(block, setup);
  EXPECT_TRUE(t.done) << t.reason;
  EXPECT_GT(t.told_part, 0.9);
}

TEST(RowDriving, FollowsBendsOf15Metres) {
  const Block block({.bends = {{8.0, 0.0}, {12.0, 1.0 / 15.0}, {12.0, -1.0 / 15.0}}, .seed = 2});
  const DriveTold t = drive_row(block, {});
  expect_driven(t, block.end_m());
}

TEST(RowDriving, GoesOnWhereOneSideIsMissingForAWhile) {
  const Block block({.bends = {{26.0, 0.0}}, .no_left = {{10.0, 16.0}}, .seed = 5});
  const DriveTold t = drive_row(block, {});
  EXPECT_TRUE(t.done) << t.reason;
  EXPECT_LT(t.worst_m, 0.15) << "at " << t.worst_at_m;
  EXPECT_NEAR(t.stopped_m, block.end_m(), kEndWithin_m);
}

//   ▓▓▓ ▓▓▓▓▓▓▓▓▓
//  ────────────────▶|   straight out of it, though one side tells of its end alone
//   ▓▓▓▓▓▓▓▓
TEST(RowDriving, LeavesARowStraight) {
  double square = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    for (const double ragged_m : {0.0, 0.8, 1.5}) {
      const Block block({.bends = {{9.0, 0.0}}, .ragged_m = ragged_m, .seed = seed});
      DriveSetup setup;
      setup.seed = seed;
      const DriveTold t = drive_row(block, setup);
      const double turned_deg = base::deg_from_rad(t.end_turned_rad);
      EXPECT_TRUE(t.done) << t.reason;
      EXPECT_LT(std::abs(turned_deg), 4.0) << seed << " " << ragged_m;
      EXPECT_LT(std::abs(t.swerved_m), 0.13) << seed << " " << ragged_m;
      square += turned_deg * turned_deg;
      ++n;
    }
  }
  EXPECT_LT(std::sqrt(square / n), 2.0) << "degrees";
}

// A row that bends to its end is left along its bend. One that begins to bend just before its end
// is not known so well.
TEST(RowDriving, LeavesABentRowAlongItsBend) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const double bent_m : {4.0, 12.0}) {
      const double bend_1pm = seed % 2 == 0 ? 1.0 / 15.0 : -1.0 / 15.0;
      const Block block({.bends = {{9.0, 0.0}, {bent_m, bend_1pm}}, .seed = seed});
      DriveSetup setup;
      setup.seed = seed;
      const DriveTold t = drive_row(block, setup);
      const double turned_deg = std::abs(base::deg_from_rad(t.end_turned_rad));
      EXPECT_TRUE(t.done) << t.reason;
      EXPECT_LT(turned_deg, bent_m > 10.0 ? 3.5 : 8.0) << seed;
      EXPECT_LT(std::abs(t.swerved_m), bent_m > 10.0 ? 0.12 : 0.20) << seed;
    }
  }
}

// Of a short row that bends all along not much is known before its end is in sight.
TEST(RowDriving, LeavesAShortBentRowAlongItsBend) {
  double worst_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const double long_m : {4.0, 5.0, 6.0}) {
      const Block block(
          {.bends = {{long_m, seed % 2 == 0 ? 1.0 / 15.0 : -1.0 / 15.0}}, .seed = seed});
      DriveSetup setup;
      setup.seed = seed;
      const DriveTold t = drive_row(block, setup);
      EXPECT_TRUE(t.done) << t.reason;
      worst_m = std::max({worst_m, t.worst_m, std::abs(t.end_off_m)});
    }
  }
  EXPECT_LT(worst_m, 0.175);
}

// The left row ends 3 m later: the lane ends with it.
TEST(RowDriving, EndsWithTheSideThatIsLonger) {
  const Block block({.bends = {{18.0, 0.0}}, .gaps = 0.2, .ragged_m = 3.0, .seed = 6});
  const DriveTold t = drive_row(block, {});
  EXPECT_TRUE(t.done) << t.reason;
  EXPECT_NEAR(t.stopped_m, block.left_end_m(), kEndWithin_m);
}

TEST(RowDriving, FollowsOneSideAtItsDistance) {
  const Block block({.bends = {{25.0, 0.0}}, .weeds_per_m = 0.0, .seed = 4});
  DriveSetup setup;
  setup.order.sides = Sides::Left;
  setup.order.gap_m = 1.25 - 0.16;  // to the leaves, so that it is in the middle as well
  const DriveTold t = drive_row(block, setup);
  EXPECT_TRUE(t.done) << t.reason;
  EXPECT_LT(t.worst_m, 0.20);
  EXPECT_NEAR(t.stopped_m, block.left_end_m(), kEndWithin_m);
}

// All directions unknown is no end of the row: it stops and says why.
TEST(RowDriving, StopsWhereItIsDazzled) {
  const Block block({.bends = {{25.0, 0.0}}, .seed = 7});
  DriveSetup setup;
  setup.blind_from_s = 15.0;
  const DriveTold t = drive_row(block, setup);
  EXPECT_FALSE(t.done);
  EXPECT_EQ(t.reason, "the row is lost");
  EXPECT_LT(t.stopped_m, 10.0);
  EXPECT_LT(t.time_s, 25.0);
}

TEST(RowDriving, SaysWhereThereIsNoRow) {
  const Block block({.bends = {{25.0, 0.0}}, .seed = 8});
  DriveSetup setup;
  setup.start_s_m = 29.0;  // behind its end
  const DriveTold t = drive_row(block, setup);
  EXPECT_FALSE(t.done);
  EXPECT_EQ(t.reason, "no row is seen within 3.0 m");
  EXPECT_NEAR(t.driven_m, 3.0, 0.15);
}

}  // namespace
}  // namespace roverd::nav::rows::tests
