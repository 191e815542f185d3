// What is told of a laid way: how fast, and where it stops and turns.

#include "nav/track/pace.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/behave/stops.hpp"

namespace roverd::nav {
namespace {

const base::LocalFrame kHere{1, {58.0, 26.0}};

mission::Waypoint to(double east_m, double north_m, double speed_mps = 1.0) {
  mission::Waypoint w;
  w.at = kHere.to_global({east_m, north_m});
  w.speed_mps = speed_mps;
  return w;
}

Course course_of(std::vector<mission::Item> items, const PathParams& params = {}) {
  mission::Plan plan;
  plan.items = std::move(items);
  auto route = lay_route(plan, kHere, params);
  EXPECT_TRUE(route) << route.error().detail;
  return std::move(route->forth);
}

std::vector<PacePoint> told(const Course& course, const PathParams& params = {},
                            PaceBounds bounds = {}) {
  std::vector<int> items;
  for (const RouteNode& node : course.nodes) items.push_back(node.item);
  return pace_of(course.path, items, params.speed, bounds);
}

double planned_at(const std::vector<PacePoint>& pace, double s_m) {
  for (std::size_t i = 1; i < pace.size(); ++i) {
    const PacePoint& a = pace[i - 1];
    const PacePoint& b = pace[i];
    if (b.s_m < s_m || b.s_m <= a.s_m) continue;
    const double share = (s_m - a.s_m) / (b.s_m - a.s_m);
    return std::sqrt(std::max(0.0, (1.0 - share) * a.planned_mps * a.planned_mps +
                                       share * b.planned_mps * b.planned_mps));
  }
  return 0.0;
}

//   1 m/s ╭────────╮          10 m: 1²/(2·0.7) m up, 1²/(2·0.6) m down
//   0 ────╯        ╰────
TEST(Pace, AStraightWayIsToldByTheFourPlacesOfItsTrapezoid) {
  const auto pace = told(course_of({to(0, 0), to(10, 0)}));
  ASSERT_EQ(pace.size(), 4u);
  EXPECT_EQ(pace[0].planned_mps, 0.0);
  EXPECT_NEAR(pace[1].s_m, 0.5 / 0.7, 1e-3);
  EXPECT_NEAR(pace[1].planned_mps, 1.0, 1e-6);
  EXPECT_NEAR(pace[1].at.east_m, 0.5 / 0.7, 1e-3);
  EXPECT_NEAR(pace[2].s_m, 10.0 - 0.5 / 0.6, 1e-3);
  EXPECT_NEAR(pace[3].s_m, 10.0, 1e-3);
  EXPECT_EQ(pace[3].planned_mps, 0.0);
  for (const PacePoint& p : pace) {
    EXPECT_EQ(p.set_mps, 1.0);
    EXPECT_EQ(p.item, 2);
    EXPECT_FALSE(p.reverse);
  }
}

TEST(Pace, AWayTooShortForItsSpeedPeaksBelowIt) {
  const auto pace = told(course_of({to(0, 0), to(0.5, 0)}));
  ASSERT_EQ(pace.size(), 3u);
  EXPECT_NEAR(pace[1].planned_mps, std::sqrt(2.0 * 0.5 * 0.7 * 0.6 / 1.3), 1e-3);
  EXPECT_EQ(pace[1].set_mps, 1.0);
}

TEST(Pace, EachItemsSpeedAndDirectionHoldOnTheWayToIt) {
  mission::Waypoint back = to(0, 0, 0.3);
  back.reverse = true;
  const auto pace = told(course_of({to(0, 0), to(10, 0, 0.8), to(20, 0, 0.5), back}));
  double set[5] = {};
  for (const PacePoint& p : pace) {
    if (p.s_m > 39.999) continue;
    set[p.item] = std::max(set[p.item], p.set_mps);
    EXPECT_EQ(p.reverse, p.item == 4) << p.s_m;
  }
  EXPECT_NEAR(set[2], 0.8, 1e-9);
  EXPECT_NEAR(set[3], 0.5, 1e-9);
  EXPECT_NEAR(set[4], 0.3, 1e-9);
  // Braked before the slower stretch, not in it; standing where it turns back.
  EXPECT_NEAR(planned_at(pace, 8.0), 0.8, 1e-6);
  EXPECT_NEAR(planned_at(pace, 10.0), 0.5, 0.01);
  EXPECT_NEAR(planned_at(pace, 9.8), std::sqrt(0.25 + 2.0 * 0.6 * 0.2), 0.02);
  EXPECT_NEAR(planned_at(pace, 20.0), 0.0, 1e-3);
}

TEST(Pace, ARoundedCornerIsSlowerThanTheWaysBesideIt) {
  mission::Waypoint corner = to(10, 0);
  corner.turn = mission::Turn::Arc;
  const Course course = course_of({to(0, 0), corner, to(10, 10)});
  const auto pace = told(course);
  const double middle_m = course.path.vertex_m[1];
  EXPECT_LT(planned_at(pace, middle_m), 0.9);
  EXPECT_GT(planned_at(pace, middle_m), 0.05);
  // The way itself says the same at each of its points.
  for (const PathPoint& p : course.path.points) {
    EXPECT_NEAR(planned_at(pace, p.s_m), p.plan_mps, 0.03) << p.s_m;
  }
}

TEST(Pace, ALongWayStaysWithinItsBound) {
  std::vector<mission::Item> items;
  for (int i = 0; i < 6'000; ++i) {
    auto w = to(0.4 * i, i % 2 == 0 ? 0.0 : 1.0, i % 3 == 0 ? 0.4 : 0.9);
    w.turn = mission::Turn::Pivot;
    items.push_back(w);
  }
  const Course course = course_of(std::move(items));
  const auto pace = told(course);
  ASSERT_LE(pace.size(), 5'000u);
  ASSERT_GE(pace.size(), 2u);
  EXPECT_TRUE(std::is_sorted(pace.begin(), pace.end(),
                             [](const auto& a, const auto& b) { return a.s_m < b.s_m; }));
  const CourseStops found = stops_of(course, 5'000);
  std::size_t counted = 0;
  for (const CourseStop& stop : found.stops) counted += 1 + stop.turns.size();
  EXPECT_EQ(counted, 5'000u);
  // 6,000 stops, a turn at each but the last.
  EXPECT_EQ(found.left_out, 11'999u - 5'000u);
}

TEST(Pace, AWayWithoutPlacesHasNone) {
  EXPECT_TRUE(pace_of({}, {}, {}, {}).empty());
  EXPECT_TRUE(stops_of({}, 100).stops.empty());
}

//   2 ──┐ 3        at 2 to the right by 90°
//   ▲   ▼
//   1   4          begins to the north
TEST(Stops, ATrackedVehicleTurnsAtItsCornersOnTheSpot) {
  mission::Waypoint corner = to(0, 10);
  corner.turn = mission::Turn::Pivot;
  const CourseStops found = stops_of(course_of({to(0, 0), corner, to(10, 10)}), 100);
  ASSERT_EQ(found.stops.size(), 3u);
  EXPECT_EQ(found.left_out, 0u);
  const CourseStop& begin = found.stops[0];
  EXPECT_EQ(begin.item, 1);
  ASSERT_EQ(begin.turns.size(), 1u);
  EXPECT_FALSE(begin.turns[0].from_yaw_rad);
  EXPECT_NEAR(begin.turns[0].to_yaw_rad, base::kPi / 2.0, 1e-6);
  EXPECT_NEAR(begin.turns[0].above_rad, base::rad_from_deg(PathParams{}.pivot.angle_deg), 1e-9);
  const CourseStop& turned = found.stops[1];
  EXPECT_EQ(turned.item, 2);
  EXPECT_NEAR(turned.s_m, 10.0, 1e-3);
  EXPECT_NEAR(turned.at.north_m, 10.0, 1e-3);
  ASSERT_EQ(turned.turns.size(), 1u);
  EXPECT_NEAR(turned.turns[0].by_rad, -base::kPi / 2.0, 1e-6);
  EXPECT_NEAR(turned.turns[0].to_yaw_rad, 0.0, 1e-6);
  EXPECT_EQ(found.stops[2].item, 3);
  EXPECT_TRUE(found.stops[2].turns.empty());
}

TEST(Stops, ASteeredVehicleTurnsNowhere) {
  PathParams car;
  car.vehicle.kinematics = "ackermann";
  const CourseStops found =
      stops_of(course_of({to(0, 0), to(0, 20), to(20, 20), to(20, 60)}, car), 100);
  ASSERT_FALSE(found.stops.empty());
  for (const CourseStop& stop : found.stops) EXPECT_TRUE(stop.turns.empty()) << stop.s_m;
}

TEST(Stops, AWayDrivenBackwardsIsComeToWithoutATurn) {
  mission::Waypoint back = to(0, 0);
  back.reverse = true;
  const CourseStops found = stops_of(course_of({to(0, 0), to(0, 10), back}), 100);
  ASSERT_EQ(found.stops.size(), 3u);
  EXPECT_TRUE(found.stops[1].turns.empty());
}

TEST(Stops, ItemsThatTurnAreTurnsAndOneMayTurnMoreThanRound) {
  mission::TurnBy round;
  round.turn_deg = 450.0;
  const CourseStops found = stops_of(course_of({to(0, 0), to(0, 10), round, to(10, 10)}), 100);
  ASSERT_EQ(found.stops.size(), 3u);
  // East already: nothing is left to turn before it goes on.
  ASSERT_EQ(found.stops[1].turns.size(), 1u);
  EXPECT_NEAR(found.stops[1].turns[0].by_rad, -2.5 * base::kPi, 1e-6);
  EXPECT_NEAR(found.stops[1].turns[0].to_yaw_rad, 0.0, 1e-6);
}

//      ╭─╮   from inside it drives straight out to the circle, and turns onto it
//      │2│
//      ╰┬╯3
//       1
TEST(Stops, ACircleThatIsBegunFromInsideIsTurnedOntoAndItsStationsToItsCentre) {
  mission::Circle c;
  c.at = kHere.to_global({0, 20});
  c.radius_m = 5.0;
  c.stations = 2;
  const CourseStops found = stops_of(course_of({to(0, 0), to(0, 18), c}), 100);
  // Begin, inside, edge, two stations.
  ASSERT_EQ(found.stops.size(), 5u);
  EXPECT_NEAR(found.stops[2].at.north_m, 15.0, 0.01);
  EXPECT_EQ(found.stops[2].item, 3);
  ASSERT_EQ(found.stops[2].turns.size(), 1u);
  EXPECT_NEAR(std::abs(found.stops[2].turns[0].by_rad), base::kPi / 2.0, 0.15);
  // At the first station to the centre, and back to the way.
  EXPECT_NEAR(found.stops[3].at.north_m, 25.0, 0.01);
  ASSERT_EQ(found.stops[3].turns.size(), 2u);
  EXPECT_NEAR(found.stops[3].turns[0].to_yaw_rad, -base::kPi / 2.0, 1e-3);
  EXPECT_NEAR(found.stops[3].turns[1].by_rad, -found.stops[3].turns[0].by_rad, 0.3);
  EXPECT_EQ(found.stops[4].turns.size(), 1u);
}

TEST(Stops, BehindAWayThatNobodyKnowsNoTurnIsMadeUp) {
  mission::Move move;
  move.forward_m = 3.0;
  const CourseStops found =
      stops_of(course_of({to(0, 0), to(0, 10), move, to(10, 10), to(10, 0)}), 100);
  ASSERT_EQ(found.stops.size(), 4u);
  EXPECT_TRUE(found.stops[1].turns.empty());
  ASSERT_EQ(found.stops[2].turns.size(), 1u);
  EXPECT_FALSE(found.stops[2].turns[0].from_yaw_rad);
  EXPECT_NEAR(found.stops[2].turns[0].to_yaw_rad, -base::kPi / 2.0, 1e-6);
}

}  // namespace
}  // namespace roverd::nav
