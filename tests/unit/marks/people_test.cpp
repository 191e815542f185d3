// Legs in a scan look like poles: who walks is no landmark, what stands is one.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "yard.hpp"

namespace roverd::nav::marks {
namespace {

constexpr double kTall_m = 1.75;

/// Her legs after so much way, from there to there and back: they swing against each other, each
/// stands while the other one moves.
std::vector<Pole> legs(Vec2 from, Vec2 to, double way_m) {
  const double long_m = length(to - from);
  const double at_m = std::fmod(way_m, 2.0 * long_m);
  const double sign = at_m < long_m ? 1.0 : -1.0;
  const Vec2 along = (sign / long_m) * (to - from);
  const Vec2 left{-along.y, along.x};
  const Vec2 at = at_m < long_m ? from + at_m * along : to + (at_m - long_m) * along;
  const double swing_m = 0.14 * kTall_m * std::sin(2.0 * base::kPi * way_m / (0.85 * kTall_m));
  return {{at + swing_m * along + 0.13 * left, 0.08}, {at - swing_m * along - 0.13 * left, 0.08}};
}

struct Street {
  Yard yard;
  std::vector<Pole> still;
  Vec2 from{2.5, 1.2};
  Vec2 to{6.5, 1.2};
  double speed_mps = 0.25;
  double walked_m = 0.0;
  Rover rover;
  Scanner scanner;
  LandmarkParams params;
  Landmarks marks;
  base::BodyTwist drives{};
  int legs_believed = 0;   ///< looks that had any
  int still_believed = 0;  ///< looks in which all that stands was

  Street() { rover.step({}); }
  void run(double seconds, bool there = true) {
    for (int i = 0; i < seconds * 10.0; ++i) {
      for (int k = 0; k < 5; ++k) rover.step(drives);
      walked_m += 0.1 * speed_mps;
      yard.poles = still;
      if (there) {
        for (const Pole& leg : legs(from, to, walked_m)) yard.poles.push_back(leg);
      }
      marks.take(scan_of(scanner.look(yard, rover.truth, rover.now), rover), params);
      std::size_t stands = 0;
      bool legs = false;
      for (const Landmark& l : marks.all()) {
        if (!l.believed) continue;
        const bool is =
            std::ranges::any_of(still, [&](const Pole& p) { return length(p.at - l.at) < 0.3; });
        is ? ++stands : legs = true;
      }
      legs_believed += legs ? 1 : 0;
      still_believed += stands == still.size() ? 1 : 0;
    }
  }
};

//      |──── she ────|      1.2 m beside the way, and across it
//   ▶
TEST(People, WhoWalksIsNoLandmark) {
  for (const double speed_mps : {0.15, 0.25, 0.5, 1.2}) {
    for (const bool across : {false, true}) {
      for (const double robot_mps : {0.0, 0.2}) {
        Street s;
        s.speed_mps = speed_mps;
        if (across) s.from = {3.0, -2.0}, s.to = {3.5, 2.0};
        s.drives = {robot_mps, 0.0};
        s.run(40.0);
        EXPECT_EQ(s.legs_believed, 0) << speed_mps << " across " << across << " at " << robot_mps;
      }
    }
  }
}

//   o   she goes by at 1.5 m   o
TEST(People, WhatStandsIsBelievedWhileSomebodyWalksAsideOfIt) {
  Street s;
  s.still = {{{2.0, -0.6}, 0.12}, {{4.0, -0.6}, 0.05}};
  s.run(3.0);
  s.still_believed = 0;
  s.run(20.0);
  EXPECT_EQ(s.legs_believed, 0);
  EXPECT_EQ(s.still_believed, 200);
}

TEST(People, APoleIsBelievedAfterItStoodForAWhileAlsoToWhoDrivesAndTurns) {
  for (const base::BodyTwist drives : {base::BodyTwist{0.0, 0.0}, {0.6, 0.0}, {0.3, 0.4}}) {
    Street s;
    s.still = {{{4.0, 1.0}, 0.12}, {{4.5, 2.2}, 0.1}};
    s.drives = drives;
    s.run(1.3, false);
    EXPECT_EQ(s.still_believed, 0);
    s.run(0.7, false);
    EXPECT_GT(s.still_believed, 0) << drives.linear_mps;
    s.still_believed = 0;
    s.run(2.0, false);
    EXPECT_EQ(s.still_believed, 20) << drives.linear_mps;
  }
}

//   ▶     o   she goes by at 0.4 m or 0.5 m, on this side of it or beyond
TEST(People, AConeThatIsBelievedStaysSoWhereSomebodyGoesCloseByIt) {
  for (const double speed_mps : {0.25, 0.5, 1.2}) {
    for (const double aside_m : {-0.5, -0.4, 0.4, 0.5}) {
      for (const bool across : {false, true}) {
        Street s;
        s.still = {{{3.5, 0.5}, 0.12}};
        s.run(3.0, false);
        s.speed_mps = speed_mps;
        s.from = across ? Vec2{3.5 + aside_m, -2.0} : Vec2{1.5, 0.5 + aside_m};
        s.to = across ? Vec2{3.5 + aside_m, 3.0} : Vec2{6.5, 0.5 + aside_m};
        s.still_believed = 0;
        s.run(30.0);
        EXPECT_GE(s.still_believed, 285) << speed_mps << " " << aside_m << " across " << across;
        EXPECT_EQ(s.legs_believed, 0) << speed_mps << " " << aside_m << " across " << across;
      }
    }
  }
}

TEST(People, WhoStoodAndWalksOnIsBelievedNoMore) {
  for (const double speed_mps : {0.2, 1.0}) {
    Street s;
    s.speed_mps = 0.0;
    s.run(5.0);
    EXPECT_GT(s.legs_believed, 0) << "two poles, for all that a scan tells";
    s.speed_mps = speed_mps;
    s.run(4.0);
    s.legs_believed = 0;
    s.run(10.0);
    EXPECT_EQ(s.legs_believed, 0) << speed_mps;
  }
}

//   o ←☺   it has not moved yet, but she who is beside it does
TEST(People, WhatIsSeenBesideAMoverIsBelievedWhenSheIsAway) {
  Street s;
  s.yard.poles = {{{3.0, 1.0}, 0.08}};
  const auto look = [&](int times, double off_m) {
    for (int i = 0; i < times; ++i) {
      for (int k = 0; k < 5; ++k) s.rover.step({});
      sense::Mover she;
      she.at = {3.0, 1.0 + off_m};
      she.seen = s.rover.now;
      const auto scan = scan_of(s.scanner.look(s.yard, s.rover.truth, s.rover.now), s.rover);
      s.marks.take(scan, s.params, 0, {&she, 1});
    }
    return s.marks.all().at(0).believed;
  };
  EXPECT_FALSE(look(50, 0.6));
  EXPECT_FALSE(look(30, 2.0)) << "she was there lately";
  EXPECT_TRUE(look(10, 2.0));
  EXPECT_TRUE(look(10, 0.6)) << "it is known";
}

//   while she is about, a scan tells it, and a camera
TEST(People, ACameraNamesAConeThatTheScanMistakesForALeg) {
  Street s;
  for (int i = 0; i < 5; ++i) {
    base::Vision image;
    image.stamp = s.rover.now;
    image.landmarks = {{"cone", {2.5, 1.2, 0.0}}};
    s.marks.take(image, {}, s.rover.odometry, 0.6, s.params, 1);
    s.run(0.1);
  }
  EXPECT_TRUE(std::ranges::any_of(s.marks.all(), &Landmark::believed));
}

}  // namespace
}  // namespace roverd::nav::marks
