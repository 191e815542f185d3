// The body from above.
#include "nav/sense/footprint.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace roverd::nav::sense {
namespace {

//        y          1.0 x 0.8, origin in the middle
//   ┌────┼────┐
//   │    └──▶ │ x
//   └─────────┘
TEST(FootprintTest, DistancesOfABoxAreThoseOfItsSidesAndCorners) {
  const Footprint box = Footprint::box(1.0, 0.8, 0.5);
  EXPECT_NEAR(box.distance_m({0.9, 0.0}), 0.4, 1e-12);
  EXPECT_NEAR(box.distance_m({0.0, -1.0}), 0.6, 1e-12);
  EXPECT_NEAR(box.distance_m({0.8, 0.8}), 0.5, 1e-12) << "3, 4, 5 from the corner";
  EXPECT_NEAR(box.distance_m({0.0, 0.0}), -0.4, 1e-12);
  EXPECT_NEAR(box.reach_m(), std::hypot(0.5, 0.4), 1e-12);
}

TEST(FootprintTest, ASteeredVehicleStandsAheadOfItsRearAxle) {
  const Footprint car = Footprint::box(2.0, 1.0, 0.4);
  EXPECT_NEAR(car.distance_m({1.7, 0.0}), 0.1, 1e-12);
  EXPECT_NEAR(car.distance_m({-0.5, 0.0}), 0.1, 1e-12);
}

TEST(FootprintTest, CornersInAnyOrderBecomeTheirHull) {
  const std::vector<Vec2> corners{{1, 1}, {-1, -1}, {0, 0}, {1, -1}, {-1, 1}, {0, 1}, {0.2, -0.3}};
  const auto hull = Footprint::of(corners);
  ASSERT_TRUE(hull.has_value());
  EXPECT_EQ(hull->corners().size(), 4U);
  double area = 0.0;
  const auto c = hull->corners();
  for (std::size_t i = 0; i < 4; ++i) area += 0.5 * cross(c[i], c[(i + 1) % 4]);
  EXPECT_NEAR(area, 4.0, 1e-12) << "counter-clockwise: positive";
}

TEST(FootprintTest, WhatIsNoAreaIsRefused) {
  EXPECT_FALSE(Footprint::of({}).has_value());
  EXPECT_FALSE(Footprint::of(std::vector<Vec2>{{0, 0}, {1, 1}, {2, 2}}).has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = Footprint::of(std::vector<Vec2>{{0, 0}, {1, 0}, {nan, 1}});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().fields.at(0).pointer, "/2");
  std::vector<Vec2> round;
  for (int i = 0; i < 40; ++i) round.push_back({std::cos(i * 0.157), std::sin(i * 0.157)});
  EXPECT_FALSE(Footprint::of(round).has_value());
}

}  // namespace
}  // namespace roverd::nav::sense
