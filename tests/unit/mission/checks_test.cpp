// What speaks against driving a mission.

#include "mission/checks.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace roverd::mission {
namespace {

using base::EnuPoint;

const base::LocalFrame kGround(1, {58.0, 26.0});

Waypoint spot(double east_m, double north_m) {
  Waypoint waypoint;
  waypoint.at = kGround.to_global({east_m, north_m});
  return waypoint;
}

Plan course(std::vector<Item> items) {
  Plan plan;
  plan.name = "course";
  plan.items = std::move(items);
  return plan;
}

VehicleLimits tracks() {
  VehicleLimits limits;
  limits.item_types = {"waypoint", "local", "wait", "speed", "jump", "return_home"};
  return limits;
}
VehicleLimits car() {
  VehicleLimits limits = tracks();
  limits.turn_radius_m = 3.9;
  limits.steer_in_m = 3.0;
  limits.settle_m = 8.0;
  return limits;
}

/// "code@item", in the report's order.
std::vector<std::string> found(const Plan& plan, const VehicleLimits& vehicle,
                               const Surroundings& around = {}) {
  std::vector<std::string> out;
  for (const Finding& f : check(plan, vehicle, around).findings) {
    out.push_back(f.code + "@" + std::to_string(f.item.value_or(0)));
  }
  return out;
}
using Codes = std::vector<std::string>;

TEST(Check, AGoodCourseHasNoFindings) {
  EXPECT_EQ(found(course({spot(0, 0), spot(20, 0), spot(20, 20)}), tracks()), Codes{});
}

TEST(Check, WhatIsDrivenFromAnywhereNeedsNoPlace) {
  VehicleLimits v = tracks();
  v.item_types.insert(v.item_types.end(), {"move", "turn", "row"});
  EXPECT_EQ(found(course({Row{}, Move{1.5}, TurnBy{90.0, std::nullopt}, Row{}}), v), Codes{});
}

TEST(Check, NamesTheItemsThatSpeakAgainstIt) {
  Waypoint high = spot(10, 0);
  high.alt_m = 50.0;
  Waypoint low = spot(0, 0);
  low.alt_m = 40.0;
  Waypoint fast = spot(5, 5);
  fast.speed_mps = 3.0;
  const VehicleLimits v = tracks();

  EXPECT_EQ(found(course({}), v), Codes{"no_target@0"});
  EXPECT_EQ(found(course({Speed{0.5}, Wait{1.0}}), v), Codes{"no_target@0"});
  // Local places count from a home: without one they are nowhere, and it is said of each.
  EXPECT_EQ(found(course({Local{2.0, 3.0, std::nullopt}, spot(0, 0)}), v), Codes{"no_target@1"});
  EXPECT_EQ(found(course({spot(0, 0), spot(0, 0)}), v), Codes{"duplicate_point@2"});
  EXPECT_EQ(found(course({spot(0, 0), spot(1500, 0)}), v), Codes{"leg_too_long@2"});
  EXPECT_EQ(found(course({low, high}), v), Codes{"too_steep@2"});
  EXPECT_EQ(found(course({fast}), v), Codes{"speed_above_limit@1"});
  EXPECT_EQ(found(course({spot(0, 0), Speed{9.0}}), v), Codes{"speed_above_limit@2"});
  EXPECT_EQ(found(course({spot(0, 0), spot(9, 9), Jump{1, 0}}), v), Codes{"repeats_for_ever@3"});
  EXPECT_EQ(found(course({spot(0, 0), spot(0, 12'000)}), v), Codes{"too_far@2"});
  EXPECT_EQ(found(course({spot(0, 0)}), v, {kGround.to_global({0, 2000}), nullptr}),
            Codes{"too_far@1"});
}

TEST(Check, TellsWhatMustBeConfiguredForAType) {
  const auto report = check(course({spot(0, 0), Row{RowSide::Left, 0.8}, Wall{Side::Left, 1.0},
                                    Landmarks{"cone", 0.7}, Dock{5}}),
                            tracks(), {});

  EXPECT_EQ(report.errors, 4u);
  EXPECT_EQ(report.findings.at(0).pointer, "/items/1");
  EXPECT_NE(report.findings.at(0).detail.find("no scanner"), std::string::npos);
  EXPECT_NE(report.findings.at(1).detail.find("no scanner or camera"), std::string::npos);
  EXPECT_NE(report.findings.at(2).detail.find("no scanner or camera"), std::string::npos);
  EXPECT_NE(report.findings.at(3).detail.find("no camera that reads tags"), std::string::npos);
}

// The guard keeps 0.08 m beside a body of 0.78 m: an item that asks for less never moves.
TEST(Check, NamesTheLeastDistanceThatTheGuardLetsItDrive) {
  VehicleLimits v = tracks();
  v.item_types.insert(v.item_types.end(), {"wall", "row"});
  v.room_m = 0.469;

  EXPECT_EQ(found(course({Wall{Side::Left, 0.46}}), v), Codes{"too_near@1"});
  EXPECT_EQ(found(course({Wall{Side::Left, 0.47}}), v), Codes{});
  EXPECT_EQ(found(course({Wall{Side::Right, 0.3}}), v), Codes{"too_near@1"});
  EXPECT_EQ(found(course({Wall{}}), v), Codes{});
  v.wall_m = 0.46;
  EXPECT_EQ(found(course({Wall{}}), v), Codes{"too_near@1"}) << "what the profile says of walls";
  EXPECT_EQ(found(course({Row{RowSide::Left, 0.4}}), v), Codes{"too_near@1"});
  EXPECT_EQ(found(course({Row{RowSide::Right, 0.7}}), v), Codes{});
  EXPECT_EQ(found(course({Row{RowSide::Both, 0.7}}), v), Codes{"no_effect@1"});
  EXPECT_EQ(found(course({Row{RowSide::Both}}), v), Codes{});
  const auto report = check(course({Wall{Side::Left, 0.4}}), v, {});
  EXPECT_EQ(report.errors, 1u);
  EXPECT_NE(report.findings.at(0).detail.find("0.47 m"), std::string::npos)
      << report.findings.at(0).detail;
  v.room_m = 0.0;  // nothing is guarded
  EXPECT_EQ(found(course({Wall{Side::Left, 0.1}}), v), Codes{});
}

TEST(Check, TellsOfWaysThatNoSensorSees) {
  VehicleLimits v = tracks();
  v.item_types.insert(v.item_types.end(), {"move", "turn"});
  v.sees_behind = v.sees_around = false;
  Waypoint back = spot(20, 0);
  back.reverse = true;
  const Plan shunt = course({Move{2.0}, Move{-3.0}, Move{2.0}, Move{-1.0}});
  const Plan spin = course({TurnBy{90.0, std::nullopt}, Move{1.0}});

  EXPECT_EQ(found(shunt, v), Codes{"unseen_way@2"}) << "once";
  EXPECT_EQ(found(course({spot(10, 0), back}), v), Codes{"unseen_way@2"});
  EXPECT_EQ(found(spin, v), Codes{"unseen_way@1"});
  EXPECT_EQ(check(shunt, v, {}).errors, 0u);
  v.creeps_back = v.creeps_turning = true;
  EXPECT_EQ(found(shunt, v), Codes{});
  EXPECT_EQ(found(spin, v), Codes{});
  v.creeps_back = v.creeps_turning = false;
  v.sees_behind = v.sees_around = true;
  EXPECT_EQ(found(shunt, v), Codes{});
  EXPECT_EQ(found(spin, v), Codes{});
}

TEST(Check, ACarNeedsRoomToTurn) {
  // 90 deg: 2 · (3.9 tan 45° + 3) + 8 = 21.8 m between two corners
  const auto square = [](double side) {
    return course({spot(0, 0), spot(side, 0), spot(side, side), spot(0, side)});
  };
  EXPECT_EQ(found(square(23), car()), Codes{});
  EXPECT_EQ(found(square(20), car()), Codes{"turn_too_tight@3"});
  EXPECT_EQ(found(square(6), car()),
            (Codes{"turn_too_tight@2", "turn_too_tight@3", "turn_too_tight@4"}));
  EXPECT_EQ(found(square(6), tracks()), Codes{});
  Waypoint pivot = spot(50, 0);
  pivot.turn = Turn::Pivot;
  EXPECT_EQ(found(course({spot(0, 0), pivot}), car()), Codes{"turn_too_tight@2"});
}

TEST(Check, KeepsInsideTheFence) {
  Fence fence{"field", {}, {}};
  FencePolygon corners;
  for (const EnuPoint p :
       {EnuPoint{-10, -10}, EnuPoint{100, -10}, EnuPoint{100, 100}, EnuPoint{-10, 100}}) {
    corners.points.push_back(kGround.to_global(p));
  }
  fence.areas = {{AreaKind::Inclusion, corners},
                 {AreaKind::Exclusion, FenceCircle{kGround.to_global({50, 0}), 5.0}}};
  const Surroundings around{std::nullopt, &fence};

  EXPECT_EQ(found(course({spot(0, 0), spot(20, 0)}), tracks(), around), Codes{});
  EXPECT_EQ(found(course({spot(0, 0), spot(90, 0)}), tracks(), around), Codes{"outside_fence@2"});
  EXPECT_EQ(found(course({spot(0, 0), spot(-30, 0)}), tracks(), around), Codes{"outside_fence@2"});
  EXPECT_EQ(found(course({spot(0, 0), spot(-9.8, 0)}), tracks(), around), Codes{"near_fence@2"});
}

TEST(Estimate, CountsWayWaitsTurnsAndRepetitions) {
  VehicleLimits v = tracks();
  v.default_speed_mps = v.max_speed_mps = 1.0;
  v.yaw_rate_radps = 1.0;
  v.drive_power_w = 360.0;
  Waypoint hold = spot(10, 0);
  hold.hold_s = 5.0;

  const auto once = estimate(course({spot(0, 0), hold, spot(10, 10)}), v);
  EXPECT_NEAR(once.length_m.value(), 20.0, 0.01);
  EXPECT_NEAR(*once.time_s, 20.0 + 5.0 + 1.5708, 0.01);
  EXPECT_NEAR(*once.energy_wh, 21.5708 * 0.1, 0.01);

  const auto thrice = estimate(course({spot(0, 0), spot(10, 0), Jump{1, 2}}), v);
  EXPECT_NEAR(thrice.length_m.value(), 50.0, 0.01);
  EXPECT_FALSE(estimate(course({spot(0, 0), spot(10, 0), Jump{1, 0}}), v).time_s);
  EXPECT_FALSE(
      estimate(course({spot(0, 0), spot(10, 0), Jump{1, 10'000}, Jump{1, 10'000}}), v).time_s);

  // How far an item goes by sight nobody knows before; with its length it is told.
  for (const Item& item : {Item{Row{}}, Item{Wall{}}, Item{Landmarks{}}, Item{Dock{}}}) {
    const auto by_sight = estimate(course({spot(0, 0), spot(10, 0), item}), v);
    EXPECT_FALSE(by_sight.length_m) << type_name(item);
    EXPECT_FALSE(by_sight.time_s) << type_name(item);
    EXPECT_FALSE(by_sight.energy_wh) << type_name(item);
  }
  Row known;
  known.distance_m = 30.0;
  EXPECT_NEAR(estimate(course({spot(0, 0), spot(10, 0), known}), v).length_m.value(), 40.0, 0.01);

  Plan repeated = course({spot(0, 0), spot(10, 0)});
  repeated.settings.at_end = AtEnd::BackAndForth;
  EXPECT_FALSE(estimate(repeated, v).time_s);
  repeated.settings.times = 4;
  EXPECT_NEAR(estimate(repeated, v).length_m.value(), 40.0, 0.01);
}

}  // namespace
}  // namespace roverd::mission
