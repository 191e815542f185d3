// A mission's landmarks in a closed loop: at which distance they are passed, when the item is done,
// and when it stops and why.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "nav/behave/landmark_drive.hpp"
#include "yard.hpp"

namespace roverd::nav {
namespace {

using marks::Rover;
using marks::Scanner;
using marks::Side;
using marks::Yard;
using State = LandmarkDrive::State;

struct LandmarksItem {
  Yard yard;
  Rover rover;
  Scanner scanner;
  PathParams path;
  SightParams sight;
  marks::LandmarkParams params;
  marks::Landmarks marks;
  marks::View view;
  bool looks = true;
  bool other_looks = false;  ///< another sensor, which sees none
  LandmarkDrive drive{base::Setting<PathParams>(path), {}};
  double fastest_mps = 0.0;
  std::vector<double> nearest_m;  ///< the true least distance to each pole

  void begin(LandmarkDrive::Order order) {
    drive = LandmarkDrive(
        base::Setting<PathParams>(path),
        {base::Setting<SightParams>(sight), {}, base::Setting<marks::LandmarkParams>(params)});
    drive.begin(std::move(order));
  }
  void run(double seconds) {
    nearest_m.resize(yard.poles.size(), 1e9);
    for (int i = 0; i < seconds * 50.0; ++i) {
      if (i % 5 == 0 && looks) look();
      if (i % 5 == 2 && other_looks) look_elsewhere();
      const MarkSight seen{&view, rover.now, rover.odometry};
      rover.step(drive.step(seen, rover.vehicle(), 10.0, 0.02).command);
      fastest_mps = std::max(fastest_mps, rover.speed_mps);
      for (std::size_t k = 0; k < yard.poles.size(); ++k) {
        const marks::Vec2 off = yard.poles[k].at - marks::Vec2{rover.truth.x_m, rover.truth.y_m};
        nearest_m[k] = std::min(nearest_m[k], marks::length(off));
      }
    }
  }
  void look() {
    const auto scan = scan_of(scanner.look(yard, rover.truth, rover.now), rover);
    if (scan.beams.empty()) return;
    marks.take(scan, params);
    view.stamp = scan.stamp;
    view.looked_at.resize(2);
    view.looked_at[0] = scan.stamp;
    view.landmarks = marks.all();
  }
  /// It stood there before the item begins: what stands is believed by then.
  void look_around() {
    for (int i = 0; i < 20; ++i) {
      for (int k = 0; k < 5; ++k) rover.step({});
      look();
    }
  }
  void look_elsewhere() {
    view.stamp = rover.now;
    view.looked_at.resize(2);
    view.looked_at[1] = rover.now;
  }
  void stand_poles(int many, double from_m = 2.5, double y_m = 0.4) {
    for (int i = 0; i < many; ++i) yard.poles.push_back({{from_m + 3.0 * i, y_m}, 0.12});
  }
};

//        o        o         o         o      on its left, at 0.70 m
//  ─────────────────────────────────────────▶
TEST(LandmarksItem, PassesEachAtTheOffsetAndIsDoneBehindTheLast) {
  for (const Side side : {Side::Left, Side::Right}) {
    LandmarksItem l;
    l.stand_poles(4, 2.5, side == Side::Left ? 0.4 : -0.4);
    l.begin({.side = side, .offset_m = 0.7});
    l.run(40.0);
    EXPECT_EQ(l.drive.state(), State::Done) << l.drive.reason();
    EXPECT_EQ(l.drive.passed(), 4);
    for (const double m : l.nearest_m) EXPECT_NEAR(m, 0.70, 0.05);
    EXPECT_NEAR(l.fastest_mps, SightParams{}.speed_mps, 0.05);
    EXPECT_NEAR(l.rover.truth.x_m, 12.5, 0.3) << "on_m behind the last";
    EXPECT_EQ(l.rover.speed_mps, 0.0);
  }
}

// The last two are passed as it is told on the way, where the item says nothing itself.
TEST(LandmarksItem, AnOffsetThatIsChangedOnTheWayIsKeptWhereTheItemSaysNone) {
  for (const auto& own : {std::optional<double>{}, std::optional(0.7)}) {
    LandmarksItem l;
    l.stand_poles(4);
    base::Setting<marks::LandmarkParams> params(l.params);
    l.drive = LandmarkDrive(base::Setting<PathParams>(l.path), {l.sight, {}, params});
    l.drive.begin({.side = Side::Left, .offset_m = own});
    while (l.drive.passed() < 2 && l.rover.now < base::Time(std::chrono::hours(2))) l.run(0.1);
    marks::LandmarkParams farther;
    farther.offset_m = 1.0;
    params.adopt(std::make_shared<const marks::LandmarkParams>(farther));
    l.run(25.0);
    EXPECT_EQ(l.drive.state(), State::Done) << l.drive.reason();
    EXPECT_NEAR(l.nearest_m[0], 0.7, 0.05);
    EXPECT_NEAR(l.nearest_m[3], own ? 0.7 : 1.0, 0.05);
  }
}

TEST(LandmarksItem, IsDoneBehindSoManyAndCountsThoseOfBefore) {
  for (const int before : {0, 1}) {
    LandmarksItem l;
    l.stand_poles(6);
    l.begin({.side = Side::Left, .count = 3, .passed = before});
    l.run(40.0);
    EXPECT_EQ(l.drive.state(), State::Done) << l.drive.reason();
    EXPECT_EQ(l.drive.passed(), 3);
    EXPECT_NEAR(l.rover.truth.x_m, 2.5 + 3.0 * (2 - before) + 1.0, 0.3);
  }
}

TEST(LandmarksItem, SaysHowManyWereThereWhereMoreWereAskedFor) {
  LandmarksItem l;
  l.stand_poles(2);
  l.begin({.side = Side::Left, .count = 5});
  l.run(30.0);
  EXPECT_EQ(l.drive.state(), State::Failed);
  EXPECT_EQ(l.drive.reason(), "only 2 of 5 landmarks were seen");
  EXPECT_EQ(l.rover.speed_mps, 0.0);
}

TEST(LandmarksItem, CreepsUntilOneIsSeenAndNoFarther) {
  LandmarksItem none;
  none.yard.slabs = {{{6.0, -3.0}, {6.0, 3.0}}};  // a wall is no landmark
  none.begin({.side = Side::Left});
  none.run(20.0);
  EXPECT_EQ(none.drive.state(), State::Failed);
  EXPECT_EQ(none.drive.reason(), "no landmark is seen within 2.0 m");
  EXPECT_NEAR(none.rover.truth.x_m, 2.0, 0.15);
  EXPECT_LE(none.fastest_mps, 0.25);
  LandmarksItem unnamed;
  unnamed.stand_poles(1);
  unnamed.begin({.side = Side::Left, .name = "cone"});
  unnamed.run(20.0);
  EXPECT_EQ(unnamed.drive.reason(), "no landmark called \"cone\" is seen within 2.0 m");
}

TEST(LandmarksItem, BrakesWhereTheOneAheadIsGoneAndEndsThere) {
  LandmarksItem l;
  l.stand_poles(1);
  l.yard.poles.push_back({{9.0, 0.4}, 0.12});
  l.begin({.side = Side::Left, .count = 2});
  while (l.rover.truth.x_m < 5.0 && l.rover.now < base::Time(std::chrono::hours(2))) l.run(0.02);
  EXPECT_EQ(l.drive.passed(), 1);
  l.yard.poles.pop_back();  // somebody carries it away
  l.run(4.0);
  EXPECT_EQ(l.rover.speed_mps, 0.0);
  EXPECT_LT(l.rover.truth.x_m, 7.5) << "it does not drive on to where it stood";
  l.run(10.0);
  EXPECT_EQ(l.drive.state(), State::Failed);
  EXPECT_EQ(l.drive.reason(), "only 1 of 2 landmarks were seen");
}

TEST(LandmarksItem, BrakesWhenNothingIsToldAndFailsAfterAWait) {
  LandmarksItem l;
  l.stand_poles(4);
  l.begin({.side = Side::Left});
  l.run(6.0);
  const double there_m = l.rover.truth.x_m;
  l.looks = false;
  l.run(4.0);
  EXPECT_EQ(l.rover.speed_mps, 0.0);
  EXPECT_LT(l.rover.truth.x_m - there_m, 1.2);
  EXPECT_EQ(l.drive.state(), State::Driving) << "they may be seen again";
  l.looks = true;
  l.run(3.0);
  EXPECT_GT(l.rover.speed_mps, 0.5) << "and are";
  l.looks = false;
  l.run(10.0);
  EXPECT_EQ(l.drive.state(), State::Failed) << "nobody looks: nobody says that there are no more";
  EXPECT_EQ(l.drive.reason(), "no landmark is seen any more");
}

//  scanner ─▶ poles; a camera that looks back lives on
TEST(LandmarksItem, AnotherSensorsWordKeepsNoOnesAheadFresh) {
  LandmarksItem l;
  l.other_looks = true;
  l.stand_poles(4);
  l.begin({.side = Side::Left});
  l.run(6.0);
  const double there_m = l.rover.truth.x_m;
  ASSERT_EQ(l.drive.state(), State::Driving);
  l.looks = false;
  l.run(4.0);
  EXPECT_EQ(l.rover.speed_mps, 0.0) << "who told the next one looks no more";
  EXPECT_LT(l.rover.truth.x_m - there_m, 1.2);
  l.looks = true;
  l.run(3.0);
  EXPECT_GT(l.rover.speed_mps, 0.5);
  l.looks = false;
  l.run(10.0);
  EXPECT_EQ(l.drive.state(), State::Failed);
  EXPECT_EQ(l.drive.reason(), "no landmark is seen any more");
}

TEST(LandmarksItem, NobodyElseSaysThatNoMoreFollowBehindTheLast) {
  LandmarksItem l;
  l.other_looks = true;
  l.stand_poles(2);
  l.begin({.side = Side::Left});
  while (l.drive.passed() < 2 && l.rover.truth.x_m < 8.0) l.run(0.02);
  l.looks = false;
  l.run(12.0);
  EXPECT_EQ(l.rover.speed_mps, 0.0);
  EXPECT_EQ(l.drive.state(), State::Failed) << "there may be a third one";
  LandmarksItem two;
  two.other_looks = true;
  two.stand_poles(2);
  two.begin({.side = Side::Left, .count = 2});
  while (two.drive.passed() < 2 && two.rover.truth.x_m < 8.0) two.run(0.02);
  two.looks = false;
  two.run(12.0);
  EXPECT_EQ(two.drive.state(), State::Done) << "nobody asked for a third one";
}

TEST(LandmarksItem, GoesOnFromWhereSomebodyElseLeftTheRobotAndPassesNoneTwice) {
  LandmarksItem l;
  l.stand_poles(4);
  l.begin({.side = Side::Left});
  while (l.drive.passed() < 2 && l.rover.truth.x_m < 8.0) l.run(0.02);
  l.drive.interrupt();
  for (int i = 0; i < 50; ++i) l.rover.step({-0.4, 0.0});  // back beside the second one
  for (int i = 0; i < 50; ++i) l.rover.step({});
  l.run(30.0);
  EXPECT_EQ(l.drive.state(), State::Done) << l.drive.reason();
  EXPECT_EQ(l.drive.passed(), 4);
  for (const double m : l.nearest_m) EXPECT_NEAR(m, 0.70, 0.05);
}

TEST(LandmarksItem, PassesALastOneAlsoAtAWideOffsetOrWithAShortWayBehindIt) {
  LandmarksItem wide;
  wide.stand_poles(3);
  wide.begin({.side = Side::Left, .offset_m = 2.0});
  wide.run(60.0);
  EXPECT_EQ(wide.drive.state(), State::Done) << wide.drive.reason();
  EXPECT_EQ(wide.drive.passed(), 3);
  LandmarksItem brief;
  brief.params.on_m = 0.2;
  brief.stand_poles(1, 2.0);
  brief.begin({.side = Side::Left, .offset_m = 0.7});
  brief.run(40.0);
  EXPECT_EQ(brief.drive.state(), State::Done) << brief.drive.reason();
}

TEST(LandmarksItem, GoesOnAbeamOfTheLast) {
  LandmarksItem l;
  l.stand_poles(1);
  l.begin({.side = Side::Left, .offset_m = 0.7});
  while (l.rover.truth.x_m < 2.3 && l.rover.now < base::Time(std::chrono::hours(2))) l.run(0.02);
  l.drive.interrupt();
  for (int i = 0; i < 50; ++i) l.rover.step({});
  l.run(30.0);
  EXPECT_EQ(l.drive.state(), State::Done) << l.drive.reason();
  EXPECT_EQ(l.drive.passed(), 1);
}

TEST(LandmarksItem, StandsWhereItBeginsTooNearToOne) {
  LandmarksItem l;
  l.yard.poles.push_back({{0.55, 0.0}, 0.1});
  l.look_around();
  l.begin({.side = Side::Left, .offset_m = 0.7});
  l.run(10.0);
  EXPECT_EQ(l.drive.state(), State::Failed);
  EXPECT_EQ(l.drive.reason().substr(0, 31), "stands too near to a landmark (");
  EXPECT_NEAR(l.rover.truth.x_m, 0.0, 0.15);
}

TEST(LandmarksItem, OneThatItStandsTooNearToIsNotPassedHoweverOftenItGoesOn) {
  for (int at = 0; at < 60; ++at) {
    LandmarksItem l;
    const double bearing_rad = 0.02 * (at - 30);
    const double range_m = 0.45 + 0.003 * at;
    l.yard.poles.push_back(
        {{range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad)}, 0.1});
    l.look_around();
    l.begin({.side = Side::Left, .offset_m = 0.7});
    for (int again = 0; again < 2; ++again) {
      l.run(1.5);
      EXPECT_EQ(l.drive.state(), State::Failed) << bearing_rad << " " << range_m;
      EXPECT_EQ(l.drive.passed(), 0) << bearing_rad << " " << range_m;
      l.drive.interrupt();
    }
    EXPECT_NEAR(l.rover.truth.x_m, 0.0, 0.15);
  }
}

TEST(LandmarksItem, StandsWhereNobodyLooksWhenItGoesOn) {
  LandmarksItem l;
  l.stand_poles(4);
  l.begin({.side = Side::Left});
  l.run(6.0);
  l.looks = false;
  l.run(12.0);
  ASSERT_EQ(l.drive.state(), State::Failed);
  const double there_m = l.rover.truth.x_m;
  l.drive.interrupt();
  l.run(4.0);
  EXPECT_EQ(l.drive.state(), State::Seeking);
  l.run(4.0);
  EXPECT_EQ(l.drive.state(), State::Failed);
  EXPECT_EQ(l.drive.reason(), "nothing looks for landmarks");
  EXPECT_EQ(l.rover.truth.x_m, there_m);
  l.drive.interrupt();
  l.looks = true;
  l.run(40.0);
  EXPECT_EQ(l.drive.state(), State::Done) << l.drive.reason();
  EXPECT_EQ(l.drive.passed(), 4);
}

TEST(LandmarksItem, IsDoneAtOnceWhereAllWerePassedBefore) {
  LandmarksItem l;
  l.stand_poles(3);
  l.begin({.side = Side::Left, .count = 2, .passed = 2});
  l.run(1.0);
  EXPECT_EQ(l.drive.state(), State::Done);
  EXPECT_EQ(l.rover.truth.x_m, 0.0);
}

}  // namespace
}  // namespace roverd::nav
