// How a mission begins where the robot already stands on its way, or beside it.

#include "nav/behave/join.hpp"

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;

Route route(const mission::Plan& p) {
  auto made = lay_route(p, kFrame, {});
  EXPECT_TRUE(made);
  return std::move(*made);
}

PathParams stiff_car() {
  PathParams p;
  p.vehicle.kinematics = "ackermann";
  p.vehicle.wheelbase_m = 1.3;
  return p;
}

TEST(Join, ARobotOnItsWayGoesOnFromThere) {
  const Route r = route(plan({at(0, 0), at(20, 0), at(20, 20)}));
  const auto joins = join_way(r, 0, {{2.0, 0.5}, 0.3, 0.02}, {}, {});
  ASSERT_TRUE(joins);
  EXPECT_EQ(joins->step, 1u);
  EXPECT_NEAR(joins->s_m, 2.0, 0.06);
  EXPECT_EQ(joins->left_out, 1);  // item 1 is 2.1 m away: not reached, and said so
}

TEST(Join, ItPointsAheadOrBeginsAtItemOne) {
  const Route r = route(plan({at(0, 0), at(20, 0), at(20, 20)}));
  EXPECT_FALSE(join_way(r, 0, {{2.0, 0.5}, base::kPi, 0.02}, {}, {}));
  // Within what is known of the position item 1 is reached, whichever way it points.
  const auto vague = join_way(r, 0, {{2.0, 0.5}, base::kPi, 1.0}, {}, {});
  ASSERT_TRUE(vague);
  EXPECT_EQ(vague->left_out, 0);
  // What cannot turn on the spot goes round either way.
  EXPECT_TRUE(join_way(r, 0, {{2.0, 0.5}, base::kPi, 0.02}, stiff_car(), {}));
}

TEST(Join, NothingThatHappensIsLeftOut) {
  mission::Waypoint holds = at(0, 0);
  holds.hold_s = 5.0;
  const Stand stand{{2.0, 0.0}, 0.0, 0.02};
  EXPECT_FALSE(join_way(route(plan({holds, at(20, 0), at(20, 20)})), 0, stand, {}, {}));
  EXPECT_FALSE(join_way(route(plan({at(0, 0), mission::Wait{1.0}, at(20, 0)})), 0, stand, {}, {}));
  EXPECT_FALSE(join_way(route(plan({at(0, 0), mission::Action{"set_home", {}}, at(20, 0)})), 0,
                        stand, {}, {}));
  // Not even where it comes a little later on the way.
  mission::Waypoint soon = at(1, 0);
  soon.hold_s = 5.0;
  EXPECT_FALSE(join_way(route(plan({at(0, 0), soon, at(20, 0)})), 0, stand, {}, {}));
}

TEST(Join, FarFromTheBeginningItIsDrivenTo) {
  const Route r = route(plan({at(0, 0), at(20, 0), at(20, 20)}));
  EXPECT_FALSE(join_way(r, 0, {{10.0, 0.0}, 0.0, 0.02}, {}, {}));
  EXPECT_FALSE(join_way(r, 0, {{1.0, 5.0}, 0.0, 0.02}, {}, {}));
  BehaveParams never;
  never.join_m = 0.0;
  EXPECT_FALSE(join_way(r, 0, {{2.0, 0.0}, 0.0, 0.02}, {}, never));
}

TEST(Join, WhatItWouldMissFromBesideTheWayIsDrivenFromItemOne) {
  const Stand beside{{2.0, 1.2}, 0.0, 0.02};
  EXPECT_FALSE(join_way(route(plan({at(0, 0), at(3, 0), at(3, 10)})), 0, beside, {}, {}));
  EXPECT_TRUE(join_way(route(plan({at(0, 0), at(6, 0), at(6, 10)})), 0, beside, {}, {}));
  // Near enough that item 2 is reached from there, or item 2 counts from afar.
  const Stand nearer{{2.0, 0.4}, 0.0, 0.02};
  EXPECT_TRUE(join_way(route(plan({at(0, 0), at(3, 0), at(3, 10)})), 0, nearer, {}, {}));
  mission::Waypoint wide = at(3, 0);
  wide.radius_m = 1.2;
  EXPECT_TRUE(join_way(route(plan({at(0, 0), wide, at(3, 10)})), 0, beside, {}, {}));
}

TEST(Join, TheWayIsDrivenWithoutTurningBack) {
  Ride r;
  r.vehicle.at = {2.0, 0.8};
  r.load(plan({at(0, 0), at(20, 0), at(20, 10)}));
  r.start();
  double back_m = 1e9;
  for (int i = 0; i < 500; ++i) {
    r.tick();
    back_m = std::min(back_m, r.vehicle.at.east_m);
  }
  EXPECT_GT(back_m, 1.99);
  ASSERT_TRUE(r.run(90.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_EQ(r.missed, (std::vector<int>{1}));
  EXPECT_EQ(r.reached, (std::vector<int>{2, 3}));
}

TEST(Join, AnItemThatWasAskedForIsDrivenTo) {
  Ride r;
  r.vehicle.at = {2.0, 0.8};
  r.load(plan({at(0, 0), at(20, 0), at(20, 10)}));
  r.start({StartAt::From::Item, 1});
  ASSERT_TRUE(r.run(120.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3}));
}

// 4 m beside a place that it cannot aim at, with a position of 1.5 m: that is no miss.
TEST(Join, WithAPlainReceiverAnItemIsMissedOnlyBeyondWhatIsKnown) {
  for (const double sigma_m : {0.02, 1.5}) {
    SCOPED_TRACE(sigma_m);
    BehaveParams p;
    const double radius_m = arrival_radius_m(nullptr, sigma_m, p);
    EXPECT_DOUBLE_EQ(radius_m, sigma_m > 1.0 ? 4.5 : 0.5);
  }
  RouteNode wide;
  wide.radius_m = 6.0;
  EXPECT_DOUBLE_EQ(arrival_radius_m(&wide, 1.5, {}), 6.0);
}

TEST(Join, ACorridorIsKeptByWhatThePositionLeavesOfIt) {
  mission::Plan p = plan({at(0, 0), at(20, 0)});
  p.settings.corridor_m = 1.0;
  Ride r;
  r.load(p);
  r.start();
  r.tick();
  EXPECT_NEAR(r.executor.progress(r.vehicle.at, 0.1).cross_track_limit_m.value(), 0.8, 1e-9);
  EXPECT_NEAR(r.executor.progress(r.vehicle.at, 0.6).cross_track_limit_m.value(), 0.25, 1e-9);
  EXPECT_NEAR(r.executor.progress(r.vehicle.at, 1.0).arrival_radius_m.value(), 3.0, 1e-9);
}

}  // namespace
}  // namespace roverd::nav
