// A few points, driven by a robot that does what it is told at once.

#include "nav/behave/trip.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

class Trips : public ::testing::Test {
 protected:
  static Vertex to(double east_m, double north_m) {
    Vertex v;
    v.at = {east_m, north_m};
    v.speed_mps = 0.4;
    v.tangent = false;
    return v;
  }
  void tick() {
    const base::BodyTwist t = trip.step(v, 1.0, 0.02).command;
    v.yaw_rad = base::wrap_rad(v.yaw_rad + t.angular_radps * 0.02);
    v.at.east_m += t.linear_mps * 0.02 * std::cos(v.yaw_rad);
    v.at.north_m += t.linear_mps * 0.02 * std::sin(v.yaw_rad);
    v.speed_mps = t.linear_mps;
    v.yaw_rate_radps = t.angular_radps;
  }
  /// Where it points when it has driven 2 cm.
  double points_deg() {
    const EnuPoint from = v.at;
    for (int i = 0; i < 50 * 20 && base::distance_m(from, v.at) < 0.02; ++i) tick();
    return base::deg_from_rad(v.yaw_rad);
  }
  /// How far back the way leads somewhere, against where the robot points.
  double leads_back_m() const {
    const Path& path = trip.path();
    double farthest_m = 0.0;
    double back_m = 0.0;
    for (double s_m = 0.0; s_m < path.length_m(); s_m += 0.02) {
      const EnuPoint p = path.at(s_m);
      const double ahead_m = (p.east_m - v.at.east_m) * std::cos(v.yaw_rad) +
                             (p.north_m - v.at.north_m) * std::sin(v.yaw_rad);
      farthest_m = std::max(farthest_m, ahead_m);
      back_m = std::max(back_m, farthest_m - ahead_m);
    }
    return back_m;
  }

  base::Setting<PathParams> path_params{PathParams{}};
  base::Setting<BehaveParams> behave{BehaveParams{}};
  Trip trip{path_params, behave};
  Vehicle v;
};

TEST_F(Trips, ASlightTurnIsABendUnlessItIsAskedForOnTheSpot) {
  // Given a way that leads away by 20 degrees,
  const std::vector<Vertex> way{
      to(2.0 * std::cos(base::rad_from_deg(20.0)), 2.0 * std::sin(base::rad_from_deg(20.0)))};
  Trip::Order order;
  order.way = way;
  trip.begin(order, v, false);
  EXPECT_LT(points_deg(), 12.0);
  // when it shall turn first,
  v = {};
  order.turns_first = true;
  trip.begin(order, v, false);
  // then it points along it before it drives.
  EXPECT_NEAR(points_deg(), 20.0, 3.0);
}

TEST_F(Trips, AWayThatBeginsNearIsNotLedPastItsBegin) {
  // Given a robot on its way,
  Trip::Order order;
  order.way = {to(5.0, 0.0)};
  trip.begin(order, v, false);
  for (int i = 0; i < 200; ++i) tick();
  ASSERT_GT(v.speed_mps, 0.3);
  // when another way begins so near, a little aside, as it is slow,
  v.speed_mps = 0.05;
  order.way = {to(v.at.east_m + 0.15, v.at.north_m - 0.05), to(v.at.east_m + 0.5, -1.0)};
  trip.begin(order, v, true);
  // then it does not drive on past that and come back.
  EXPECT_LT(leads_back_m(), 0.02);
  EXPECT_LT(trip.path().length_m(), 1.4);
}

TEST_F(Trips, GoalsThatAreToldAgainAndAgainANoseAheadAreDriven) {
  // Given somebody who tells a goal 0.4 m ahead five times a second,
  v.speed_mps = 0.15;
  for (int i = 0; i < 50 * 20; ++i) {
    if (i % 10 == 0) {
      Trip::Order order;
      order.way = {
          to(v.at.east_m + 0.4 * std::cos(v.yaw_rad), v.at.north_m + 0.4 * std::sin(v.yaw_rad))};
      order.way.front().speed_mps = 0.15;
      trip.begin(order, v, true);
    }
    tick();
  }
  // then it drives, and does not stop for each of them.
  EXPECT_GT(v.at.east_m, 2.0);
}

TEST_F(Trips, ATurnOnItsWayIsTurnedAlsoWhereItWasInterruptedInIt) {
  // Given a stop on its way, where it shall turn by 20 degrees before it goes on,
  Trip::Order order;
  order.way = {to(1.0, 0.0), to(1.0 + std::cos(0.35), std::sin(0.35))};
  order.way[0].stop = true;
  order.way[0].turn = mission::Turn::Pivot;
  trip.begin(order, v, false);
  for (int i = 0; i < 50 * 20 && !trip.turns_onto(); ++i) tick();
  ASSERT_TRUE(trip.turns_onto());
  ASSERT_NEAR(v.at.east_m, 1.0, 0.05);
  for (int i = 0; i < 5; ++i) tick();
  // when something holds it in the middle of that,
  trip.interrupt();
  v.speed_mps = v.yaw_rate_radps = 0.0;
  // then it turns to the end before it drives.
  EXPECT_NEAR(points_deg(), base::deg_from_rad(0.35), 3.0);
}

TEST_F(Trips, AWayThatBeginsFarAheadIsJoinedWithoutAStop) {
  Trip::Order order;
  order.way = {to(5.0, 0.0)};
  trip.begin(order, v, false);
  for (int i = 0; i < 200; ++i) tick();
  order.way = {to(v.at.east_m + 3.0, 0.4)};
  trip.begin(order, v, true);
  double slowest_mps = 1.0;
  for (int i = 0; i < 100; ++i) {
    tick();
    slowest_mps = std::min(slowest_mps, v.speed_mps);
  }
  EXPECT_GT(slowest_mps, 0.2);
}

}  // namespace
}  // namespace roverd::nav
