#include "mission/plan.hpp"

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "base/tangent_plane.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

TEST(Plan, LengthIsTheSumOfTheLegsBetweenWaypoints) {
  //  B ─ C      A to B: 0.001 deg north, B to C: 0.001 deg east, at the equator
  //  │          (WGS84: 110.574 m and 111.320 m)
  //  A
  Plan plan;
  EXPECT_DOUBLE_EQ(length_m(plan), 0.0);
  plan.items = {waypoint_at(0.0, 10.0)};
  EXPECT_DOUBLE_EQ(length_m(plan), 0.0);
  plan.items = {Wait{1.0},
                waypoint_at(0.0, 10.0),
                Speed{1.0},
                waypoint_at(0.001, 10.0),
                waypoint_at(0.001, 10.001),
                ReturnHome{}};
  EXPECT_NEAR(length_m(plan), 110.574 + 111.320, 0.01);
}

TEST(Plan, PointsOfAMapAreAsFarApartAsTheyAreThere) {
  Plan plan;
  plan.frame = MissionMap{"shed"};
  plan.items = {MapPoint{.x_m = 1.0}, Wait{5.0}, MapPoint{.x_m = 4.0, .y_m = 4.0}};
  EXPECT_DOUBLE_EQ(length_m(plan), 5.0);
  // What lies between street and map nobody knows.
  Waypoint street;
  street.at = {58.0, 26.0};
  plan.items.insert(plan.items.begin() + 1, street);
  EXPECT_DOUBLE_EQ(length_m(plan), 0.0);
  plan.items.emplace_back(MapPoint{.x_m = 4.0, .y_m = 6.5});
  EXPECT_DOUBLE_EQ(length_m(plan), 2.5);
}

TEST(Plan, IsLaidOnTheEarthWhereItsMapLies) {
  // Given: a map whose x axis looks north.
  Plan plan;
  plan.frame = MissionMap{"shed"};
  plan.items = {MapPoint{.x_m = 10.0,
                         .y_m = 5.0,
                         .yaw_deg = 90.0,
                         .speed_mps = 0.4,
                         .radius_m = 0.2,
                         .hold_s = 3.0,
                         .reverse = true},
                Wait{1.0}};
  const LatLon origin{58.0, 26.0};
  // When
  const Plan laid = laid_on_earth(plan, {origin, base::kPi / 2.0});
  // Then
  EXPECT_FALSE(laid.frame);
  ASSERT_EQ(laid.items.size(), 2u);
  const auto& point = std::get<Waypoint>(laid.items[0]);
  const auto at = base::TangentPlane(origin).to_local(point.at);
  EXPECT_NEAR(at.north_m, 10.0, 1e-3);
  EXPECT_NEAR(at.east_m, -5.0, 1e-3);
  EXPECT_EQ(point.speed_mps, 0.4);
  EXPECT_EQ(point.radius_m, 0.2);
  EXPECT_EQ(point.hold_s, 3.0);
  EXPECT_TRUE(point.reverse);
  EXPECT_EQ(laid.items[1], plan.items[1]);
}

TEST(Plan, TypeNamesAreThoseOfThePublicInterface) {
  std::vector<std::string_view> names;
  for (const Item& item : plan_with_every_item().items) names.push_back(type_name(item));
  EXPECT_EQ(names,
            (std::vector<std::string_view>{
                "waypoint", "waypoint",  "local",       "local",  "move",     "turn",      "turn",
                "wait",     "speed",     "row",         "row",    "wall",     "landmarks", "dock",
                "jump",     "action",    "return_home", "loiter", "loiter",   "circle",    "circle",
                "turn",     "map_point", "map_point",   "wall",   "landmarks"}));
}

}  // namespace
}  // namespace roverd::mission
