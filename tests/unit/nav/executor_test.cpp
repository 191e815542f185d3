#include "nav/behave/executor.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;
using mission::AtEnd;
using mission::Plan;

TEST(Route, NamesEveryItemThatThisRobotCannotDoYet) {
  const mission::Landmarks upon{.name = "any", .offset_m = 0.0};
  const auto r = lay_route(plan({at(1, 1), upon, at(2, 2), upon}), kFrame, {});
  ASSERT_FALSE(r);
  ASSERT_EQ(r.error().fields.size(), 2u);
  EXPECT_EQ(r.error().fields[0].pointer, "/items/1");
  EXPECT_EQ(r.error().fields[0].detail,
            "passes landmarks at 0.0 m: this vehicle would drive over them");
  EXPECT_EQ(r.error().fields[1].pointer, "/items/3");
}

TEST(Route, TheOffsetFromALandmarkLeavesRoomForItsThickness) {
  PathParams wide;
  wide.vehicle.width_m = 0.78;
  mission::Landmarks l;
  for (const double offset_m : {0.45, -0.45, 0.63}) {
    l.offset_m = offset_m;
    EXPECT_FALSE(lay_route(plan({l}), kFrame, wide)) << offset_m;
  }
  l.offset_m = -0.7;
  EXPECT_TRUE(lay_route(plan({l}), kFrame, wide));
}

TEST(Route, RowsAndWallsThatAreNearerThanHalfTheVehicleAreRefused) {
  PathParams wide;
  wide.vehicle.width_m = 0.78;
  mission::Row row;
  row.side = mission::RowSide::Left;
  row.gap_m = 0.2;
  const auto over = lay_route(plan({row}), kFrame, wide);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().fields[0].detail,
            "is driven 0.2 m beside its plants: this vehicle would drive over them");
  row.gap_m = 0.5;
  EXPECT_TRUE(lay_route(plan({row}), kFrame, wide));
  row = {};
  row.gap_m = 0.2;  // of no meaning between two sides
  EXPECT_TRUE(lay_route(plan({row}), kFrame, wide));
  mission::Wall wall;
  wall.distance_m = 0.1;
  const auto into = lay_route(plan({wall}), kFrame, wide);
  ASSERT_FALSE(into);
  EXPECT_EQ(into.error().fields[0].detail,
            "is driven 0.1 m from its wall: this vehicle would touch it");
  wall.distance_m = 0.6;
  EXPECT_TRUE(lay_route(plan({wall}), kFrame, wide));
}

TEST(Route, RefusesPlacesOutOfReachAndJumpsToNowhere) {
  const auto far = lay_route(plan({at(1, 1), far_away()}), kFrame, {});
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().fields[0].pointer, "/items/1");
  const auto jump = lay_route(plan({at(1, 1), mission::Jump{9, 1}}), kFrame, {});
  ASSERT_FALSE(jump);
  EXPECT_EQ(jump.error().fields[0].detail, "jumps to item 9 of 2");
  EXPECT_FALSE(lay_route(plan({}), kFrame, {}));
  EXPECT_FALSE(lay_route(plan({mission::Wait{1.0}}), kFrame, {}));
}

TEST(Executor, DrivesAllItemsInOrderAndFinishes) {
  Ride r;
  r.load(plan({at(4, 0), mission::Wait{1.0}, mission::Speed{0.4}, at(4, 4), at(4, 4), at(0, 4)}));
  EXPECT_EQ(r.executor.state(), ExecutionState::Loaded);
  r.start();
  ASSERT_TRUE(r.run(90.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 4, 5, 6}));
  EXPECT_LT(base::distance_m(r.vehicle.at, {0, 4}), 0.1);
}

TEST(Executor, StartsAtTheNearestOrAtAGivenItem) {
  const Plan p = plan({at(4, 0), at(8, 0), at(12, 0)});
  Ride nearest;
  nearest.vehicle.at = {7, 1};
  nearest.load(p);
  nearest.start({StartAt::From::Nearest, 1});
  ASSERT_TRUE(nearest.run(60.0));
  EXPECT_EQ(nearest.reached, (std::vector<int>{2, 3}));
  Ride third;
  third.load(p);
  third.start({StartAt::From::Item, 3});
  ASSERT_TRUE(third.run(60.0));
  EXPECT_EQ(third.reached, (std::vector<int>{3}));
  Ride none;
  none.load(p);
  EXPECT_FALSE(none.executor.start({StartAt::From::Item, 4}, {}, {}));
  EXPECT_FALSE(none.executor.start({StartAt::From::Item, 0}, {}, {}));
}

// It stands, as far as it knows. @return how long until that blocks the mission
double gives_up_after_s(double yaw_sigma_rad) {
  Ride r;
  r.vehicle.yaw_sigma_rad = yaw_sigma_rad;
  r.load(plan({at(4, 0), at(8, 0)}));
  r.start();
  int ticks = 0;
  while (r.executor.state() == ExecutionState::Running && ticks < 5000) {
    (void)r.executor.step(r.vehicle, 10.0, r.home, 0.02);
    ++ticks;
  }
  return 0.02 * ticks;
}

TEST(Executor, WithoutProgressItIsBlockedAndLaterWhileItLooksForItsHeading) {
  EXPECT_NEAR(gives_up_after_s(0.02), 10.0, 1.0);
  EXPECT_NEAR(gives_up_after_s(1.5), 30.0, 2.0);
}

TEST(Executor, RefusesAFirstPointThatIsTooFarAway) {
  Ride r;
  r.vehicle.at = {0, -60};
  r.load(plan({at(0, 0)}));
  const auto refused = r.executor.start({}, r.vehicle.at, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  EXPECT_NE(refused.error().detail.find("60 m"), std::string::npos);
  EXPECT_EQ(r.executor.state(), ExecutionState::Loaded);
}

// Start and goal are the same place: it is driven to the far point first.
TEST(Executor, AClosedLoopIsNotFinishedAtItsStart) {
  Ride r;
  r.load(plan({at(0, 0), at(5, 0), at(5, 5), at(0, 0)}));
  r.start();
  r.tick();
  EXPECT_TRUE(r.executor.running());
  ASSERT_TRUE(r.run(120.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3, 4}));
}

TEST(Executor, AMissionOnTheSpotFinishesAtOnceEvenIfItRepeats) {
  for (const AtEnd at_end : {AtEnd::Hold, AtEnd::Repeat, AtEnd::BackAndForth, AtEnd::Return}) {
    Ride r;
    r.load(plan({at(0, 0)}, at_end));
    r.start();
    ASSERT_TRUE(r.run(5.0));
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  }
}

// Who only stood saw the row all the time.
TEST(Executor, LooksForARowAnewAfterSomebodyElseDroveAndNotAfterAWait) {
  Ride r;
  r.load(plan({mission::Row{}}));
  r.start();
  r.executor.see_row(RowSight{});
  r.tick();
  ASSERT_TRUE(r.executor.row_wanted());
  const std::uint64_t first = r.executor.row_wanted()->id;
  r.executor.wait();
  EXPECT_EQ(r.executor.row_wanted()->id, first);
  r.executor.go_on(r.vehicle.at);
  EXPECT_EQ(r.executor.row_wanted()->id, first);
  r.executor.interrupt();
  r.executor.wait();
  r.executor.go_on(r.vehicle.at);
  const std::uint64_t second = r.executor.row_wanted()->id;
  EXPECT_NE(second, first);
  r.executor.pause("a word");
  EXPECT_FALSE(r.executor.row_wanted());
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  EXPECT_NE(r.executor.row_wanted()->id, second);
}

// What follows leads through plants.
TEST(Executor, StopsInARowThatIsNotFoundWhateverUnreachableSays) {
  for (const char* rule : {"stop", "skip", "return"}) {
    Ride r;
    r.behave.unreachable = rule;
    r.executor = Executor{r.path, r.behave};
    r.load(plan({mission::Row{}, at(4, 0)}));
    r.start();
    r.executor.see_row(RowSight{});
    r.tick();
    RowSight sight;
    for (int i = 0; i < 1500 && r.executor.running(); ++i) {
      sight.body = sight.body * rows::Pose2{r.vehicle.speed_mps * 0.02, 0.0, 0.0};
      r.executor.see_row(sight);
      r.tick();
    }
    EXPECT_EQ(r.executor.state(), ExecutionState::Blocked) << rule;
    EXPECT_EQ(r.executor.reason(), "item 1: no row is seen within 3.0 m");
    EXPECT_TRUE(r.missed.empty());
  }
}

// Between two rows neither place nor heading counts; a long move, a compass turn and places do.
TEST(Executor, AsksForNoPlaceInARowAndOnTheFewMetresBetweenRows) {
  const auto asks_none = [](const std::vector<mission::Item>& items, int item) {
    Ride r;
    r.load(plan(items));
    r.start({StartAt::From::Item, item});
    return r.executor.asks_no_place();
  };
  const mission::Row row;
  const mission::TurnBy right{90.0, std::nullopt};
  const mission::TurnBy north{std::nullopt, 0.0};
  const std::vector<mission::Item> block{
      row, mission::Move{1.5}, right, mission::Move{2.5}, right, row, mission::Move{1.5}, at(0, 0)};
  for (int item = 1; item <= 7; ++item) EXPECT_TRUE(asks_none(block, item)) << item;
  EXPECT_FALSE(asks_none(block, 8));
  const std::vector<mission::Item> waits{mission::Wait{1.0}, row,     mission::Wait{10.0}, right,
                                         mission::Move{2.5}, row,     mission::Wait{1.0},  at(0, 0),
                                         mission::Wait{1.0}, at(1, 0)};
  for (int item = 1; item <= 7; ++item) EXPECT_TRUE(asks_none(waits, item)) << item;
  EXPECT_FALSE(asks_none(waits, 9));
  EXPECT_FALSE(asks_none({row, mission::Move{15.0}, right, mission::Move{15.1}, row}, 2));
  EXPECT_FALSE(asks_none({row, mission::Move{1.5}, north, row}, 3));
  EXPECT_FALSE(asks_none({at(0, 0), mission::Move{1.5}, right, at(5, 5)}, 2));
}

// The estimate jumps by a metre and 10 degrees while it turns and moves towards the next row.
TEST(Executor, MovesBetweenRowsByOdometryAlone) {
  Ride r;
  r.load(plan({mission::Move{2.0}, mission::TurnBy{-90.0, std::nullopt}, mission::Move{2.0},
               mission::Row{}}));
  r.start();
  rows::Pose2 body;  // the truth, and the odometry
  for (int i = 0; i < 3000 && r.reached.size() < 3; ++i) {
    RowSight sight;
    sight.body = body;
    r.executor.see_row(sight);
    r.tick();
    body = body * sense::along(r.vehicle.speed_mps * 0.02, r.vehicle.yaw_rate_radps * 0.02, 1.0);
    if (i % 40 == 39) {
      r.vehicle.at.north_m += i % 80 == 39 ? 1.0 : -1.0;
      r.vehicle.yaw_rad += i % 80 == 39 ? 0.17 : -0.17;
    }
  }
  ASSERT_EQ(r.reached.size(), 3u);
  EXPECT_NEAR(body.x_m, 2.0, 0.1);
  EXPECT_NEAR(body.y_m, 2.0, 0.1);
  EXPECT_NEAR(body.yaw_rad, base::kPi / 2.0, 0.05);
}

// It stands before a passer-by, and the estimate shifts by a metre meanwhile.
TEST(Executor, GoesOnWithAMoveBetweenRowsByOdometryToo) {
  for (const bool said : {false, true}) {
    Ride r;
    r.load(plan({mission::Move{4.0}, mission::Row{}}));
    r.start();
    RowSight sight;
    for (int i = 0; i < 3000 && r.reached.empty(); ++i) {
      if (i == 150) {
        EXPECT_GT(sight.body.x_m, 0.5);
        EXPECT_FALSE(r.executor.ahead(r.vehicle.at, 5.0)) << "no way around is looked for";
        r.vehicle.at.north_m += 1.0;
        said ? r.executor.pause("a word") : r.executor.wait();
        r.vehicle.speed_mps = 0.0;
        if (said) {
          ASSERT_TRUE(r.executor.resume(r.vehicle.at));
        }
        r.executor.go_on(r.vehicle.at);
      }
      r.executor.see_row(sight);
      r.tick();
      sight.body = sight.body *
                   sense::along(r.vehicle.speed_mps * 0.02, r.vehicle.yaw_rate_radps * 0.02, 1.0);
      EXPECT_NEAR(sight.body.y_m, 0.0, 0.02);
    }
    EXPECT_EQ(r.reached.size(), 1u);
    EXPECT_NEAR(sight.body.x_m, 4.0, 0.1);
  }
}

TEST(Executor, StandsOnlyWhileItWaits) {
  Ride r;
  r.load(plan({mission::Wait{2.0}, at(5, 0)}));
  EXPECT_FALSE(r.executor.stands(r.vehicle, 0.02));
  r.start();
  double stood_s = 0.0;
  for (; r.executor.stands(r.vehicle, 0.02); stood_s += 0.02) {
    r.tick();
    EXPECT_EQ(r.vehicle.speed_mps, 0.0);
  }
  EXPECT_NEAR(stood_s, 2.0, 0.05);
  r.tick();
  r.tick();
  EXPECT_FALSE(r.executor.stands(r.vehicle, 0.02));
}

// What follows a wall lies who knows where, as what follows a row.
TEST(Executor, StartsAlongAWallHoweverFarTheNextPlaceIs) {
  mission::Wall wall;
  wall.distance_m = 0.9;
  for (const mission::Item& first : {mission::Item{wall}, mission::Item{mission::Row{}}}) {
    Ride r;
    r.load(plan({first, at(2000, 0)}));
    EXPECT_TRUE(r.executor.start({}, r.vehicle.at, r.home));
  }
}

TEST(Executor, TellsTheWayThatIsLeftOnlyWhereItIsKnown) {
  Ride r;
  EXPECT_FALSE(r.executor.progress(EnuPoint{}).current_item);
  r.load(plan({at(10, 0)}));
  // Loaded: no item is in hand, and the way leads from here to the waypoint.
  const Progress before = r.executor.progress(r.vehicle.at);
  EXPECT_FALSE(before.current_item);
  EXPECT_NEAR(before.distance_left_m.value(), 10.0, 1e-6);
  EXPECT_GT(before.eta_s.value(), 5.0);
  const Progress nowhere = r.executor.progress(std::nullopt);
  EXPECT_FALSE(nowhere.distance_left_m);
  EXPECT_FALSE(nowhere.eta_s);
  r.start();
  r.run(4.0);
  EXPECT_EQ(r.executor.progress(r.vehicle.at).current_item, 1);
  EXPECT_NEAR(r.executor.progress(r.vehicle.at).distance_left_m.value(), 10.0 - r.vehicle.at.east_m,
              0.2);
  ASSERT_TRUE(r.run(60.0));
  const Progress after = r.executor.progress(r.vehicle.at);
  EXPECT_FALSE(after.current_item);
  EXPECT_FALSE(after.distance_left_m);
  EXPECT_FALSE(after.eta_s);
  // Home is not a place before the robot goes there.
  Ride home;
  home.load(plan({mission::Wait{5.0}, at(4, 0), mission::ReturnHome{}}));
  EXPECT_FALSE(home.executor.progress(home.vehicle.at).distance_left_m);
}

/// What remains, not the whole way: also where the robot is on its way to the first waypoint, and
/// where it was moved while the mission waited.
TEST(Executor, AMissionThatWaitsTellsWhatRemainsOfIt) {
  for (const double after_s : {4.0, 12.0, 20.0}) {
    SCOPED_TRACE(after_s);
    Ride r;
    r.load(plan({at(8, 0), at(20, 0)}));
    r.start();
    ASSERT_FALSE(r.run(after_s));
    const Progress driving = r.executor.progress(r.vehicle.at);
    ASSERT_LT(driving.distance_left_m.value(), 20.0 - 0.5 * after_s);
    r.executor.pause("test");
    const Progress waits = r.executor.progress(r.vehicle.at);
    EXPECT_NEAR(waits.distance_left_m.value(), 20.0 - r.vehicle.at.east_m, 0.1);
    EXPECT_NEAR(waits.distance_left_m.value(), driving.distance_left_m.value(), 0.1);
    EXPECT_NEAR(waits.eta_s.value(), driving.eta_s.value(), 2.0);
    r.executor.interrupt();
    EXPECT_NEAR(r.executor.progress(r.vehicle.at).distance_left_m.value(),
                driving.distance_left_m.value(), 0.1);
  }
}

TEST(Executor, AMissionThatWaitsCountsTheWayBackToIt) {
  for (const double after_s : {4.0, 20.0}) {
    SCOPED_TRACE(after_s);
    Ride r;
    r.load(plan({at(8, 0), at(20, 0)}));
    r.start();
    ASSERT_FALSE(r.run(after_s));
    r.executor.pause("test");
    const double before_m = r.executor.progress(r.vehicle.at).distance_left_m.value();
    const double before_s = r.executor.progress(r.vehicle.at).eta_s.value();
    const EnuPoint moved{r.vehicle.at.east_m - 6.0, 0.0};
    EXPECT_NEAR(r.executor.progress(moved).distance_left_m.value(), before_m + 6.0, 0.1);
    EXPECT_GT(r.executor.progress(moved).eta_s.value(), before_s + 4.0);
    if (after_s > 4.0) continue;
    EXPECT_FALSE(r.executor.progress(std::nullopt).distance_left_m);
  }
}

TEST(Executor, JumpsAsOftenAsToldAndRefusesToSpinInPlace) {
  Ride r;
  r.load(plan({at(2, 0), at(4, 0), mission::Jump{1, 2}, at(6, 0)}));
  r.start();
  ASSERT_TRUE(r.run(200.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 1, 2, 1, 2, 4}));
  Ride spin;
  spin.load(plan({at(0, 0), mission::Jump{2, 0}}));
  spin.start();
  ASSERT_TRUE(spin.run(5.0));
  EXPECT_EQ(spin.executor.state(), ExecutionState::Aborted);
  EXPECT_NE(spin.executor.reason().find("circle"), std::string::npos);
}

TEST(Executor, RepeatsAndGoesBackAndForth) {
  Ride round;
  round.load(plan({at(3, 0), at(3, 3)}, AtEnd::Repeat));
  round.start();
  EXPECT_FALSE(round.run(100.0));
  EXPECT_GE(round.laps, 2);
  EXPECT_EQ((std::vector<int>{round.reached.begin(), round.reached.begin() + 4}),
            (std::vector<int>{1, 2, 1, 2}));
  Ride back;
  back.load(plan({at(3, 0), mission::Wait{0.5}, at(3, 3), at(0, 3)}, AtEnd::BackAndForth));
  back.start();
  EXPECT_FALSE(back.run(150.0));
  EXPECT_EQ((std::vector<int>{back.reached.begin(), back.reached.begin() + 7}),
            (std::vector<int>{1, 2, 3, 4, 3, 1, 2}));
}

TEST(Executor, ReturnsHomeAsAnItemAndWithoutAHomeSaysWhyNot) {
  Ride r;
  r.load(plan({at(3, 0), mission::ReturnHome{}}));
  r.start();
  ASSERT_TRUE(r.run(60.0));
  EXPECT_LT(base::distance_m(r.vehicle.at, {0, 0}), 0.1);
  Ride none;
  none.home.reset();
  none.load(plan({at(3, 0), mission::ReturnHome{}}));
  none.start();
  ASSERT_TRUE(none.run(60.0));
  EXPECT_EQ(none.executor.state(), ExecutionState::Aborted);
}

TEST(Executor, GoesOnAtTheSamePlaceAfterAnInterruptionAndDrivesBackToItFirst) {
  Ride r;
  r.load(plan({at(10, 0)}));
  r.vehicle.at = {0, 0};
  r.start();
  for (int i = 0; i < 300; ++i) r.tick();
  const EnuPoint place = r.vehicle.at;
  r.executor.interrupt();
  r.vehicle.at = {place.east_m - 1.0, 4.0};
  r.vehicle.yaw_rad = 1.0;
  r.tick();
  EXPECT_TRUE(r.executor.running());
  EXPECT_EQ(r.vehicle.at, (EnuPoint{place.east_m - 1.0, 4.0}));  // somebody else drives
  r.executor.go_on(r.vehicle.at);
  ASSERT_TRUE(r.run(90.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_LT(base::distance_m(r.vehicle.at, {10, 0}), 0.1);
}

TEST(Executor, RejoinsThePathWhereItLeftItNotFurtherOn) {
  Ride r;
  r.load(plan({at(0, 0), at(10, 0), at(10, 10)}));
  r.start();
  ASSERT_FALSE(r.run(8.0));
  const double left_at = r.vehicle.at.east_m;
  ASSERT_GT(left_at, 2.0);
  r.executor.pause("test");
  r.vehicle.at = {9.0, 3.0};
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  double nearest = 1e9;
  for (int i = 0; i < 5000 && r.executor.running(); ++i) {
    r.tick();
    nearest = std::min(nearest, base::distance_m(r.vehicle.at, {left_at, 0.0}));
  }
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_LT(nearest, 0.2);
}

/// Slides on from its first stop by so much, once.
void slide_at_stop(Ride& r, double by_m) {
  for (int i = 0; i < 3000 && r.executor.phase() != TrackPhase::Stop; ++i) r.tick();
  ASSERT_EQ(r.executor.phase(), TrackPhase::Stop);
  r.vehicle.at.east_m += by_m;
}

//   v0 ───────────▶ v1 ·····▶ x      x: where it stands
//                   │◀────────┘
TEST(Executor, AStopThatWasOvershotIsBackedUpToAndTheMissionGoesOn) {
  Ride r;
  r.load(plan({at(10, 0), at(10, 10)}));
  r.start();
  slide_at_stop(r, 0.9);
  while (r.executor.running() && r.reached.empty()) r.tick();
  ASSERT_TRUE(r.executor.running()) << r.executor.reason();
  EXPECT_LT(base::distance_m(r.vehicle.at, {10, 0}), 0.1);
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2}));
  EXPECT_TRUE(r.missed.empty());
}

TEST(Executor, ACarBacksUpToItsLastStopToo) {
  PathParams car;
  car.vehicle.kinematics = "ackermann";
  car.vehicle.wheelbase_m = 1.3;
  Ride r;
  r.path.adopt(std::make_shared<const PathParams>(car));
  r.load(plan({at(10, 0)}));
  r.start();
  slide_at_stop(r, 0.9);
  r.vehicle.at.north_m = 0.05;
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished) << r.executor.reason();
  EXPECT_LT(base::distance_m(r.vehicle.at, {10, 0}), 0.1);
}

TEST(Executor, AStopThatWasOvershotByFarIsNotBackedUpTo) {
  Ride r;
  r.load(plan({at(10, 0), at(10, 10)}));
  r.start();
  slide_at_stop(r, 3.5);
  EXPECT_TRUE(r.run(10.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Blocked);
}

TEST(Executor, ARobotThatDoesNotMoveIsBlockedAfterTenSeconds) {
  Ride r;
  r.load(plan({at(10, 0)}));
  r.start();
  for (int i = 0; i < 480; ++i) r.executor.step(r.vehicle, 10.0, {}, 0.02);
  EXPECT_TRUE(r.executor.running());
  for (int i = 0; i < 60; ++i) r.executor.step(r.vehicle, 10.0, {}, 0.02);
  EXPECT_EQ(r.executor.state(), ExecutionState::Blocked);
  EXPECT_TRUE(r.executor.resume(r.vehicle.at));
}

TEST(Executor, TooFarFromThePathItPausesAndSaysHowFar) {
  Ride r;
  r.load(plan({at(0, 0), at(20, 0)}));
  r.start();
  ASSERT_FALSE(r.run(6.0));
  r.vehicle.at.north_m = 5.0;
  ASSERT_TRUE(r.run(1.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Paused);
  EXPECT_EQ(r.executor.reason(), "5.0 m away from the path");
}

TEST(Executor, OutOfTheCorridorThatTheMissionAsksForItPausesToo) {
  Ride r;
  auto narrow = plan({at(0, 0), at(20, 0)});
  narrow.settings.corridor_m = 0.5;
  r.load(narrow);
  r.start();
  ASSERT_FALSE(r.run(6.0));
  EXPECT_EQ(r.executor.corridor_m(), 0.5);
  r.vehicle.at.north_m = 0.8;
  ASSERT_TRUE(r.run(1.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Paused);
  EXPECT_EQ(r.executor.reason(), "0.8 m away from the path");
  EXPECT_EQ(r.executor.corridor_m(), std::nullopt);
}

TEST(Executor, SkipsForwardsAndBackwards) {
  Ride r;
  r.load(plan({at(3, 0), at(6, 0), at(9, 0)}));
  EXPECT_FALSE(r.executor.skip(0));  // nothing runs yet
  r.start();
  r.run(1.0);
  ASSERT_TRUE(r.executor.skip(3));
  EXPECT_FALSE(r.executor.skip(4));
  ASSERT_TRUE(r.executor.skip(2));
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.reached, (std::vector<int>{2, 3}));
}

//    dense points beside their way in turn: driven smoothly, and each of them counts
TEST(Executor, EveryItemOfADenseNoisyCurveIsReachedWithoutSlowingDown) {
  Ride r;
  std::vector<mission::Item> items;
  std::vector<int> all;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.3 * i;
    const double beside_m = 0.02 * std::sin(7.0 * i * i);
    items.push_back(at(8.0 * std::sin(s / 8.0), 8.0 - 8.0 * std::cos(s / 8.0) + beside_m));
    if (i == 40) items.push_back(mission::Action{"set_home", {}});
    all.push_back(static_cast<int>(items.size()));
    if (i == 40) all.back() = 41;
  }
  r.load(plan(std::move(items)));
  r.start();
  double turned_rad = 0.0;
  for (int i = 0; i < 50 * 120 && r.executor.running(); ++i) {
    r.tick();
    turned_rad += std::abs(r.vehicle.yaw_rate_radps) * 0.02;
  }
  EXPECT_FALSE(r.executor.running());
  EXPECT_EQ(r.reached, all);
  EXPECT_TRUE(r.missed.empty());
  EXPECT_LT(turned_rad, 1.5 * 18.0 / 8.0);
}

TEST(Executor, PassesParallelLanesOneAfterTheOther) {
  Ride r;
  std::vector<mission::Item> items;
  for (int lane = 0; lane < 4; ++lane) {
    const double e = 1.5 * lane;
    items.push_back(at(e, lane % 2 == 0 ? 0.0 : 8.0));
    items.push_back(at(e, lane % 2 == 0 ? 8.0 : 0.0));
  }
  r.load(plan(std::move(items)));
  r.start();
  ASSERT_TRUE(r.run(300.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8}));
}

}  // namespace
}  // namespace roverd::nav
