// Circles and loiters of a mission: where they lie, what speaks against them, what edits and files
// make of them.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "mission/checks.hpp"
#include "mission/circle.hpp"
#include "mission/edit/compare.hpp"
#include "mission/edit/operations.hpp"
#include "mission/formats/formats.hpp"

namespace roverd::mission {
namespace {

const base::LocalFrame kGround(1, {58.0, 26.0});

Waypoint spot(double east_m, double north_m) {
  Waypoint waypoint;
  waypoint.at = kGround.to_global({east_m, north_m});
  return waypoint;
}

Circle circle(double east_m, double north_m, double radius_m, double turns = 1.0) {
  Circle c;
  c.at = kGround.to_global({east_m, north_m});
  c.radius_m = radius_m;
  c.turns = turns;
  return c;
}

Loiter loiter(double east_m, double north_m, std::optional<double> seconds) {
  const LatLon at = kGround.to_global({east_m, north_m});
  return {at.lat, at.lon, seconds, {}};
}

Plan course(std::vector<Item> items) {
  Plan plan;
  plan.name = "course";
  plan.items = std::move(items);
  return plan;
}

VehicleLimits tracks() {
  VehicleLimits limits;
  limits.item_types = {"waypoint", "loiter", "circle"};
  return limits;
}

std::vector<std::string> found(const Plan& plan, const VehicleLimits& vehicle,
                               const Surroundings& around = {}) {
  std::vector<std::string> out;
  for (const Finding& f : check(plan, vehicle, around).findings) {
    out.push_back(f.code + "@" + std::to_string(f.item.value_or(0)));
  }
  return out;
}
using Codes = std::vector<std::string>;

double far_m(LatLon a, LatLon b) {
  return base::distance_bearing(a, b).distance_m;
}

// From the south both ways round: the straight meets the circle at a right angle to its radius.
TEST(Rounds, CountInTheLengthOfTheWay) {
  EXPECT_NEAR(length_m(course({spot(0, 0), circle(5, 0, 3, 2), spot(10, 0)})),
              4.0 + 12.0 * base::kPi + 4.0, 4.0);  // where it is left, the plan does not tell
  EXPECT_NEAR(length_m(course({spot(0, 0), circle(5, 0, 3, 2)})), 4.0 + 12.0 * base::kPi, 0.01);
  EXPECT_NEAR(length_m(course({spot(0, 0), loiter(0, 7, 3.0), mission::Loiter{}, spot(0, 9)})), 9.0,
              0.01);
}

TEST(Circles, AreEnteredAlongTheTangentOfTheirDirection) {
  for (const bool clockwise : {false, true}) {
    Circle c = circle(0, 0, 5.0);
    c.clockwise = clockwise;
    const EnuPoint from{0.0, -13.0};
    const CircleWay way = circle_way(c, {0, 0}, from);
    ASSERT_TRUE(way.tangent);
    const EnuPoint in = way.entry() - from;
    const EnuPoint on = way.entry();
    EXPECT_NEAR(std::hypot(on.east_m, on.north_m), 5.0, 1e-9);
    EXPECT_NEAR(in.east_m * on.east_m + in.north_m * on.north_m, 0.0, 1e-9);
    EXPECT_NEAR(std::hypot(in.east_m, in.north_m), 12.0, 1e-9);
    // Driven on, it goes the same way: clockwise it came by the west.
    EXPECT_LT(clockwise ? on.east_m : -on.east_m, 0.0);
    const EnuPoint next = way.at(way.sweep_rad * 0.01) - on;
    EXPECT_GT(next.east_m * in.east_m + next.north_m * in.north_m, 0.0);
  }
}

TEST(Circles, FromInsideTheNearestPlaceIsTheEntryAndFromNowhereTheNorth) {
  const Circle c = circle(0, 0, 5.0);
  const CircleWay inside = circle_way(c, {0, 0}, EnuPoint{-2.0, 0.0});
  EXPECT_FALSE(inside.tangent);
  EXPECT_NEAR(inside.entry().east_m, -5.0, 1e-9);
  EXPECT_NEAR(circle_way(c, {0, 0}, std::nullopt).entry().north_m, 5.0, 1e-9);
  EXPECT_NEAR(circle_way(c, {0, 0}, EnuPoint{0, 0}).entry().north_m, 5.0, 1e-9);
}

TEST(Circles, OfACarMustNotBeNarrowerThanItTurnsNorHaveStations) {
  VehicleLimits car = tracks();
  car.turn_radius_m = 3.9;
  const Plan narrow = course({spot(0, 0), circle(20, 0, 3.0)});
  EXPECT_EQ(found(narrow, car), Codes{"turn_too_tight@2"});
  EXPECT_EQ(sentence(check(narrow, car, {}).findings.front()),
            "item 2 is a circle with a radius of 3.0 m; this vehicle's turning radius is 3.9 m");
  EXPECT_EQ(found(narrow, tracks()), Codes{});
  Circle looks = circle(20, 0, 6.0);
  EXPECT_EQ(found(course({spot(0, 0), looks}), car), Codes{});
  looks.stations = 4;
  EXPECT_EQ(found(course({spot(0, 0), looks}), car), Codes{"turn_too_tight@2"});
  EXPECT_EQ(found(course({spot(0, 0), looks}), tracks()), Codes{});
}

/// A square fence of 20 m; the circle bulges out of its east side, though entry, end and centre lie
/// inside.
TEST(Circles, AllOfTheWayRoundMustLieInsideTheFence) {
  Fence fence;
  FencePolygon yard;
  for (const EnuPoint p : {EnuPoint{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}) {
    yard.points.push_back(kGround.to_global(p));
  }
  fence.areas.push_back({AreaKind::Inclusion, yard});
  const Surroundings around{.vehicle = {}, .fence = &fence};
  EXPECT_EQ(found(course({spot(-8, 0), circle(0, 0, 5)}), tracks(), around), Codes{});
  EXPECT_EQ(found(course({spot(-8, 0), circle(7, 0, 5)}), tracks(), around),
            Codes{"outside_fence@2"});
  EXPECT_EQ(found(course({spot(-8, 0), circle(4.8, 0, 5)}), tracks(), around),
            Codes{"near_fence@2"});
  // A quarter of it, in the west, stays inside.
  Circle quarter = circle(7, 0, 5, 0.25);
  quarter.clockwise = true;
  EXPECT_EQ(found(course({spot(2, -8), quarter}), tracks(), around), Codes{});
}

TEST(Circles, CountWithTheirWholeLengthAndLoitersWithTheirTime) {
  VehicleLimits v = tracks();
  v.max_speed_mps = 1.0;
  v.default_speed_mps = 1.0;
  const Estimate round = estimate(course({spot(0, -13), circle(0, 0, 5, 2.5)}), v);
  EXPECT_NEAR(round.length_m.value(), 12.0 + 2.5 * 10.0 * base::kPi, 0.01);
  EXPECT_NEAR(round.time_s.value(), round.length_m.value(), 0.01);
  const Estimate stays = estimate(course({spot(0, 0), loiter(10, 0, 30.0)}), v);
  EXPECT_NEAR(stays.time_s.value(), 40.0, 0.01);
  EXPECT_FALSE(estimate(course({spot(0, 0), loiter(10, 0, {})}), v).time_s)
      << "until somebody says to go on";
}

TEST(Circles, AreMovedScaledMirroredAndDrivenTheOtherWayRound) {
  const Plan plan = course({spot(0, 0), circle(10, 0, 4), loiter(20, 0, 5.0)});
  const auto circle_of = [](const base::Result<Done>& done) {
    return std::get<Circle>(done->plan.items[1]);
  };
  const auto moved = perform(plan, Offset{{3.0, 4.0}, {}});
  ASSERT_TRUE(moved);
  EXPECT_NEAR(far_m(circle_of(moved).at, kGround.to_global({13, 4})), 0.0, 1e-3);
  EXPECT_NEAR(far_m(*place_of(moved->plan.items[2]), kGround.to_global({23, 4})), 0.0, 1e-3);
  const auto scaled = perform(plan, ScaleRotate{2.0, 0.0, kGround.to_global({0, 0})});
  ASSERT_TRUE(scaled);
  EXPECT_DOUBLE_EQ(circle_of(scaled).radius_m, 8.0);
  EXPECT_NEAR(far_m(circle_of(scaled).at, kGround.to_global({20, 0})), 0.0, 1e-3);
  const auto mirrored = perform(plan, Mirror{0.0, kGround.to_global({0, 0})});
  ASSERT_TRUE(mirrored);
  EXPECT_TRUE(circle_of(mirrored).clockwise);
  EXPECT_NEAR(far_m(circle_of(mirrored).at, kGround.to_global({-10, 0})), 0.0, 1e-3);
  const auto reversed = perform(plan, Reverse{});
  ASSERT_TRUE(reversed);
  EXPECT_TRUE(circle_of(reversed).clockwise);
  const Differences d = compare(plan, moved->plan);
  EXPECT_EQ(d.changed, 3u);
  EXPECT_NEAR(d.items[1].moved_m.value(), 5.0, 1e-3);
}

Plan through(const Plan& plan, Format format) {
  const ExportedFile written = export_file(plan, format);
  auto read = import_file(written.content, format);
  EXPECT_TRUE(read) << read.error().detail;
  return read ? read->plan : Plan{};
}

TEST(Circles, GoThroughMissionCommandsAsTheyAre) {
  Circle right = circle(10, 0, 4, 2.5);
  right.clockwise = true;
  const Loiter stays{58.0001, 26.0002, 12.0, 2.5};
  const Loiter forever{58.0002, 26.0002, {}, {}};
  const Plan plan = course({spot(0, 0), right, circle(30, 0, 6, 0.5), stays, forever});
  for (const Format format : {Format::Plan, Format::Waypoints}) {
    EXPECT_EQ(through(plan, format).items, plan.items) << to_string(format);
  }
}

TEST(Circles, OfAnOrbitCommandHaveItsSpeedAndWayRound) {
  const std::string text =
      "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t58\t26\t0\t1\n"
      "1\t0\t3\t34\t-20\t0.7\t3\t4.71238898\t58.001\t26.001\t0\t1\n"
      "2\t0\t3\t18\t3\t0\t0\t0\t58.002\t26.001\t0\t1\n";
  const auto read = import_file(text, Format::Waypoints);
  ASSERT_TRUE(read) << read.error().detail;
  ASSERT_EQ(read->plan.items.size(), 2u);
  const auto& orbit = std::get<Circle>(read->plan.items[0]);
  EXPECT_FALSE(orbit.clockwise);
  EXPECT_DOUBLE_EQ(orbit.radius_m, 20.0);
  EXPECT_NEAR(orbit.turns.value(), 0.75, 1e-6);
  EXPECT_DOUBLE_EQ(orbit.speed_mps.value(), 0.7);
  // Turns around a place without a radius: there is nothing to circle on.
  EXPECT_TRUE(std::holds_alternative<Waypoint>(read->plan.items[1]));
}

TEST(Circles, AreWrittenAsPointsOfTheirWayWhereAFormatHoldsPositionsOnly) {
  const Plan plan = course({spot(0, -13), circle(0, 0, 5, 0.5), loiter(8, 0, 5.0)});
  for (const Format format : {Format::Gpx, Format::Kml, Format::Csv, Format::GeoJson}) {
    const Plan back = through(plan, format);
    ASSERT_EQ(back.items.size(), 1u + 19u + 1u) << to_string(format);
    for (std::size_t i = 1; i <= 19; ++i) {
      const LatLon at = std::get<Waypoint>(back.items[i]).at;
      EXPECT_NEAR(far_m(at, kGround.to_global({0, 0})), 5.0, 0.01);
    }
    EXPECT_NEAR(far_m(std::get<Waypoint>(back.items.back()).at, kGround.to_global({8, 0})), 0.0,
                0.01);
  }
}

}  // namespace
}  // namespace roverd::mission
