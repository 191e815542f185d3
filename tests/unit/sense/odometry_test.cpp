// Where the body was at any moment of the last seconds.
#include "nav/sense/odometry.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "scene.hpp"

namespace roverd::nav::sense {
namespace {

TEST(OdometryTest, APoseTimesItsInverseIsNothing) {
  const Pose2 p{1.5, -2.0, 2.5};
  const Pose2 none = p * inverse(p);
  EXPECT_NEAR(none.x_m, 0.0, 1e-12);
  EXPECT_NEAR(none.y_m, 0.0, 1e-12);
  EXPECT_NEAR(none.yaw_rad, 0.0, 1e-12);
}

TEST(OdometryTest, AnArcIsTheSumOfManySmallSteps) {
  Pose2 sum;
  for (int i = 0; i < 100'000; ++i) sum = sum * along(0.8, -0.6, 2e-5);
  const Pose2 arc = along(0.8, -0.6, 2.0);
  EXPECT_NEAR(arc.x_m, sum.x_m, 1e-6);
  EXPECT_NEAR(arc.y_m, sum.y_m, 1e-6);
  EXPECT_NEAR(arc.yaw_rad, -1.2, 1e-9);
}

TEST(OdometryTest, BetweenTwoStatesItIsInProportionAcrossTheHalfTurn) {
  PoseHistory h;
  h.push({at(1.0), {0.0, 0.0, 3.1}, 1.0, 0.0});
  h.push({at(1.1), {0.2, 0.4, -3.1}, 1.0, 0.0});
  const auto half = h.at(at(1.05));
  ASSERT_TRUE(half.has_value());
  EXPECT_NEAR(half->x_m, 0.1, 1e-9);
  EXPECT_NEAR(half->y_m, 0.2, 1e-9);
  EXPECT_NEAR(std::abs(half->yaw_rad), base::kPi, 1e-9);
}

TEST(OdometryTest, ItKnowsNothingBeforeItsOldestAndLongAfterItsNewest) {
  PoseHistory h;
  EXPECT_FALSE(h.at(at(0.0)).has_value());
  for (int i = 0; i < 1000; ++i) h.push({at(0.02 * i), {0.02 * i, 0.0, 0.0}, 1.0, 0.0});
  EXPECT_FALSE(h.at(at(14.0)).has_value()) << "256 states are 5.1 s";
  ASSERT_TRUE(h.at(at(15.013)).has_value());
  EXPECT_NEAR(h.at(at(15.013))->x_m, 15.013, 1e-9);
  EXPECT_NEAR(h.at(at(20.08))->x_m, 20.08, 1e-9) << "0.1 s further by its speed";
  EXPECT_FALSE(h.at(at(20.3)).has_value());
}

TEST(OdometryTest, ItKnowsHowTheBodyLayAndStaysWithTheNewestBeyondIt) {
  PoseHistory h;
  EXPECT_EQ(h.lie_at(at(1.0)).z_m, 0.0);
  h.push({at(1.0), {}, 0.0, 0.0, {0.1, 0.0, 0.2}});
  h.push({at(1.1), {}, 0.0, 0.0, {0.2, -0.1, 0.0}});
  EXPECT_NEAR(h.lie_at(at(1.05)).z_m, 0.15, 1e-9);
  EXPECT_NEAR(h.lie_at(at(1.05)).roll_rad, -0.05, 1e-9);
  EXPECT_NEAR(h.lie_at(at(1.05)).pitch_rad, 0.1, 1e-9);
  EXPECT_EQ(h.lie_at(at(5.0)).z_m, 0.2);
  EXPECT_EQ(h.lie_at(at(0.5)).pitch_rad, 0.2);
}

TEST(OdometryTest, WhatGoesBackInTimeOrIsNoNumberIsRefused) {
  PoseHistory h;
  EXPECT_TRUE(h.push({at(1.0), {}, 0.0, 0.0}));
  EXPECT_FALSE(h.push({at(1.0), {}, 0.0, 0.0}));
  EXPECT_FALSE(h.push({at(0.5), {}, 0.0, 0.0}));
  EXPECT_FALSE(h.push({at(2.0), {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, 0.0, 0.0}));
  EXPECT_EQ(h.newest().stamp, at(1.0));
}

}  // namespace
}  // namespace roverd::nav::sense
