#include "mission/plan.hpp"

#include <gtest/gtest.h>

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

TEST(Plan, TypeNamesAreThoseOfThePublicInterface) {
  std::vector<std::string_view> names;
  for (const Item& item : plan_with_every_item().items) names.push_back(type_name(item));
  EXPECT_EQ(names, (std::vector<std::string_view>{
                       "waypoint",  "waypoint", "local",  "local",  "move",        "turn",
                       "turn",      "wait",     "speed",  "row",    "row",         "wall",
                       "landmarks", "dock",     "jump",   "action", "return_home", "loiter",
                       "loiter",    "circle",   "circle", "turn",   "map_point",   "map_point"}));
}

}  // namespace
}  // namespace roverd::mission
