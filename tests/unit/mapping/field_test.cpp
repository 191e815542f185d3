// Points on a grid, and scans laid into it.

#include "nav/mapping/field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "rooms.hpp"

namespace roverd::nav::mapping {
namespace {

Points hits(const chart::Scan& scan) {
  Points out;
  for (const auto& b : scan.beams) {
    if (b.hit) out.push_back({b.x_m, b.y_m});
  }
  return out;
}

TEST(Field, IsLikeliestAtAPointAndFallsOffAsItsBlurSays) {
  const Points points = {{1.0F, 2.0F}, {-3.0F, 0.5F}};
  const Field field(points);
  Eigen::Vector2d slope;
  EXPECT_GT(field.sample({1.0, 2.0}, slope), 0.8);  // within half a cell of it
  EXPECT_NEAR(field.sample({1.0 + 0.12, 2.0}, slope), std::exp(-0.5 * 1.5 * 1.5), 0.15);
  EXPECT_LT(slope.x(), -2.0);
  EXPECT_EQ(field.sample({1.5, 2.0}, slope), 0.0);
  EXPECT_EQ(field.sample({1e9, 2.0}, slope), 0.0);
  EXPECT_EQ(Field(Points{}).at(0, 0), 0);
}

TEST(Field, ABoundIsNeverBelowWhatItBounds) {
  std::mt19937 random(1);
  const Field field(hits(look(block_of_rooms(), {0, 0, 0.3}, random)));
  std::uniform_int_distribution<std::int32_t> any(-40, 560);
  for (int i = 0; i < 20'000; ++i) {
    const std::int32_t column = any(random);
    const std::int32_t row = any(random);
    std::uint8_t most = 0;
    for (std::int32_t k = 0; k < Field::kBlock * Field::kBlock; ++k) {
      most = std::max(most, field.at(column + k % Field::kBlock, row + k / Field::kBlock));
    }
    ASSERT_GE(field.bound(column, row), most) << column << " " << row;
  }
}

TEST(Search, FindsTheScanWhereItWasTaken) {
  std::mt19937 random(2);
  const Plan plan = block_of_rooms();
  const Pose2 map_pose{1.0, 0.3, 0.1};
  const Field field(hits(look(plan, map_pose, random)));
  for (int i = 0; i < 10; ++i) {
    const Pose2 truth{0.7 + 0.05 * i, 0.2 + 0.02 * i, 0.1 - 0.03 * i};
    const Points points = thinned(hits(look(plan, truth, random)), 0.05);
    Pose2 guess = inverse(map_pose) * truth;
    guess.x_m += 0.6 - 0.1 * i;
    guess.y_m -= 0.5 - 0.08 * i;
    guess.yaw_rad += 0.25 - 0.05 * i;
    const Fit fit = search(field, points, guess, {1.0, 0.4});
    const Pose2 wrong = inverse(inverse(map_pose) * truth) * fit.pose;
    EXPECT_LT(std::hypot(wrong.x_m, wrong.y_m), 0.07) << i;
    EXPECT_LT(std::abs(wrong.yaw_rad), 0.01) << i;
    EXPECT_GT(fit.score, 0.6);
    EXPECT_LT(fit.covariance(0, 0), 0.05 * 0.05);
  }
}

TEST(Search, AlongAnEndlessCorridorOnlyTheGuessHolds) {
  // Given two walls of which no end is seen,
  Points walls;
  for (int i = -400; i <= 400; ++i) {
    walls.push_back({0.05F * static_cast<float>(i), 1.0F});
    walls.push_back({0.05F * static_cast<float>(i), -1.0F});
  }
  Points seen;
  for (const auto& p : walls) {
    if (std::abs(p.x()) < 6.0F) seen.push_back(p);
  }
  const Fit fit = search(Field(walls), seen, {0.2, 0.3, 0.1}, {0.5, 0.2, 0.1, 0.05});
  // then across and the heading are found, and along is where it was said, as surely as it was.
  EXPECT_LT(std::abs(fit.pose.y_m), 0.03);
  EXPECT_LT(std::abs(fit.pose.yaw_rad), 0.01);
  EXPECT_NEAR(fit.pose.x_m, 0.2, 0.1);
  EXPECT_GT(fit.covariance(0, 0), 0.05 * 0.05);
  EXPECT_LT(fit.covariance(1, 1), 0.02 * 0.02);
}

TEST(Search, OfAGuessTooFarForAnyCellIsTheGuess) {
  const Points points = {{1.0F, 2.0F}, {-3.0F, 0.5F}};
  for (const double far_m : {1e9, -1e9, 1e300}) {
    EXPECT_EQ(search(Field(points), points, {far_m, 2.0, 0.1}, {}).pose.x_m, far_m);
    EXPECT_EQ(search(Field(points), points, {far_m, 2.0, 0.1}, {}).score, 0.0);
  }
}

TEST(Field, OfPointsAtBothEndsOfTheWorldHoldsNeither) {
  const Field field(Points{{-1e12F, 0.0F}, {1e12F, 0.0F}});
  Eigen::Vector2d slope;
  EXPECT_EQ(field.sample({0.0, 0.0}, slope), 0.0);
  EXPECT_EQ(field.sample({1e12, 0.0}, slope), 0.0);
}

TEST(Search, OfNothingIsTheGuess) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const Field empty(Points{});
  const Points one = {{1.0F, 1.0F}};
  EXPECT_EQ(search(empty, one, {1, 2, 3}, {0.2, 0.1}).score, 0.0);
  EXPECT_EQ(search(Field(one), Points{}, {1, 2, 3}, {0.2, 0.1}).pose.x_m, 1.0);
  EXPECT_TRUE(thinned(Points{{kNone, 0.0F}, {1e30F, 0.0F}}, 0.05).empty());
}

}  // namespace
}  // namespace roverd::nav::mapping
