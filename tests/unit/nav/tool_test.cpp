// A tool's point, or a trailer's axle, follows the mission's way: judged by moving the body along
// the way that was laid for it and looking where the point goes.

#include "nav/track/tool.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

struct Pose {
  EnuPoint at;
  double yaw_rad = 0.0;
};

PathParams tracked(const ToolParams& tool) {
  PathParams p;
  p.vehicle = pulling(p.vehicle, tool);
  p.tool = tool;
  return p;
}

PathParams car(const ToolParams& tool) {
  PathParams p;
  p.vehicle.kinematics = "ackermann";
  p.vehicle.wheelbase_m = 1.0;
  p.vehicle.max_steering_deg = 35.0;
  p.tool = tool;
  return p;
}

std::vector<Vertex> through(std::vector<EnuPoint> places,
                            mission::Turn turn = mission::Turn::Auto) {
  std::vector<Vertex> v;
  for (const EnuPoint p : places) {
    Vertex one{.at = p};
    one.turn = turn;
    one.deviation_m = turn == mission::Turn::Auto ? 0.1 : 1.0;
    v.push_back(one);
  }
  v.back().stop = true;
  return v;
}

/// A body on its way, a centimetre apart; it points along the way, and turns on the spot between
/// legs.
std::vector<Pose> driven(const Path& path, const Leg& leg) {
  std::vector<Pose> all;
  for (std::size_t i = leg.first; i < leg.last; ++i) {
    const PathPoint& a = path.points[i];
    const PathPoint& b = path.points[i + 1];
    const int n = std::max(1, static_cast<int>((b.s_m - a.s_m) / 0.01));
    for (int k = 0; k <= n; ++k) {
      const double s_m = a.s_m + (b.s_m - a.s_m) * k / n;
      const double yaw = path.yaw_rad(leg, s_m, i) + (leg.reverse ? base::kPi : 0.0);
      all.push_back({path.at(s_m), base::wrap_rad(yaw)});
    }
  }
  return all;
}

EnuPoint point_of(const Pose& body, const ToolParams& t) {
  return {
      body.at.east_m + t.forward_m * std::cos(body.yaw_rad) - t.left_m * std::sin(body.yaw_rad),
      body.at.north_m + t.forward_m * std::sin(body.yaw_rad) + t.left_m * std::cos(body.yaw_rad)};
}

double off_m(EnuPoint p, const Path& way) {
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < way.points.size(); ++i) {
    const EnuPoint a = way.points[i].at;
    const EnuPoint d = way.points[i + 1].at - a;
    const double whole = d.east_m * d.east_m + d.north_m * d.north_m;
    const EnuPoint q = p - a;
    const double part =
        whole > 0.0 ? std::clamp((q.east_m * d.east_m + q.north_m * d.north_m) / whole, 0.0, 1.0)
                    : 0.0;
    least = std::min(
        least, base::distance_m(p, {a.east_m + part * d.east_m, a.north_m + part * d.north_m}));
  }
  return least;
}

/// The farthest that the point leaves its way on the legs that lead along it.
double farthest_m(const std::vector<Vertex>& vertices, const PathParams& p, bool joints = false) {
  const Path wanted = build_path(vertices, point_params(p));
  double at_m = 0.0;
  const auto led = led_way(wanted, p, at_m);
  EXPECT_TRUE(led) << led.error().detail << " at " << at_m;
  if (!led) return 1e9;
  double most = 0.0;
  for (std::size_t k = 0; k < led->legs.size(); ++k) {
    // Between two legs of the point's way there may be one that leads from the one to the other.
    if (joints && k % 2 == 1) continue;
    for (const Pose& body : driven(*led, led->legs[k])) {
      most = std::max(most, off_m(point_of(body, p.tool), wanted));
    }
  }
  return most;
}

const std::vector<EnuPoint> kBends{{0, 0}, {8, 0}, {14, 3}, {20, 3}, {25, 1}, {32, 1}};

TEST(Tool, APointBesideTheVehicleFollowsTheWayThroughBends) {
  for (const double left_m : {-1.2, -0.5, 0.3, 1.0}) {
    EXPECT_LT(farthest_m(through(kBends), tracked({.left_m = left_m})), 0.005) << left_m;
  }
}

TEST(Tool, APointAheadOrBehindFollowsTheWayThroughBends) {
  for (const double forward_m : {-1.5, -0.4, 0.4, 0.9, 2.0}) {
    for (const double left_m : {0.0, 0.4}) {
      EXPECT_LT(farthest_m(through(kBends), tracked({forward_m, left_m})), 0.015)
          << forward_m << " " << left_m;
    }
  }
}

TEST(Tool, TheVehicleGoesBesideAStraightWayByTheOffset) {
  // Given a tool 0.4 m ahead and 0.3 m to the left, and a way to the east,
  const PathParams p = tracked({.forward_m = 0.4, .left_m = 0.3});
  double at_m = 0.0;
  const auto led = led_way(build_path(through({{0, 0}, {10, 0}}), p), p, at_m);
  ASSERT_TRUE(led);
  // then the vehicle begins 0.4 m before it and 0.3 m to its right, and ends so.
  EXPECT_NEAR(led->points.front().at.east_m, -0.4, 1e-9);
  EXPECT_NEAR(led->points.front().at.north_m, -0.3, 1e-9);
  EXPECT_NEAR(led->points.back().at.east_m, 9.6, 1e-9);
  EXPECT_NEAR(led->vertex_m.back(), 10.0, 1e-9);
  EXPECT_EQ(led->points.size(), 2u);  // a straight is one piece
}

TEST(Tool, AfterATurnOnTheSpotTheVehicleGoesToWhereThePointsWayGoesOn) {
  // Given a corner that a tracked robot turns on the spot in, and a tool beside it,
  const PathParams p = tracked({.left_m = 0.5});
  const std::vector<Vertex> corner = through({{0, 0}, {10, 0}, {10, 10}});
  double at_m = 0.0;
  const auto led = led_way(build_path(corner, p), p, at_m);
  ASSERT_TRUE(led);
  // then it stops with the tool at the corner, goes 0.5 m on and 0.5 m aside, and follows again.
  ASSERT_EQ(led->legs.size(), 3u);
  EXPECT_NEAR(led->vertex_m[1], led->legs[0].end_m, 1e-9);
  const EnuPoint begins = led->points[led->legs[2].first].at;
  EXPECT_NEAR(begins.east_m, 10.5, 1e-6);
  EXPECT_NEAR(begins.north_m, 0.0, 1e-6);
  EXPECT_LT(led->legs[1].align_rad, 0.1);  // pointing there first
  EXPECT_LT(led->legs[2].align_rad, 0.1);
  EXPECT_LT(farthest_m(corner, p, true), 0.005);
}

TEST(Tool, ACarsToolFollowsThroughItsBends) {
  for (const double forward_m : {-1.0, 1.5}) {
    EXPECT_LT(farthest_m(through({{0, 0}, {20, 0}, {20, 25}, {40, 30}}), car({forward_m, 0.5})),
              0.03)
        << forward_m;
  }
}

TEST(Tool, BackwardsThePointFollowsAsWell) {
  std::vector<Vertex> way = through({{0, 0}, {-6, 0}, {-12, 2}, {-18, 2}});
  for (Vertex& v : way) v.reverse = true;
  for (const double forward_m : {-0.7, 0.7}) {
    EXPECT_LT(farthest_m(way, tracked({forward_m, 0.3})), 0.01) << forward_m;
  }
}

/// The trailer's axle, drawn by the coupling without slip, from standing straight behind.
double trailer_off_m(const std::vector<Vertex>& vertices, const PathParams& p, double& last_m) {
  const Path wanted = build_path(vertices, point_params(p));
  double at_m = 0.0;
  const auto led = led_way(wanted, p, at_m);
  EXPECT_TRUE(led) << led.error().detail << " at " << at_m;
  if (!led || led->legs.size() != 1) return 1e9;
  const auto bodies = driven(*led, led->legs[0]);
  double yaw = bodies.front().yaw_rad;
  EnuPoint axle;
  double most = 0.0;
  EnuPoint before{};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Pose& b = bodies[i];
    const EnuPoint hitch{b.at.east_m - p.tool.hitch_m * std::cos(b.yaw_rad),
                         b.at.north_m - p.tool.hitch_m * std::sin(b.yaw_rad)};
    if (i > 0) {
      const EnuPoint by = hitch - before;
      const double across = -by.east_m * std::sin(yaw) + by.north_m * std::cos(yaw);
      yaw += across / p.tool.trailer_m;
    }
    before = hitch;
    axle = {hitch.east_m - p.tool.trailer_m * std::cos(yaw) - p.tool.left_m * std::sin(yaw),
            hitch.north_m - p.tool.trailer_m * std::sin(yaw) + p.tool.left_m * std::cos(yaw)};
    most = std::max(most, off_m(axle, wanted));
  }
  last_m = base::distance_m(axle, vertices.back().at);
  return most;
}

TEST(Tool, ATrailersAxleFollowsTheWayNotTheVehicle) {
  const auto bends = through({{0, 0}, {12, 0}, {20, 6}, {32, 6}, {40, 18}});
  for (const double trailer_m : {0.8, 1.5, 3.0}) {
    for (const double hitch_m : {0.0, 0.5}) {
      double last_m = 0.0;
      const ToolParams t{.hitch_m = hitch_m, .trailer_m = trailer_m};
      // Inside of its bends by L²/(24·R); the rest is where it begins and ends.
      EXPECT_LT(trailer_off_m(bends, tracked(t), last_m), 0.02 + trailer_m / 20.0)
          << trailer_m << " " << hitch_m;
      EXPECT_LT(last_m, 0.02);
      EXPECT_LT(trailer_off_m(bends, car(t), last_m), 0.02 + trailer_m / 20.0);
      EXPECT_LT(last_m, 0.02);
    }
  }
}

TEST(Tool, AVehicleWithATrailerNeverTurnsOnTheSpot) {
  const PathParams p = tracked({.hitch_m = 0.4, .trailer_m = 1.2});
  EXPECT_TRUE(p.vehicle.steered());
  double last_m = 0.0;
  // A right angle that it would turn on the spot in without one.
  EXPECT_LT(trailer_off_m(through({{0, 0}, {15, 0}, {15, 15}}), p, last_m), 0.1);
  EXPECT_LT(last_m, 0.02);
}

TEST(Tool, WhatCannotBeFollowedIsRefusedWithItsItem) {
  // Given a tool 2 m to the left and a bend to the right of less than 2 m,
  PathParams p = tracked({.left_m = 2.0});
  mission::Waypoint bend = at(10, 0);
  bend.turn = mission::Turn::Through;
  bend.radius_m = 0.3;
  const auto narrow = lay_route(plan({at(0, 0), bend, at(10, -10)}), kFrame, p);
  ASSERT_FALSE(narrow);
  EXPECT_EQ(narrow.error().fields.at(0).pointer, "/items/1");
  // and a trailer that would be pushed:
  p = tracked({.trailer_m = 1.0});
  mission::Waypoint back = at(-5, 0);
  back.reverse = true;
  const auto pushed = lay_route(plan({at(0, 0), at(10, 0), back}), kFrame, p);
  ASSERT_FALSE(pushed);
  EXPECT_EQ(pushed.error().fields.at(0).pointer, "/items/2");
  EXPECT_NE(pushed.error().detail.find("trailer"), std::string::npos);
}

TEST(Tool, TheMissionIsDrivenSoThatTheToolReachesItsItems) {
  // Given a robot with a tool 0.6 m ahead and 0.4 m to the right, and a mission with a corner,
  Ride ride;
  PathParams p;
  p.tool = {.forward_m = 0.6, .left_m = -0.4};
  ride.path.adopt(std::make_shared<const PathParams>(p));
  auto route = lay_route(plan({at(2, 0), at(10, 0), at(10, 8)}), kFrame, p);
  ASSERT_TRUE(route) << route.error().detail;
  ride.executor.load(std::make_shared<const Route>(std::move(*route)));
  // when it is driven,
  ride.start();
  std::vector<EnuPoint> at_items;
  for (int i = 0; i < 5000 && ride.executor.running(); ++i) {
    const std::size_t before = ride.reached.size();
    ride.tick();
    for (std::size_t k = before; k < ride.reached.size(); ++k) {
      at_items.push_back(point_of({ride.vehicle.at, ride.vehicle.yaw_rad}, p.tool));
    }
  }
  // then the tool was at each item.
  ASSERT_EQ(ride.reached, (std::vector{1, 2, 3}));
  EXPECT_LT(base::distance_m(at_items[1], {10, 0}), 0.06);
  EXPECT_LT(base::distance_m(at_items[2], {10, 8}), 0.06);
}

TEST(Tool, TheWayBackLeadsTheToolToo) {
  const PathParams p = tracked({.forward_m = -0.5, .left_m = 0.2});
  const auto route =
      lay_route(plan({at(0, 0), at(10, 0), at(15, 1)}, mission::AtEnd::BackAndForth), kFrame, p);
  ASSERT_TRUE(route);
  // On the way back the vehicle's left is the other side of the way.
  EXPECT_GT(route->back.path.at(route->back.path.length_m()).north_m, 0.15);
  EXPECT_LT(route->forth.path.at(0.0).north_m, -0.15);
}

TEST(Tool, ALongWayStaysSmall) {
  std::vector<EnuPoint> places;
  for (int i = 0; i <= 1000; ++i) places.push_back({double(i % 2) * 100.0, i * 0.5});
  const PathParams p = tracked({.forward_m = 0.3, .left_m = 0.2});
  double at_m = 0.0;
  const auto led = led_way(build_path(through(places), p), p, at_m);
  ASSERT_TRUE(led);
  EXPECT_LT(led->points.size(), 100'000u);
  EXPECT_TRUE(std::is_sorted(led->vertex_m.begin(), led->vertex_m.end()));
}

}  // namespace
}  // namespace roverd::nav
