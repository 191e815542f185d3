// Where the robot would stop: straight, out of a turn, backwards.

#include "robot/safety/fence_guard.hpp"

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

constexpr double kEast = 0.0;
constexpr double kNorth = base::kPi / 2.0;

/// 1 m/s: 0.4 m until it reacts, 1 m of braking.
constexpr FenceParams kParams{0.1, 0.4, 0.5};
constexpr double kWay_m = 1.4;

base::Pose pose(double yaw_rad) {
  base::Pose p;
  p.at = {10.0, 20.0};
  p.yaw_rad = yaw_rad;
  return p;
}

void expect_at(base::EnuPoint at, double east_m, double north_m) {
  EXPECT_NEAR(at.east_m, 10.0 + east_m, 1e-9);
  EXPECT_NEAR(at.north_m, 20.0 + north_m, 1e-9);
}

TEST(StoppingPlace, IsWhereItIsWhenItStandsOrTurnsOnTheSpot) {
  expect_at(stopping_place(pose(kEast), {0.0, 0.0}, 1.0, kParams), 0.0, 0.0);
  expect_at(stopping_place(pose(kEast), {0.0, 1.0}, 1.0, kParams), 0.0, 0.0);
}

TEST(StoppingPlace, StraightAheadIsTheWayOfReactionAndOfBraking) {
  expect_at(stopping_place(pose(kEast), {1.0, 0.0}, 1.0, kParams), kWay_m, 0.0);
  expect_at(stopping_place(pose(kNorth), {1.0, 0.0}, 1.0, kParams), 0.0, kWay_m);
  expect_at(stopping_place(pose(kEast), {1.0, 0.0}, 0.5, kParams), kWay_m / 2.0, 0.0);
}

TEST(StoppingPlace, GrowsWithTheSquareOfTheSpeed) {
  expect_at(stopping_place(pose(kEast), {2.0, 0.0}, 1.0, kParams), 0.8 + 4.0, 0.0);
}

TEST(StoppingPlace, BackwardsLiesBehind) {
  expect_at(stopping_place(pose(kEast), {-1.0, 0.0}, 1.0, kParams), -kWay_m, 0.0);
}

TEST(StoppingPlace, OutOfATurnItLiesOnTheArc) {
  const double radius_m = 2.0;  // 1 m/s and 0.5 rad/s
  const double angle = kWay_m / radius_m;
  const double ahead_m = radius_m * std::sin(angle);
  const double aside_m = radius_m * (1.0 - std::cos(angle));
  expect_at(stopping_place(pose(kEast), {1.0, 0.5}, 1.0, kParams), ahead_m, aside_m);
  expect_at(stopping_place(pose(kEast), {1.0, -0.5}, 1.0, kParams), ahead_m, -aside_m);
}

TEST(StoppingPlace, BackwardsOutOfATurnToo) {
  // Backwards with the yaw growing: its tail goes to its right.
  const double radius_m = 2.0;
  const double angle = kWay_m / radius_m;
  expect_at(stopping_place(pose(kEast), {-1.0, 0.5}, 1.0, kParams), -radius_m * std::sin(angle),
            -radius_m * (1.0 - std::cos(angle)));
}

TEST(StoppingPlace, NoTurnIsFollowedBeyondAQuarter) {
  // 0.2 m/s and 5 rad/s would go round: a quarter, on a circle as long as the way.
  const double way_m = 0.2 * 0.4 + 0.04;
  const double radius_m = way_m / (base::kPi / 2.0);
  expect_at(stopping_place(pose(kEast), {0.2, 50.0}, 1.0, kParams), radius_m, radius_m);
  expect_at(stopping_place(pose(kEast), {0.2, -50.0}, 1.0, kParams), radius_m, -radius_m);
}

}  // namespace
}  // namespace roverd::robot
