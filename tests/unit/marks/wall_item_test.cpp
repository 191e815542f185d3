// A mission's wall in a closed loop: when it is done, and when it stops and why.

#include <gtest/gtest.h>

#include "nav/behave/wall_drive.hpp"
#include "yard.hpp"

namespace roverd::nav {
namespace {

using marks::Rover;
using marks::Scanner;
using marks::Side;
using marks::Yard;

struct WallItem {
  Yard yard;
  Rover rover;
  Scanner scanner;
  PathParams path;
  SightParams sight;
  marks::WallParams params;
  marks::Walls walls;
  marks::View view;
  bool looks = true;
  WallDrive drive{base::Setting<PathParams>(path), {}};
  double fastest_mps = 0.0;
  double eye_m = 0.0;  ///< the scanner, ahead of the body's origin

  void begin(const WallDrive::Order& order) {
    drive = WallDrive(base::Setting<PathParams>(path), {base::Setting<SightParams>(sight),
                                                        base::Setting<marks::WallParams>(params)});
    drive.begin(order);
  }
  void run(double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      if (i % 5 == 0 && looks) look();
      const MarkSight seen{&view, rover.now, rover.odometry};
      rover.step(drive.step(seen, rover.vehicle(), 10.0, 0.02).command);
      fastest_mps = std::max(fastest_mps, rover.speed_mps);
    }
  }
  void look() {
    scanner.eye_m = eye_m;
    const auto scan = scan_of(scanner.look(yard, rover.truth, rover.now), rover, eye_m);
    if (scan.beams.empty()) return;
    walls.take(scan, params);
    view = {.stamp = scan.stamp, .walls = walls.all()};
  }
};

//   ═════════╡      of its back nothing is ever seen
TEST(WallItem, IsDoneWhereTheWallEnds) {
  WallItem w;
  w.looks = false;
  marks::Wall wall;
  wall.anchor = {0.0, 0.9};
  wall.normal = {0.0, -1.0};
  wall.seen = {{-5.0, 6.0}};
  wall.believed = true;
  wall.ends = {{6.0, true, marks::kEndsHits}};
  w.view.walls = {wall};
  w.begin({.side = Side::Left, .distance_m = 0.9});
  const auto run = [&](double seconds) {
    for (int i = 0; i < seconds * 10.0; ++i) {
      w.view.stamp = w.view.walls[0].seen_at = w.rover.now;
      w.run(0.1);
    }
  };
  run(3.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Driving);
  EXPECT_NEAR(w.fastest_mps, SightParams{}.speed_mps, 0.05);
  run(20.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
  EXPECT_EQ(w.rover.speed_mps, 0.0);
  EXPECT_NEAR(w.rover.truth.x_m, 6.9, 0.15) << "about its end";
}

//   ═══════════════════
//   ────────╮                 told on the way to keep farther off; not one whose item says its own
//           ╰──────────▶
TEST(WallItem, ADistanceThatIsChangedOnTheWayIsKeptWhereTheItemSaysNone) {
  for (const auto& own : {std::optional<double>{}, std::optional(0.9)}) {
    WallItem w;
    w.yard.slabs = {{{-5.0, 0.9}, {20.0, 0.9}}};
    base::Setting<marks::WallParams> params(w.params);
    w.drive = WallDrive(base::Setting<PathParams>(w.path), {w.sight, params});
    w.drive.begin({.side = Side::Left, .distance_m = own});
    w.run(6.0);
    EXPECT_NEAR(w.rover.truth.y_m, 0.0, 0.04);
    marks::WallParams farther;
    farther.distance_m = 1.3;
    params.adopt(std::make_shared<const marks::WallParams>(farther));
    w.run(14.0);
    EXPECT_EQ(w.drive.state(), WallDrive::State::Driving) << w.drive.reason();
    EXPECT_NEAR(w.rover.truth.y_m, own ? 0.0 : -0.4, 0.04);
  }
}

// Beside its way it steers back four times as hard, at the tick at which it is told to.
TEST(WallItem, AGainThatIsChangedActsAtOnce) {
  WallItem w;
  w.scanner.noise_m = 0.0;
  w.yard.slabs = {{{-5.0, 1.1}, {20.0, 1.1}}};
  const base::Setting<PathParams> path(w.path);
  base::Setting<PathParams> livelier(w.path);
  WallDrive as_before(path, {w.sight, w.params});
  WallDrive told(livelier, {w.sight, w.params});
  for (WallDrive* d : {&as_before, &told}) d->begin({.side = Side::Left});
  double before_radps = 0.0;
  double told_radps = 0.0;
  const auto step = [&](int i) {
    if (i % 5 == 0) w.look();
    const MarkSight seen{&w.view, w.rover.now, w.rover.odometry};
    const Vehicle vehicle = w.rover.vehicle();
    before_radps = as_before.step(seen, vehicle, 10.0, 0.02).command.angular_radps;
    told_radps = told.step(seen, vehicle, 10.0, 0.02).command.angular_radps;
  };
  for (int i = 0; i < 60; ++i) {
    step(i);
    w.rover.step({0.4, 0.0});  // it does not come nearer
  }
  ASSERT_GT(before_radps, 0.0);
  ASSERT_EQ(told_radps, before_radps);
  livelier.adopt(std::make_shared<const PathParams>(by_sight(w.path, {4.0, 1.5}, w.sight)));
  step(1);
  EXPECT_GT(told_radps, before_radps + 0.02);
}

TEST(WallItem, WithoutADistanceItFailsWhereTheVehicleWouldTouch) {
  WallItem w;
  w.yard.slabs = {{{-5.0, 0.9}, {20.0, 0.9}}};
  w.path.vehicle.width_m = 1.9;
  w.begin({.side = Side::Left});
  w.run(1.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Failed);
  EXPECT_EQ(w.drive.reason(), "nav.wall.distance_m is 0.9 m: this vehicle would touch it");
  EXPECT_EQ(w.rover.speed_mps, 0.0);
}

//   ══════▒▒▒▒▒▒▒▒▒
TEST(WallItem, FailsWhereAWallGivesNoEchoAndSaysSo) {
  WallItem w;
  w.yard.slabs = {{{-5.0, 0.9}, {4.0, 0.9}}, {{4.0, 0.9}, {9.0, 0.9}, true}};
  w.begin({.side = Side::Left, .distance_m = 0.9, .length_m = 12.0});
  w.run(40.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Failed);
  EXPECT_EQ(w.drive.reason(),
            "the wall on the left gives no echo any more, and its end was not seen");
  EXPECT_NEAR(w.rover.truth.y_m, 0.0, 0.05);
  EXPECT_NEAR(w.rover.truth.x_m, 4.0 + w.params.door_m, 0.4);
}

// A scanner far ahead has lost all of it when the robot comes to its end.
TEST(WallItem, SaysSoOfAWallThatIsNotSeenAtAllAnyMore) {
  WallItem w;
  w.eye_m = 0.8;
  w.yard.slabs = {{{-5.0, 0.9}, {4.0, 0.9}}, {{4.0, 0.9}, {9.0, 0.9}, true}};
  w.begin({.side = Side::Left, .distance_m = 0.9, .length_m = 12.0});
  w.run(40.0);
  EXPECT_EQ(w.drive.reason(),
            "the wall on the left gives no echo any more, and its end was not seen");
  EXPECT_NEAR(w.rover.truth.y_m, 0.0, 0.05);
  EXPECT_LT(w.rover.truth.x_m, 4.0 + w.params.door_m + 0.4);
}

TEST(WallItem, IsDoneAfterItsLengthAndCountsWhatWasDrivenBefore) {
  for (const double before_m : {0.0, 2.0}) {
    WallItem w;
    w.yard.slabs = {{{-5.0, -0.9}, {30.0, -0.9}}};
    w.begin({.side = Side::Right, .distance_m = 0.9, .length_m = 5.0, .driven_m = before_m});
    w.run(25.0);
    EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
    EXPECT_NEAR(w.drive.driven_m(), 5.0, 0.1);
    EXPECT_NEAR(w.rover.odometry.x_m, 5.0 - before_m, 0.1);
    EXPECT_NEAR(w.rover.truth.y_m, 0.0, 0.05);
  }
}

//   ─▶──────|        it ends beside the place
//           ×        wherever the wall goes on
//   ════════════════
TEST(WallItem, IsDoneWhereAPlaceIsPassed) {
  struct Case {
    EnuPoint place;
    double ends_m;
  };
  // Beside it, on the wall's other side, and behind: at once.
  for (const Case& c : {Case{{4.0, -2.0}, 4.0}, Case{{6.5, 3.0}, 6.5}, Case{{-1.0, 0.0}, 0.0}}) {
    WallItem w;
    w.yard.slabs = {{{-5.0, -0.9}, {30.0, -0.9}}};
    w.begin({.side = Side::Right, .distance_m = 0.9, .length_m = 9.0});
    w.drive.end_beside(c.place);
    w.run(30.0);
    EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
    EXPECT_NEAR(w.rover.odometry.x_m, c.ends_m, 0.15);
  }
}

// Farther aside than 10 m, it is the wall's own length that counts.
TEST(WallItem, APlaceFarAsideEndsNothing) {
  WallItem w;
  w.yard.slabs = {{{-5.0, -0.9}, {30.0, -0.9}}};
  w.begin({.side = Side::Right, .distance_m = 0.9, .length_m = 5.0});
  w.drive.end_beside({3.0, 11.0});
  w.run(25.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
  EXPECT_NEAR(w.rover.odometry.x_m, 5.0, 0.15);
}

TEST(WallItem, CreepsToAWallThatIsNotSeenYetAndNoFarther) {
  WallItem none;
  none.begin({.side = Side::Left, .distance_m = 0.9});
  none.run(20.0);
  EXPECT_EQ(none.drive.state(), WallDrive::State::Failed);
  EXPECT_EQ(none.drive.reason(), "no wall is seen on the left within 2.0 m");
  EXPECT_NEAR(none.rover.truth.x_m, 2.0, 0.15);
  EXPECT_LE(none.fastest_mps, 0.25);
  WallItem other;
  other.yard.slabs = {{{-5.0, -0.9}, {30.0, -0.9}}};
  other.begin({.side = Side::Left, .distance_m = 0.9});
  other.run(20.0);
  EXPECT_EQ(other.drive.state(), WallDrive::State::Failed) << "one on the right is none";
}

TEST(WallItem, BrakesWhenNothingIsToldAndFailsAfterAWait) {
  WallItem w;
  w.yard.slabs = {{{-5.0, 0.9}, {30.0, 0.9}}};
  w.begin({.side = Side::Left, .distance_m = 0.9});
  w.run(6.0);
  const double there_m = w.rover.truth.x_m;
  w.looks = false;
  w.run(4.0);
  EXPECT_EQ(w.rover.speed_mps, 0.0);
  EXPECT_LT(w.rover.truth.x_m - there_m, 1.2);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Driving) << "it may be seen again";
  w.looks = true;
  w.run(3.0);
  EXPECT_GT(w.rover.speed_mps, 0.5) << "and is";
  w.looks = false;
  w.run(10.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Failed);
  EXPECT_EQ(w.drive.reason(), "the wall on the left is not seen any more");
}

TEST(WallItem, GoesOnFromWhereSomebodyElseLeftTheRobot) {
  WallItem w;
  w.yard.slabs = {{{-5.0, 0.9}, {30.0, 0.9}}};
  w.begin({.side = Side::Left, .distance_m = 0.9, .length_m = 8.0});
  w.run(5.0);
  const double driven_m = w.drive.driven_m();
  w.drive.interrupt();
  for (int i = 0; i < 100; ++i) w.rover.step({0.3, 0.0});
  w.look();
  w.run(20.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << w.drive.reason();
  EXPECT_NEAR(w.drive.driven_m(), 8.0, 0.1);
  EXPECT_GT(w.rover.odometry.x_m, driven_m + 0.5) << "what another drove does not count";
}

// What is left is not worth starting for.
TEST(WallItem, IsDoneWhereItIsHeldJustBeforeItsLength) {
  WallItem w;
  w.yard.slabs = {{{-5.0, 0.9}, {30.0, 0.9}}};
  w.begin({.side = Side::Left, .distance_m = 0.9, .length_m = 5.0});
  while (w.drive.driven_m() < 4.75 && w.rover.truth.x_m < 6.0) w.run(0.02);
  ASSERT_EQ(w.drive.state(), WallDrive::State::Driving);
  w.drive.interrupt();
  for (int i = 0; i < 50; ++i) w.rover.step({});
  w.look();
  w.run(1.0);
  EXPECT_EQ(w.drive.state(), WallDrive::State::Done);
}

TEST(WallItem, IsDoneWhereItIsHeldJustBeforeTheWallsEnd) {
  double whole_m = 1e9;
  for (const bool held : {false, true}) {
    WallItem w;
    w.looks = false;
    marks::Wall wall;
    wall.anchor = {0.0, 0.9};
    wall.normal = {0.0, -1.0};
    wall.seen = {{-5.0, 0.0}};
    wall.believed = true;
    wall.ends = {{0.0, true, marks::kEndsHits}};
    w.view.walls = {wall};
    const auto run = [&](double seconds) {
      for (int i = 0; i < seconds * 10.0 && w.drive.driven_m() < whole_m - 0.2; ++i) {
        w.view.stamp = w.view.walls[0].seen_at = w.rover.now;
        w.run(0.1);
      }
    };
    w.begin({.side = Side::Left, .distance_m = 0.9});
    run(15.0);
    if (held) {
      ASSERT_EQ(w.drive.state(), WallDrive::State::Driving);
      w.drive.interrupt();
      for (int i = 0; i < 50; ++i) w.rover.step({});
      whole_m = 1e9;
      run(1.5);
    }
    EXPECT_EQ(w.drive.state(), WallDrive::State::Done) << held;
    whole_m = w.drive.driven_m();
  }
}

TEST(SightDrive, StandsWhereAWayEndsUntilALongerOneIsLaid) {
  marks::SightDrive drive{base::Setting<PathParams>{}};
  const auto way = [](double to_m, marks::WayEnd end) {
    marks::Way out;
    for (const double at_m : {-1.0, to_m}) {
      Vertex v;
      v.at = {at_m, 0.0};
      v.speed_mps = 0.5;
      out.vertices.push_back(v);
    }
    out.here_m = 1.0;
    out.end = end;
    return out;
  };
  EXPECT_FALSE(drive.take(way(0.2, marks::WayEnd::Horizon)));
  EXPECT_EQ(drive.state(), marks::SightDrive::State::Ended);
  EXPECT_FALSE(drive.take(way(0.2, marks::WayEnd::TooNarrow)));
  EXPECT_EQ(drive.end(), marks::WayEnd::TooNarrow) << "the last word counts";
  EXPECT_EQ(drive.step({}, 1.0, 0.02).command, base::BodyTwist{});
  EXPECT_EQ(drive.state(), marks::SightDrive::State::Ended);
  EXPECT_TRUE(drive.take(way(3.0, marks::WayEnd::WallEnds)));
  EXPECT_EQ(drive.state(), marks::SightDrive::State::Driving);
  drive.reset();
  EXPECT_EQ(drive.end(), marks::WayEnd::Horizon);
}

}  // namespace
}  // namespace roverd::nav
