// Past cones in a closed loop; names and cones that do not flicker; the simple rule by bearing;
// which source steers.

#include <gtest/gtest.h>

#include "nav/marks/course.hpp"
#include "yard.hpp"

namespace roverd::nav::marks {
namespace {

using namespace std::chrono_literals;

struct ConeRun {
  Yard yard;
  Rover rover;
  Scanner scanner;
  LandmarkParams params;
  Landmarks marks;
  PathParams path;
  SightDrive drive{base::Setting<PathParams>(path)};
  Course course;
  Side side = Side::Left;
  std::vector<double> nearest_m;  ///< the true least distance to each cone

  void run(double seconds) {
    nearest_m.assign(yard.poles.size(), 1e9);
    rover.step({});
    course.begin(rover.odometry);
    for (int i = 0; i < seconds * 50.0; ++i) {
      if (i % 2 == 0) {
        marks.take(scan_of(scanner.look(yard, rover.truth, rover.now), rover), params);
        const auto known = marks.all();
        drive.take(course.lay(known, rover.odometry, side, "", 0.5, params));
      }
      rover.step(drive.step(rover.vehicle(), 10.0, 0.02).command);
      for (std::size_t k = 0; k < yard.poles.size(); ++k) {
        const Vec2 off = yard.poles[k].at - Vec2{rover.truth.x_m, rover.truth.y_m};
        nearest_m[k] = std::min(nearest_m[k], length(off));
      }
    }
  }
};

//        o        o         o         o      on its left, at 0.70 m
//  ─────────────────────────────────────────▶
TEST(LandmarkDrive, AStraightRowOfConesIsPassedAtTheOffset) {
  for (const Side side : {Side::Left, Side::Right}) {
    ConeRun r;
    r.side = side;
    const double sign = side == Side::Left ? 1.0 : -1.0;
    for (int i = 0; i < 4; ++i) r.yard.poles.push_back({{2.5 + 3.0 * i, sign * 0.4}, 0.12});
    r.run(50.0);
    EXPECT_EQ(r.course.passed(), 4);
    for (const double m : r.nearest_m) EXPECT_NEAR(m, 0.70, 0.05);
    EXPECT_EQ(r.rover.speed_mps, 0.0) << "behind the last one it stands";
    EXPECT_NEAR(r.rover.truth.x_m, 12.5, 0.6);
  }
}

//              o            around the second one to the left,
//         o        o        past the fourth one to the right
//    o                 o
TEST(LandmarkDrive, AChainThatBendsBothWaysIsPassedAtTheOffset) {
  ConeRun r;
  r.yard.poles = {{{2.5, 0.6}, 0.1},
                  {{5.5, 0.6}, 0.1},
                  {{7.6, 2.7}, 0.1},
                  {{10.6, 2.7}, 0.1},
                  {{12.9, 0.8}, 0.1}};
  r.run(60.0);
  EXPECT_EQ(r.course.passed(), 5);
  for (const double m : r.nearest_m) EXPECT_NEAR(m, 0.70, 0.05);
}

TEST(LandmarkDrive, WithoutAnyItGoesAMetreAndStands) {
  ConeRun r;
  r.run(10.0);
  EXPECT_EQ(r.course.passed(), 0);
  EXPECT_NEAR(r.rover.truth.x_m, 1.0, 0.1);
  EXPECT_EQ(r.rover.speed_mps, 0.0);
}

TEST(LandmarkDrive, ConesBehindAndAWallAreNotDrivenTo) {
  ConeRun r;
  r.yard.poles = {{{-2.0, 0.5}, 0.1}};
  r.yard.slabs = {{{4.0, -3.0}, {4.0, 3.0}}};
  r.run(10.0);
  EXPECT_NEAR(r.rover.truth.x_m, 1.0, 0.1);
}

base::Vision image(std::vector<base::VisionLandmark> landmarks, base::Time stamp) {
  base::Vision v;
  v.stamp = stamp;
  v.landmarks = std::move(landmarks);
  return v;
}

TEST(Landmarks, ANameIsWhatIsSaidMostOftenOfLateAndTheOneStaysTheOne) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 30; ++i) {
    now += 100ms;
    const char* said = i % 5 == 4 ? "pole" : "cone";  // one in five is wrong
    const double jitter_m = i % 2 == 0 ? 0.04 : -0.04;
    marks.take(image({{said, {2.0 + jitter_m, 0.5, 0.0}}}, now), {}, {}, 0.5, {});
    ASSERT_EQ(marks.all().size(), 1U);
    EXPECT_EQ(marks.all()[0].name, "cone");
    EXPECT_EQ(marks.all()[0].believed, i >= 2);
  }
  EXPECT_NEAR(marks.all()[0].at.x, 2.0, 0.02);
  const std::uint32_t id = marks.all()[0].id;
  for (int i = 0; i < 8; ++i) marks.take(image({}, now += 100ms), {}, {}, 0.5, {});
  ASSERT_EQ(marks.all().size(), 1U) << "missed for 0.8 s it is still there";
  EXPECT_EQ(marks.all()[0].id, id);
  for (int i = 0; i < 4; ++i) marks.take(image({}, now += 100ms), {}, {}, 0.5, {});
  EXPECT_TRUE(marks.all().empty()) << "in view and not seen for a second it is gone";
}

TEST(Landmarks, WhatIsBehindTheCameraIsFalseAndOutOfViewIsKept) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 5; ++i) {
    marks.take(image({{"cone", {2.0, 0.0, 0.0}}, {"ghost", {-1.0, 0.0, 0.0}}}, now += 100ms), {},
               {}, 0.5, {});
  }
  ASSERT_EQ(marks.all().size(), 1U);
  const Pose2 turned{0.0, 0.0, base::kPi / 2.0};
  for (int i = 0; i < 50; ++i) marks.take(image({}, now += 100ms), {}, turned, 0.5, {});
  EXPECT_EQ(marks.all().size(), 1U) << "nobody looked there";
}

//   camera ─▶   )   of a cone that leaves the image the inner part is seen last
TEST(Landmarks, OneThatTheImagesEdgeMayCutTellsLittleOfWhereItStands) {
  Landmarks marks;
  base::Time now{1h};
  // Given a cone that was seen whole,
  for (int i = 0; i < 20; ++i) {
    marks.take(image({{"cone", {2.0, 0.5, 0.0}}}, now += 100ms), {}, {}, 0.5, {});
  }
  // when its inner part is told for 0.8 s at the edge, 1.2 m farther on,
  for (int i = 0; i < 8; ++i) {
    marks.take(image({{"cone", {0.8, 0.4, 0.0}}}, now += 100ms), {}, {1.2, 0.0, 0.0}, 0.5, {});
  }
  // then it has moved by a centimetre, not by six, and was seen all the time.
  ASSERT_EQ(marks.all().size(), 1U);
  EXPECT_NEAR(marks.all()[0].at.y, 0.5, 0.015);
  EXPECT_EQ(marks.all()[0].seen_at, now);
}

TEST(Landmarks, WhereNoScanTellsItAnyMoreACamerasWordCounts) {
  Yard yard;
  yard.poles = {{{2.0, 0.0}, 0.1}};
  Rover rover;
  Scanner scanner;
  Landmarks marks;
  for (int i = 0; i < 5; ++i) {
    rover.step({});
    marks.take(scan_of(scanner.look(yard, rover.truth, rover.now), rover), {}, 0);
    marks.take(image({{"pole", {2.0, 0.0, 0.0}}}, rover.now), {}, {}, 0.5, {}, 1);
  }
  ASSERT_EQ(marks.all().size(), 1U);
  EXPECT_TRUE(marks.all()[0].believed);
  EXPECT_EQ(marks.all()[0].eyes, eye_of(0) | eye_of(1));
  // The scanner falls silent; for forget_s its word stands, then it is the camera's to deny.
  base::Time now = rover.now;
  for (int i = 0; i < 9; ++i) marks.take(image({}, now += 100ms), {}, {}, 0.5, {}, 1);
  EXPECT_EQ(marks.all().size(), 1U);
  for (int i = 0; i < 15; ++i) marks.take(image({}, now += 100ms), {}, {}, 0.5, {}, 1);
  EXPECT_TRUE(marks.all().empty());
}

TEST(Landmarks, WhatACameraTellsNowAndThenIsNotBelieved) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 60; ++i) {  // every third image
    marks.take(image({}, now += 100ms), {}, {}, 0.5, {});
    marks.take(image({}, now += 100ms), {}, {}, 0.5, {});
    marks.take(image({{"cone", {2.0, 0.2, 0.0}}}, now += 100ms), {}, {}, 0.5, {});
    for (const Landmark& l : marks.all()) EXPECT_FALSE(l.believed);
  }
  for (int i = 0; i < 20; ++i) {  // three of four
    const bool told = i % 4 != 3;
    marks.take(told ? image({{"cone", {2.0, 0.2, 0.0}}}, now += 100ms) : image({}, now += 100ms),
               {}, {}, 0.5, {});
  }
  ASSERT_EQ(marks.all().size(), 1U);
  EXPECT_TRUE(marks.all()[0].believed);
}

TEST(Landmarks, SomethingFalseCloseBesideOneDoesNotMakeTwoOfIt) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 40; ++i) {
    const double j = i % 2 == 0 ? 0.05 : -0.05;
    std::vector<base::VisionLandmark> told{{"cone", {2.0, 0.3 + j, 0.0}}};
    if (i % 10 == 5) told.push_back({"cone", {2.1, 0.45, 0.0}});
    marks.take(image(told, now += 100ms), {}, {}, 0.5, {});
    EXPECT_EQ(marks.all().size(), 1U) << i;
  }
  EXPECT_NEAR(marks.all()[0].at.y, 0.3, 0.03);
}

TEST(Landmarks, TwoBesideEachOtherStayTwo) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 10; ++i) {
    const double j = i % 2 == 0 ? 0.1 : -0.1;
    marks.take(image({{"a", {2.0, 0.3 + j, 0.0}}, {"b", {2.0, -0.3 + j, 0.0}}}, now += 100ms), {},
               {}, 0.5, {});
  }
  const auto all = marks.all();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "a");
  EXPECT_EQ(all[1].name, "b");
}

//  two programs on one camera, one of which knows no cones
TEST(Landmarks, WhoNeverToldOneDoesNotDenyIt) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 3; ++i) {
    marks.take(image({{"cone", {2.0, 0.2, 0.0}}}, now += 50ms), {}, {}, 0.5, {}, 1);
    marks.take(image({}, now += 50ms), {}, {}, 0.5, {}, 2);
  }
  ASSERT_EQ(marks.all().size(), 1U);
  EXPECT_TRUE(marks.all()[0].believed);
}

TEST(Landmarks, TwoCamerasThatLookAtOnceForgetWhatIsGoneAfterForget) {
  Landmarks marks;
  base::Time now{1h};
  const auto both_tell = [&](const std::vector<base::VisionLandmark>& told) {
    marks.take(image(told, now += 99ms), {}, {}, 0.5, {}, 1);
    marks.take(image(told, now += 1ms), {}, {}, 0.5, {}, 2);
  };
  for (int i = 0; i < 5; ++i) both_tell({{"cone", {2.0, 0.2, 0.0}}});
  for (int i = 0; i < 9; ++i) both_tell({});
  EXPECT_EQ(marks.all().size(), 1U) << "0.9 s of each is no 1.8 s";
  for (int i = 0; i < 3; ++i) both_tell({});
  EXPECT_TRUE(marks.all().empty());
}

TEST(Landmarks, ThoseThatTellOneAreThoseThatToldItLast) {
  Landmarks marks;
  base::Time now{1h};
  const auto tell = [&](std::size_t eye, int times) {
    for (int i = 0; i < times; ++i) {
      marks.take(image({{"cone", {2.0, 0.2, 0.0}}}, now += 100ms), {}, {}, 0.5, {}, eye);
    }
    return marks.all().at(0).eyes;
  };
  EXPECT_EQ(tell(1, 5), eye_of(1));
  EXPECT_EQ(tell(0, 3), eye_of(0) | eye_of(1));
  EXPECT_EQ(tell(0, 17), eye_of(0)) << "it left the other one's view";
}

TEST(Landmarks, OutOfViewTheyAreKeptForAMinuteOfDrivingNotOfStanding) {
  Landmarks marks;
  base::Time now{1h};
  for (int i = 0; i < 5; ++i) {
    marks.take(image({{"cone", {2.0, 0.0, 0.0}}}, now += 100ms), {}, {}, 0.5, {});
  }
  Pose2 turned{0.0, 0.0, base::kPi};
  for (int i = 0; i < 1200; ++i) marks.take(image({}, now += 500ms), {}, turned, 0.5, {});
  EXPECT_EQ(marks.all().size(), 1U) << "ten minutes of standing";
  for (int i = 0; i < 140; ++i) {
    turned.x_m -= 0.2;
    marks.take(image({}, now += 500ms), {}, turned, 0.5, {});
  }
  EXPECT_TRUE(marks.all().empty()) << "70 s of driving";
}

}  // namespace
}  // namespace roverd::nav::marks
