// Turns that have a radius: forwards on an arc from where the robot stands.

#include <cmath>

#include <gtest/gtest.h>

#include "nav/behave/stops.hpp"
#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;
using mission::TurnBy;

PathParams car_params() {
  PathParams p;
  p.vehicle.kinematics = "ackermann";
  p.vehicle.wheelbase_m = 1.3;
  p.vehicle.max_steering_deg = 40.0;
  return p;
}

//        ╭──╮
//        │  ▼ 2 m to the right, pointing back
TEST(ArcTurn, LeadsRoundAHalfCircleForwards) {
  Ride r;
  r.vehicle.yaw_rad = base::kPi / 2.0;
  r.load(plan({TurnBy{180.0, std::nullopt, 1.0}, mission::Wait{0.1}}));
  r.start();
  double slowest_mps = 0.0;
  while (r.executor.running()) {
    r.tick();
    slowest_mps = std::min(slowest_mps, r.vehicle.speed_mps);
    ASSERT_LT(r.vehicle.at.north_m, 1.1);
  }
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished) << r.executor.reason();
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2}));
  EXPECT_NEAR(r.vehicle.at.east_m, 2.0, 0.06);
  EXPECT_NEAR(r.vehicle.at.north_m, 0.0, 0.06);
  EXPECT_NEAR(r.vehicle.yaw_rad, -base::kPi / 2.0, 0.03);
  EXPECT_EQ(slowest_mps, 0.0);
}

TEST(ArcTurn, LeadsToAHeadingTheShorterWay) {
  Ride r;  // looks east
  r.load(plan({TurnBy{std::nullopt, 0.0, 2.0}}));
  r.start();
  ASSERT_TRUE(r.run(60.0));
  EXPECT_NEAR(r.vehicle.at.east_m, 2.0, 0.06);
  EXPECT_NEAR(r.vehicle.at.north_m, 2.0, 0.06);
  EXPECT_NEAR(r.vehicle.yaw_rad, base::kPi / 2.0, 0.03);
}

// A pause in its middle, and a restart there: what is left of it is driven.
TEST(ArcTurn, GoesOnWithWhatIsLeftOfIt) {
  for (const bool restarts : {false, true}) {
    const auto mission = plan({TurnBy{-90.0, std::nullopt, 4.0}});
    Ride r;
    r.load(mission);
    r.start();
    while (r.executor.running() && r.vehicle.yaw_rad < base::rad_from_deg(40.0)) r.tick();
    if (restarts) {
      const auto place = r.executor.place();
      ASSERT_TRUE(place);
      EXPECT_NEAR(place->left, base::rad_from_deg(50.0), 0.1);
      ASSERT_TRUE(r.executor.restore(r.route_of(mission), *place, "restarted"));
    } else {
      r.executor.pause("asked");
    }
    r.vehicle.speed_mps = r.vehicle.yaw_rate_radps = 0.0;
    ASSERT_TRUE(r.executor.resume(r.vehicle.at));
    ASSERT_TRUE(r.run(60.0));
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished) << r.executor.reason();
    EXPECT_NEAR(base::deg_from_rad(r.vehicle.yaw_rad), 90.0, 3.0);
    EXPECT_NEAR(r.vehicle.at.east_m, 4.0, 0.3);
    EXPECT_NEAR(r.vehicle.at.north_m, 4.0, 0.3);
  }
}

// Nobody stands at once: what it rolls on as it brakes is of the arc, each time anew.
TEST(ArcTurn, IsAsLongWithPausesAsWithout) {
  Ride r;
  r.load(plan({TurnBy{-180.0, std::nullopt, 2.0}}));
  r.start();
  for (const double at_deg : {40.0, 80.0, 120.0}) {
    while (r.executor.running() && r.vehicle.yaw_rad < base::rad_from_deg(at_deg)) r.tick();
    r.executor.pause("asked");
    const double by_rad = base::rad_from_deg(5.0);
    r.vehicle.yaw_rad += by_rad;
    r.vehicle.at = r.vehicle.at + EnuPoint{2.0 * by_rad * std::cos(r.vehicle.yaw_rad),
                                           2.0 * by_rad * std::sin(r.vehicle.yaw_rad)};
    r.vehicle.speed_mps = r.vehicle.yaw_rate_radps = 0.0;
    ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  }
  ASSERT_TRUE(r.run(60.0));
  EXPECT_NEAR(std::abs(base::deg_from_rad(base::wrap_rad(r.vehicle.yaw_rad))), 180.0, 3.0);
}

// Between a pause and its going on the program may end: what it braked is of the arc there, too.
TEST(ArcTurn, IsAsLongWithARestartDuringAPause) {
  // Given: paused at 40 degrees, and rolled on by 5.
  const auto mission = plan({TurnBy{-90.0, std::nullopt, 4.0}});
  Ride r;
  r.load(mission);
  r.start();
  while (r.executor.running() && r.vehicle.yaw_rad < base::rad_from_deg(40.0)) r.tick();
  r.executor.pause("asked");
  const double paused_rad = r.executor.place()->left;
  r.vehicle.yaw_rad += base::rad_from_deg(5.0);
  r.vehicle.speed_mps = r.vehicle.yaw_rate_radps = 0.0;
  // When: its place is kept, and it goes on from there after a restart.
  const auto kept = r.executor.place(r.vehicle.yaw_rad);
  ASSERT_TRUE(kept);
  EXPECT_NEAR(kept->left, paused_rad - base::rad_from_deg(5.0), 0.01);
  ASSERT_TRUE(r.executor.restore(r.route_of(mission), *kept, "restarted"));
  EXPECT_NEAR(r.executor.place(r.vehicle.yaw_rad + 0.1)->left, kept->left, 1e-9) << "once only";
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  ASSERT_TRUE(r.run(60.0));
  // Then
  EXPECT_NEAR(base::deg_from_rad(r.vehicle.yaw_rad), 90.0, 3.0);
}

// Turned by hand while it waits: the heading counts, not what was left of the way to it.
TEST(ArcTurn, LeadsToItsHeadingAlsoIfItWasTurnedByHandMeanwhile) {
  for (const double by_deg : {-20.0, 20.0}) {
    SCOPED_TRACE(by_deg);
    // Given an arc from east to north, paused at 40 degrees,
    Ride r;
    r.load(plan({TurnBy{std::nullopt, 0.0, 4.0}}));
    r.start();
    while (r.executor.running() && r.vehicle.yaw_rad < base::rad_from_deg(40.0)) r.tick();
    r.executor.pause("asked");
    r.vehicle.speed_mps = r.vehicle.yaw_rate_radps = 0.0;
    // when somebody turns the robot and resumes,
    r.vehicle.yaw_rad += base::rad_from_deg(by_deg);
    ASSERT_TRUE(r.executor.resume(r.vehicle.at));
    ASSERT_TRUE(r.run(60.0));
    // then it points north.
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished) << r.executor.reason();
    EXPECT_NEAR(base::deg_from_rad(r.vehicle.yaw_rad), 90.0, 3.0);
  }
}

//   west ◀──╮
//   east ●──╯      begun to the left, it stays so
TEST(ArcTurn, KeepsItsHandToAHeadingBehindIt) {
  Ride r;
  r.vehicle.yaw_rad = 0.05;
  r.load(plan({TurnBy{std::nullopt, 270.0, 2.0}}));
  r.start();
  for (int i = 0; i < 10; ++i) r.tick();
  r.executor.pause("asked");
  r.vehicle.speed_mps = r.vehicle.yaw_rate_radps = 0.0;
  r.vehicle.yaw_rad = -0.05;  // from here the other way round is shorter
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  ASSERT_TRUE(r.run(60.0));
  EXPECT_NEAR(std::abs(base::deg_from_rad(r.vehicle.yaw_rad)), 180.0, 3.0);
  EXPECT_NEAR(r.vehicle.at.north_m, 4.0, 0.3);
}

TEST(ArcTurn, AVehicleThatCannotTurnOnTheSpotDrivesItNoNarrowerThanItCan) {
  const auto refusal = [](const TurnBy& turn) {
    const auto route = lay_route(plan({at(1, 1), turn}), kFrame, car_params());
    return route ? std::string() : route.error().fields.at(0).detail;
  };
  EXPECT_EQ(refusal({90.0, std::nullopt}),
            "this vehicle cannot turn on the spot; with a radius_m it drives an arc");
  EXPECT_EQ(refusal({90.0, std::nullopt, 1.6}),
            "is a turn too narrow for this vehicle: its radius_m must be at least 1.7 m");
  EXPECT_EQ(refusal({90.0, std::nullopt, 1.8}), "");
}

TEST(ArcTurn, BetweenRowsItCountsAsWayAndAsksForNoPlace) {
  const auto asks_none = [](double radius_m) {
    const auto route = lay_route(
        plan({mission::Row{}, TurnBy{180.0, std::nullopt, radius_m}, mission::Row{}}), kFrame, {});
    return asks_no_place(route->forth, 1);
  };
  EXPECT_TRUE(asks_none(9.0));    // 28 m
  EXPECT_FALSE(asks_none(10.0));  // 31 m: the odometry alone is not trusted so far
}

TEST(ArcTurn, TakesThePlanToWhereNobodyKnows) {
  const auto route = lay_route(
      plan({at(0, 0), at(5, 0), TurnBy{90.0, std::nullopt, 1.0}, TurnBy{90.0, {}}}), kFrame, {});
  ASSERT_TRUE(route);
  const CourseStops stops = stops_of(route->forth, 100);
  ASSERT_EQ(stops.stops.size(), 2U);
  EXPECT_TRUE(stops.stops.back().turns.empty()) << "the turn on the spot is elsewhere";
}

}  // namespace
}  // namespace roverd::nav
