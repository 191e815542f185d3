// What the sensors see, as JSON: on the map and about the body, whatever the odometry calls its
// axes.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "api/json/words.hpp"
#include "base/angle.hpp"

namespace roverd::api {
namespace {

base::Time at_s(double s) {
  return base::Time{} + base::from_seconds(s);
}

constexpr base::LatLon kOrigin{58.0, 26.0};

/// A robot 10 m east of the frame's origin that looks east; its odometry says (3, 4) and north.
std::unique_ptr<base::Snapshot> standing() {
  auto s = std::make_unique<base::Snapshot>();
  s->now = at_s(10.0);
  s->frame.emplace(1u, kOrigin);
  s->pose.emplace();
  s->pose->at = {10.0, 0.0};
  s->pose->yaw_rad = 0.0;
  s->odometry = base::OdometryPlace{3.0, 4.0, base::kPi / 2.0};
  return s;
}

/// Made a moment ago, when the robot stood 1 m further back: odometry (3, 3).
robot::Outlook before_that() {
  robot::Outlook o;
  o.stamp = at_s(9.5);
  o.at = {3.0, 3.0, base::kPi / 2.0};
  o.things.push_back({.drop = false,
                      .ahead_m = 3.0,
                      .left_m = 2.0,
                      .clearance_m = 2.5,
                      .size_m = 0.4,
                      .age_s = 0.2,
                      .sensor = "front",
                      .on_way = true});
  return o;
}

TEST(OutlookWords, AThingHasItsPlaceOnTheMapAndFromTheRobotAsItStandsNow) {
  // Then it was 3 m ahead and 2 m to the left; the robot went on by 1 m, and looks east:
  // 2 m further east than the robot, 2 m further north.
  const Json all = obstacles_json(std::make_unique<robot::Outlook>(before_that()).get(),
                                  *standing(), at_s(10.0));
  EXPECT_EQ(all["age_s"], 0.5);
  EXPECT_EQ(all["complete"], true);
  const Json& one = all["items"].at(0);
  const base::LatLon there = base::LocalFrame(2, kOrigin).to_global({12.0, 2.0});
  EXPECT_NEAR(one["lat"], there.lat, 1e-8);
  EXPECT_NEAR(one["lon"], there.lon, 1e-8);
  EXPECT_EQ(one["distance_m"], 2.83);
  EXPECT_EQ(one["bearing_deg"], -45.0) << "to the left";
  EXPECT_EQ(one["clearance_m"], 2.5);
  EXPECT_EQ(one["size_m"], 0.4);
  EXPECT_EQ(one["age_s"], 0.7) << "0.2 s when the picture was made";
  EXPECT_EQ(one["what"], "obstacle");
  EXPECT_EQ(one["sensor"], "front");
  EXPECT_EQ(one["on_way"], true);
}

TEST(OutlookWords, WithoutAPlaceOfItsOwnNothingIsPutOnTheMap) {
  auto s = standing();
  s->pose->heading_known = false;
  auto o = before_that();
  const Json one = obstacles_json(&o, *s, at_s(10.0))["items"].at(0);
  EXPECT_TRUE(one["lat"].is_null());
  EXPECT_TRUE(one["lon"].is_null());
  EXPECT_EQ(one["distance_m"], 2.83);
  EXPECT_TRUE(grid_json(o, *s, at_s(10.0))["at"].is_null());
  EXPECT_TRUE(scan_json(o, *s, at_s(10.0))["at"].is_null());
}

TEST(OutlookWords, NothingSeenYetIsAnEmptyListWithoutAnAge) {
  const Json none = obstacles_json(nullptr, *standing(), at_s(10.0));
  EXPECT_TRUE(none["age_s"].is_null());
  EXPECT_TRUE(none["items"].is_array() && none["items"].empty());
}

TEST(OutlookWords, WhatTheGuardStopsForIsOnTheWayAlsoOfARobotThatStands) {
  auto o = before_that();
  o.things[0].on_way = false;
  o.things.push_back(o.things[0]);
  o.things[1].ahead_m = 7.0;
  auto s = standing();
  s->obstacle.emplace();
  s->obstacle->action = base::GuardAction::Stop;
  s->obstacle->what = "obstacle";
  s->obstacle->ahead_m = 2.1;  // as the robot stands now
  s->obstacle->left_m = 1.9;
  Json items = obstacles_json(&o, *s, at_s(10.0))["items"];
  EXPECT_EQ(items.at(0)["on_way"], true);
  EXPECT_EQ(items.at(1)["on_way"], false);
  s->obstacle->what = "drop";  // it is something else that stops it
  items = obstacles_json(&o, *s, at_s(10.0))["items"];
  EXPECT_EQ(items.at(0)["on_way"], false);
}

TEST(OutlookWords, ManyThingsAreSaidToBeNotAll) {
  auto o = before_that();
  o.things.resize(robot::Outlook::kMostThings, o.things[0]);
  EXPECT_EQ(obstacles_json(&o, *standing(), at_s(10.0))["complete"], false);
}

TEST(OutlookWords, TheGridHasItsCornerTurnAndRunsOfCells) {
  auto o = before_that();
  // Its corner 2 m to the right of where the robot stands now and 1 m ahead, in the odometry's
  // axes: x to the east of it, y ahead.
  o.grid = {.cell_m = 0.1, .x_m = 5.0, .y_m = 5.0, .side = 4, .runs = {0x4f}};
  const Json grid = grid_json(o, *standing(), at_s(10.0));
  EXPECT_NEAR(grid["from_robot"]["ahead_m"], 1.0, 1e-9);
  EXPECT_NEAR(grid["from_robot"]["left_m"], -2.0, 1e-9);
  EXPECT_NEAR(grid["from_robot"]["turn_deg"], -90.0, 1e-9) << "rows run to its right";
  // Ahead is east, right is south.
  const base::LatLon corner = base::LocalFrame(2, kOrigin).to_global({11.0, -2.0});
  EXPECT_NEAR(grid["at"]["lat"], corner.lat, 1e-8);
  EXPECT_NEAR(grid["at"]["lon"], corner.lon, 1e-8);
  EXPECT_EQ(grid["at"]["heading_deg"], 180.0);
  EXPECT_EQ(grid["columns"], 4);
  EXPECT_EQ(grid["rows"], 4);
  EXPECT_EQ(grid["cell_m"], 0.1);
  EXPECT_EQ(grid["runs"], "Tw==");  // RFC 4648: 0x4f
}

TEST(OutlookWords, RunsAreBase64AsOfRfc4648) {
  auto o = before_that();
  const auto runs = [&](std::vector<std::uint8_t> bytes) {
    o.grid.runs = std::move(bytes);
    return grid_json(o, *standing(), at_s(10.0))["runs"];
  };
  // Section 10 of it: "", "f", "fo", "foo", "foob".
  EXPECT_EQ(runs({}), "");
  EXPECT_EQ(runs({'f'}), "Zg==");
  EXPECT_EQ(runs({'f', 'o'}), "Zm8=");
  EXPECT_EQ(runs({'f', 'o', 'o'}), "Zm9v");
  EXPECT_EQ(runs({'f', 'o', 'o', 'b'}), "Zm9vYg==");
  EXPECT_EQ(runs({0xff, 0xff, 0xfe}), "///+");
}

TEST(OutlookWords, TheScanIsPointsAboutTheBodyByWhatTheyAre) {
  auto o = before_that();
  o.rays[180] = {2.0F, 1.95F};  // straight ahead
  using Dot = robot::Outlook::Dot;
  o.scans.push_back(
      {"top",
       at_s(9.4),
       {{2.0F, 0.0F, Dot::Obstacle}, {1.0F, -0.505F, Dot::Overhang}, {1.5F, 0.25F, Dot::Passing}}});
  const Json scan = scan_json(o, *standing(), at_s(10.0));
  const base::LatLon was = base::LocalFrame(2, kOrigin).to_global({9.0, 0.0});
  EXPECT_NEAR(scan["at"]["lat"], was.lat, 1e-8);
  EXPECT_NEAR(scan["at"]["lon"], was.lon, 1e-8);
  EXPECT_EQ(scan["at"]["heading_deg"], 90.0);
  EXPECT_EQ(scan["hit_cm"].size(), 360u);
  EXPECT_EQ(scan["hit_cm"][180], 200);
  EXPECT_EQ(scan["free_cm"][180], 195);
  EXPECT_EQ(scan["hit_cm"][0], 0);
  const Json& top = scan["sensors"].at(0);
  EXPECT_EQ(top["sensor"], "top");
  EXPECT_EQ(top["age_s"], 0.6);
  EXPECT_EQ(top["obstacle_cm"], Json({200, 0}));
  EXPECT_EQ(top["overhang_cm"].size(), 2u);
  EXPECT_EQ(top["passing_cm"], Json({150, 25}));
  EXPECT_TRUE(top["drop_cm"].empty());
}

}  // namespace
}  // namespace roverd::api
