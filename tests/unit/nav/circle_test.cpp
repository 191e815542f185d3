// Circles and loiters of a mission, driven.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;
using mission::AtEnd;

mission::Circle circle(double east_m, double north_m, double radius_m, double turns = 1.0) {
  mission::Circle c;
  c.at = kFrame.to_global({east_m, north_m});
  c.radius_m = radius_m;
  c.turns = turns;
  return c;
}

mission::Loiter loiter(double east_m, double north_m, std::optional<double> seconds) {
  const auto at = kFrame.to_global({east_m, north_m});
  return {at.lat, at.lon, seconds, 1.0};
}

PathParams car() {
  PathParams p;
  p.vehicle.kinematics = "ackermann";
  p.vehicle.wheelbase_m = 1.5;
  p.vehicle.max_steering_deg = 25.0;
  return p;
}

/// How a ride goes round a place.
struct Around {
  EnuPoint centre;
  double radius_m = 0.0;
  double turned_rad = 0.0;  ///< left positive
  double worst_m = 0.0;     ///< off the circle, while on it
  double way_m = 0.0;
  double stood_s = 0.0;
  std::optional<EnuPoint> last{};

  void see(EnuPoint at, bool on) {
    const EnuPoint a = at - centre;
    if (last) {
      const EnuPoint b = *last - centre;
      if (on) {
        turned_rad += std::atan2(b.east_m * a.north_m - b.north_m * a.east_m,
                                 b.east_m * a.east_m + b.north_m * a.north_m);
      }
      const double step_m = base::distance_m(at, *last);
      way_m += step_m;
      if (step_m < 1e-9) stood_s += 0.02;
    }
    if (on) worst_m = std::max(worst_m, std::abs(std::hypot(a.east_m, a.north_m) - radius_m));
    last = at;
  }
};

Around drive(Ride& r, EnuPoint centre, double radius_m, double seconds) {
  Around a{centre, radius_m};
  for (int i = 0; i < seconds * 50.0 && r.executor.running(); ++i) {
    r.tick();
    const double far_m = base::distance_m(r.vehicle.at, centre);
    a.see(r.vehicle.at, far_m < radius_m + 0.05);
  }
  return a;
}

TEST(Circle, IsDrivenAsOneBendOfItsRadiusWithoutAStop) {
  for (const bool clockwise : {false, true}) {
    Ride r;
    mission::Circle c = circle(12, 0, 4.0, 2.25);
    c.clockwise = clockwise;
    r.load(plan({at(2, 0), c}));
    r.start();
    const Around a = drive(r, {12, 0}, 4.0, 150.0);
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
    EXPECT_NEAR(a.turned_rad, (clockwise ? -1.0 : 1.0) * 2.25 * 2.0 * base::kPi, 0.25);
    EXPECT_LT(a.worst_m, 0.06);
    EXPECT_NEAR(a.way_m, 2.0 + std::sqrt(84.0) + 18.0 * base::kPi, 0.5);
    EXPECT_EQ(r.reached, (std::vector<int>{1, 2}));
    EXPECT_TRUE(r.missed.empty());
  }
}

TEST(Circle, ThePathHasItsCurvatureAndLength) {
  PathParams p;
  const auto route = lay_route(plan({at(2, 0), circle(12, 0, 4.0, 3.0)}), kFrame, p);
  ASSERT_TRUE(route);
  const Path& path = route->forth.path;
  EXPECT_EQ(path.legs.size(), 1u);
  EXPECT_NEAR(path.length_m(), std::sqrt(84.0) + 24.0 * base::kPi, 0.02);
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const double s_m = path.points[i].s_m;
    const double expected = s_m < std::sqrt(84.0) - 0.01 ? 0.0 : 0.25;
    EXPECT_NEAR(path.points[i].curvature_1pm, expected, 1e-9) << s_m;
  }
}

TEST(Circle, TellsHowMuchOfItIsLeftWhileItIsDriven) {
  Ride r;
  r.load(plan({at(1, 0), circle(8, 0, 4.0, 2.0)}));
  r.start();
  drive(r, {8, 0}, 4.0, 20.0);
  const Progress p = r.executor.progress(r.vehicle.at);
  EXPECT_EQ(p.current_item, 2);
  const double whole_m = std::sqrt(33.0) + 16.0 * base::kPi;
  EXPECT_LT(p.distance_left_m.value(), whole_m - 5.0);
  EXPECT_GT(p.distance_left_m.value(), whole_m - 20.0);
  EXPECT_GT(p.eta_s.value(), 30.0);
}

// The end of two turns is where the circle was entered.
TEST(Circle, IsTheItemToWhichTheWayIsToldNotItsNextPiece) {
  Ride r;
  r.load(plan({at(1, 0), circle(8, 0, 4.0, 2.0), at(20, 0)}));
  r.start();
  while (r.executor.progress(r.vehicle.at).current_item != 2) r.tick();
  r.run(2.0);
  // From outside along the tangent, at its right side.
  const double aside_rad = std::acos(4.0 / 7.0);
  const EnuPoint end{8.0 - 4.0 * std::cos(aside_rad), -4.0 * std::sin(aside_rad)};
  double before_m = std::sqrt(33.0) + 16.0 * base::kPi;
  for (int i = 0; i < 20; ++i) {
    r.run(2.0);
    const Progress p = r.executor.progress(r.vehicle.at);
    ASSERT_EQ(p.current_item, 2);
    EXPECT_LT(base::distance_m(p.item_end.value(), end), 0.01);
    const double left_m = p.way_to_item_end_m.value();
    EXPECT_LT(left_m, before_m - 0.5) << "it always comes nearer";
    before_m = left_m;
    EXPECT_NEAR(p.distance_left_m.value() - left_m, base::distance_m(end, {20, 0}), 0.3);
  }
  // Paused it is told likewise; a place is told straight.
  r.executor.pause("test");
  EXPECT_NEAR(r.executor.progress(r.vehicle.at).way_to_item_end_m.value(), before_m, 1.2);
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  while (r.executor.progress(r.vehicle.at).current_item == 2) r.tick();
  const Progress last = r.executor.progress(r.vehicle.at);
  EXPECT_FALSE(last.way_to_item_end_m);
  EXPECT_LT(base::distance_m(last.item_end.value(), {20, 0}), 0.01);
}

TEST(Circle, ToldFromItsStationsIsStillAllOfIt) {
  Ride r;
  mission::Circle c = circle(8, 0, 2.0);
  c.stations = 4;
  c.hold_s = 3.0;
  r.load(plan({at(1, 0), c}));
  r.start();
  while (r.executor.progress(r.vehicle.at).current_item != 2) r.tick();
  double before_m = 1e9;
  while (r.executor.running()) {
    r.run(0.2);
    const Progress p = r.executor.progress(r.vehicle.at);
    if (!p.way_to_item_end_m) break;  // its last piece is told straight
    EXPECT_LT(*p.way_to_item_end_m, before_m + 0.5);
    before_m = std::min(before_m, *p.way_to_item_end_m);
  }
  EXPECT_LT(before_m, 0.8);
}

// Paused in the second of three turns, carried 1 m aside, restarted: what is left is driven, not
// the whole.
TEST(Circle, GoesOnInItsMiddleAfterAPauseAndAfterARestart) {
  for (const bool restart : {false, true}) {
    SCOPED_TRACE(restart);
    Ride r;
    r.load(plan({at(1, 0), circle(8, 0, 4.0, 3.0)}));
    r.start();
    const Around before = drive(r, {8, 0}, 4.0, 60.0);
    ASSERT_GT(before.turned_rad, 1.2 * 2.0 * base::kPi);
    ASSERT_LT(before.turned_rad, 2.6 * 2.0 * base::kPi);
    const double left_m = r.executor.progress(r.vehicle.at).distance_left_m.value();
    r.executor.pause("test");
    r.vehicle.speed_mps = r.vehicle.yaw_rate_radps = 0.0;
    const auto place = r.executor.place();
    ASSERT_TRUE(place);
    Ride later;
    later.vehicle = r.vehicle;
    later.vehicle.at.east_m += 0.4;
    if (restart) {
      const auto ok = later.executor.restore(
          later.route_of(plan({at(1, 0), circle(8, 0, 4.0, 3.0)})), *place, "restarted");
      ASSERT_TRUE(ok);
    }
    Ride& on = restart ? later : r;
    ASSERT_TRUE(on.executor.resume(on.vehicle.at));
    const Around after = drive(on, {8, 0}, 4.0, 150.0);
    EXPECT_EQ(on.executor.state(), ExecutionState::Finished);
    EXPECT_NEAR(after.way_m, left_m, 1.5);
    EXPECT_EQ(on.reached.back(), 2);
  }
}

TEST(Circle, IsJoinedWhereTheRobotStandsOnItAndCanBeSkipped) {
  Ride r;
  r.vehicle.at = {8, -4};  // a quarter round
  r.vehicle.yaw_rad = 0.0;
  r.load(plan({circle(8, 0, 4.0, 2.0), at(20, 0)}));
  r.start({StartAt::From::Nearest, 1});
  const Around a = drive(r, {8, 0}, 4.0, 30.0);
  EXPECT_LT(a.worst_m, 0.3) << "it does not drive to its north first";
  ASSERT_TRUE(r.executor.skip(2));
  ASSERT_TRUE(r.run(60.0));
  EXPECT_LT(base::distance_m(r.vehicle.at, {20, 0}), 0.1);
}

TEST(Circle, AtItsStationsItFacesTheCentreAndHolds) {
  Ride r;
  mission::Circle c = circle(10, 0, 4.0, 1.0);
  c.stations = 4;
  c.hold_s = 2.0;
  r.load(plan({at(1, 0), c}));
  r.start();
  std::vector<EnuPoint> stood;
  double still_s = 0.0;
  for (int i = 0; i < 200 * 50 && r.executor.running(); ++i) {
    r.tick();
    const bool still = r.vehicle.speed_mps == 0.0 && r.vehicle.yaw_rate_radps == 0.0;
    still_s = still ? still_s + 0.02 : 0.0;
    if (still_s < 1.5 || (!stood.empty() && base::distance_m(stood.back(), r.vehicle.at) < 1.0)) {
      continue;
    }
    const double to_centre = std::atan2(0.0 - r.vehicle.at.north_m, 10.0 - r.vehicle.at.east_m);
    if (std::abs(base::angle_diff_rad(r.vehicle.yaw_rad, to_centre)) < 0.06) {
      stood.push_back(r.vehicle.at);
    }
  }
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  ASSERT_EQ(stood.size(), 4u);
  for (const EnuPoint& at : stood) EXPECT_NEAR(base::distance_m(at, {10, 0}), 4.0, 0.1);
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2}));
}

TEST(Circle, BackAndForthTheOtherWayRound) {
  Ride r;
  r.load(plan({at(1, 0), circle(8, 0, 3.0, 1.0)}, AtEnd::BackAndForth));
  r.start();
  Around a{{8, 0}, 3.0};
  while (r.laps < 1) {
    r.tick();
    a.see(r.vehicle.at, base::distance_m(r.vehicle.at, {8, 0}) < 3.05);
  }
  EXPECT_NEAR(a.turned_rad, 2.0 * base::kPi, 0.3);
  while (r.laps < 2) {
    r.tick();
    a.see(r.vehicle.at, base::distance_m(r.vehicle.at, {8, 0}) < 3.05);
  }
  EXPECT_NEAR(a.turned_rad, 0.0, 0.4);
  EXPECT_LT(a.worst_m, 0.06);
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 2, 1}));
}

TEST(Circle, OfASteeredVehicleIsRefusedWhereItIsTooNarrow) {
  const double least_m = 1.1 * 1.5 / std::tan(base::rad_from_deg(25.0));
  const auto narrow = lay_route(plan({at(0, 0), circle(12, 0, least_m - 0.1)}), kFrame, car());
  ASSERT_FALSE(narrow);
  EXPECT_EQ(narrow.error().fields[0].detail,
            "is a circle too narrow for this vehicle: its radius must be at least 3.5 m");
  mission::Circle looks = circle(12, 0, 6.0);
  looks.stations = 2;
  EXPECT_FALSE(lay_route(plan({at(0, 0), looks}), kFrame, car()));
  // From outside, from inside and before anything else: no stop, no corner on it.
  for (const auto& items :
       {plan({at(0, 0), circle(12, 0, 6.0), at(30, 0)}),
        plan({at(12, 0), circle(12, 0, 6.0), at(30, 0)}), plan({circle(12, 0, 6.0), at(30, 0)})}) {
    const auto route = lay_route(items, kFrame, car());
    ASSERT_TRUE(route);
    EXPECT_EQ(route->forth.path.legs.size(), 1u);
    double bends = 0.0;
    for (const PathPoint& p : route->forth.path.points) {
      bends = std::max(bends, std::abs(p.curvature_1pm));
    }
    EXPECT_LE(bends, 1.0 / least_m + 1e-9);
  }
}

TEST(Loiter, StaysForItsTimeAndDrivesBackWhenItWasPushedAway) {
  Ride r;
  r.load(plan({at(1, 0), loiter(5, 0, 40.0), at(8, 0)}));
  r.start();
  for (int i = 0; i < 50 * 60 && r.executor.progress(r.vehicle.at).current_item != 2; ++i) r.tick();
  while (r.executor.progress(r.vehicle.at).current_item == 2 &&
         base::distance_m(r.vehicle.at, {5, 0}) > 0.06) {
    r.tick();
  }
  // It slides down to the south, centimetre for centimetre; at 1 m it comes back.
  double farthest_m = 0.0;
  double seconds = 0.0;
  bool came_back = false;
  while (r.executor.progress(r.vehicle.at).current_item == 2 && seconds < 100.0) {
    if (seconds > 2.0 && seconds < 15.0) r.vehicle.at.north_m -= 0.002;
    r.tick();
    seconds += 0.02;
    const double off_m = base::distance_m(r.vehicle.at, {5, 0});
    farthest_m = std::max(farthest_m, off_m);
    came_back = came_back || (farthest_m > 0.9 && off_m < 0.2);
  }
  EXPECT_GT(farthest_m, 1.0);
  EXPECT_LT(farthest_m, 1.4);
  EXPECT_TRUE(came_back);
  EXPECT_NEAR(seconds, 40.0, 3.0);
  ASSERT_TRUE(r.run(30.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3}));
  EXPECT_LT(base::distance_m(r.vehicle.at, {8, 0}), 0.1);
}

TEST(Loiter, TheNextItemIsDrivenToAndNotOnlySaidToBeReached) {
  Ride r;
  r.load(plan({at(3, 0), loiter(5, 0, 5.0), at(5, 6), at(0, 6)}));
  r.start();
  double nearest_m = 1e9;
  for (int i = 0; i < 50 * 120 && r.executor.running(); ++i) {
    r.tick();
    nearest_m = std::min(nearest_m, base::distance_m(r.vehicle.at, {5, 6}));
  }
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_LT(nearest_m, 0.6);
  EXPECT_LT(base::distance_m(r.vehicle.at, {0, 6}), 0.1);
}

TEST(Loiter, WithoutATimeGoesOnWhenSomebodySaysSo) {
  Ride r;
  mission::Loiter here;
  r.load(plan({at(3, 0), here, at(6, 0)}));
  r.start();
  ASSERT_FALSE(r.run(60.0));
  EXPECT_EQ(r.executor.progress(r.vehicle.at).current_item, 2);
  EXPECT_FALSE(r.executor.progress(r.vehicle.at).eta_s) << "nobody knows";
  EXPECT_TRUE(r.executor.waits_for_word());
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  ASSERT_TRUE(r.run(30.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3}));
}

TEST(Loiter, WithoutATimeIsSkippedAlsoAsTheLastItem) {
  Ride r;
  r.load(plan({at(3, 0), mission::Loiter{}}));
  r.start();
  ASSERT_FALSE(r.run(30.0));
  ASSERT_TRUE(r.executor.waits_for_word());
  ASSERT_TRUE(r.executor.skip(0));
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
}

TEST(Loiter, KeepsWhatIsLeftOfItsTimeOverAPauseAndARestart) {
  const auto p = plan({loiter(3, 0, 30.0), at(6, 0)});
  Ride r;
  r.load(p);
  r.start();
  while (r.executor.progress(r.vehicle.at).current_item == 1 &&
         base::distance_m(r.vehicle.at, {3, 0}) > 0.06) {
    r.tick();
  }
  r.run(12.0);
  r.executor.pause("test");
  const auto place = r.executor.place();
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->wait_s, 18.0, 2.0);
  Ride later;
  later.vehicle = r.vehicle;
  later.vehicle.speed_mps = 0.0;
  ASSERT_TRUE(later.executor.restore(later.route_of(p), *place, "restarted"));
  ASSERT_TRUE(later.executor.resume(later.vehicle.at));
  double seconds = 0.0;
  while (later.executor.progress(later.vehicle.at).current_item == 1 && seconds < 60.0) {
    later.tick();
    seconds += 0.02;
  }
  EXPECT_NEAR(seconds, place->wait_s, 0.1);
}

TEST(Circle, AJumpBehindTheLastPlaceEndsTheMission) {
  Ride r;
  r.load(plan({at(3, 0), mission::Jump{3, 1}, mission::Speed{0.4}}));
  r.start();
  ASSERT_TRUE(r.run(30.0));
  EXPECT_LT(base::distance_m(r.vehicle.at, {3, 0}), 0.1);
}

TEST(Circle, ThatHaveMorePlacesThanAMissionMayAreRefused) {
  mission::Circle c;
  c.at = kFrame.to_global({5, 0});
  c.radius_m = 0.5;
  c.turns = 1000.0;
  c.stations = 36;
  EXPECT_FALSE(lay_route(plan({c, c, c, c, c}), kFrame, {}));
  c.turns = 10.0;
  EXPECT_TRUE(lay_route(plan({c, c, c, c, c}), kFrame, {}));
}

}  // namespace
}  // namespace roverd::nav
