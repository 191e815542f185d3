// How closely paths are followed: a fast part of what `roverd study` measures (tests/bench: all of
// it), each figure against the true pose.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "source_folder.hpp"
#include "study/study.hpp"

namespace roverd::study {
namespace {

Course course_of(std::vector<base::EnuPoint> points, double speed_mps = 1.0) {
  Course c;
  c.name = "test";
  c.points = std::move(points);
  c.speed_mps = speed_mps;
  return c;
}

Disturbance hard(double delay_s = 0.15, double lag_s = 0.09) {
  Disturbance d;
  d.name = "bunker";
  d.sim = {
      {"drive.slip", 0.08},   {"drive.side_difference", 0.02},      {"drive.delay_s", delay_s},
      {"drive.lag_s", lag_s}, {"gnss.profile", std::string("rtk")}, {"gnss.noise_scale", 1.44}};
  d.robot = {"nav.track.delay_s=" + std::to_string(delay_s + lag_s)};
  return d;
}

study::Run drive(const Course& course, const Disturbance& disturbance, std::uint64_t seed = 1,
                 const std::string& vehicle = "bunker") {
  study::Setup setup;
  setup.config = tests::in_source("config/robot.toml");
  setup.vehicle = vehicle;
  auto run = run_one(setup, {&course, &disturbance, seed});
  if (!run) {
    ADD_FAILURE() << run.error().detail;
    return {};
  }
  EXPECT_EQ(run->problem, "");
  return *run;
}

//   1 ───── 2
//   │
//   0
TEST(Course, AnLIsFollowedToCentimetresAndInTime) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto run = drive(course_of({{0, 0}, {0, 20}, {20, 20}}), hard(), seed);
    EXPECT_LT(run.truth.cross.rms_m, 0.035) << seed;
    EXPECT_LT(run.truth.cross.p95_m, 0.07) << seed;
    EXPECT_LT(run.truth.cross.max_m, 0.15) << seed;
    EXPECT_LT(run.truth.corner_mean_m, 0.05) << seed;
    EXPECT_LT(run.truth.slalom_max_m, 0.04) << seed;
    EXPECT_LT(run.truth.time_s, 51.7) << seed;
    EXPECT_LT(run.truth.end_m, 0.08) << seed;
  }
}

//      ╱╲    ╱╲
//   0 ╱  ╲__╱  ╲__ : 60 deg each, turned on the spot
TEST(Course, AZigzagToo) {
  const auto run =
      drive(course_of({{0, 0}, {3, 5.196}, {9, 5.196}, {12, 10.392}, {18, 10.392}}), hard());
  EXPECT_LT(run.truth.cross.rms_m, 0.035);
  EXPECT_LT(run.truth.cross.max_m, 0.15);
  EXPECT_LT(run.truth.corner_max_m, 0.08);
  EXPECT_LT(run.truth.slalom_mean_m, 0.04);
}

TEST(Course, AnIdealVehicleLeavesNoErrorOfTheTracker) {
  Disturbance ideal;
  ideal.name = "ideal";
  ideal.sim = {{"drive.slip", 0.0},
               {"drive.side_difference", 0.0},
               {"drive.slip_wander", 0.0},
               {"drive.turn_loss", 1.0},
               {"drive.pivot_centre_m", 0.0},
               {"drive.delay_s", 0.0},
               {"drive.lag_s", 0.0},
               {"drive.turn_decel_radps2", 10.0},
               {"drive.turn_accel_radps2", 10.0},
               {"gnss.noise_scale", 0.0},
               {"compass.bias_deg", 0.0},
               {"compass.noise_deg", 0.0},
               {"compass.kick_deg_per_a", 0.0}};
  ideal.robot = {"nav.track.delay_s=0", "nav.estimate.yaw_scale=1"};
  const auto run = drive(course_of({{0, 0}, {0, 12}, {12, 12}}), ideal);
  EXPECT_LT(run.truth.cross.rms_m, 0.02);
  EXPECT_LT(run.truth.cross.max_m, 0.03);
}

//   the first waypoint lies straight behind: no loop, no swing
TEST(Course, TurnsRoundForAFirstWaypointBehindIt) {
  Course c = course_of({{0, 0}, {0, -12}});
  c.start_heading_deg = 0.0;
  for (const std::uint64_t seed : {1u, 2u}) {
    const auto run = drive(c, hard(), seed);
    EXPECT_LT(run.truth.cross.max_m, 0.5);
    EXPECT_LT(run.truth.cross.rms_m, 0.06);
  }
}

//   ║ 0 ⇄ 1 ║   1.5 m between the walls
TEST(Course, AUTurnFitsIntoACorridor) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const auto run = drive(course_of({{0, 0}, {0, 8}, {0, 0}}), hard(), seed);
    EXPECT_LT(run.swept_half_width_m, 0.75);
  }
}

TEST(Course, WithAConsumerReceiverItFollowsWhatItBelieves) {
  Disturbance d = hard();
  d.sim[4].second = std::string("consumer");
  d.sim[5].second = 1.0;
  const auto run = drive(course_of({{0, 0}, {0, 20}, {20, 20}}), d, 2);
  EXPECT_LT(run.believed.cross.rms_m, 0.10);
}

TEST(Course, NoDelayUpToFourTenthsMakesItWeave) {
  for (const double delay_s : {0.0, 0.1, 0.2, 0.3}) {
    const auto run = drive(course_of({{0, 0}, {0, 10}, {3, 20}, {3, 35}}), hard(delay_s, 0.1));
    EXPECT_LT(run.truth.slalom_max_m, 0.06) << delay_s;
    EXPECT_LT(run.truth.cross.rms_m, 0.035) << delay_s;
  }
}

TEST(Course, ADelayThatIsWrongByATenthIsStillStable) {
  for (const double wrong_s : {-0.1, 0.1}) {
    Disturbance d = hard(0.2, 0.1);
    d.robot = {"nav.track.delay_s=" + std::to_string(0.3 + wrong_s)};
    const auto run = drive(course_of({{0, 0}, {0, 10}, {3, 20}, {3, 35}}), d);
    EXPECT_LT(run.truth.slalom_max_m, 0.15) << wrong_s;
    EXPECT_LT(run.truth.cross.max_m, 0.2) << wrong_s;
  }
}

TEST(Course, ADelayThatIsWrongByTwoTenthsIsLearnedBeforeItWeaves) {
  for (const double wrong_s : {-0.2, 0.2}) {
    Disturbance d = hard(0.25, 0.1);
    d.robot = {"nav.track.delay_s=" + std::to_string(0.35 + wrong_s)};
    const auto run = drive(course_of({{0, 0}, {0, 20}, {20, 20}}), d);
    EXPECT_LT(run.truth.cross.max_m, 0.1) << wrong_s;
    EXPECT_LT(run.truth.cross.rms_m, 0.025) << wrong_s;
  }
}

//   1 ─────── 2     at every corner it stops, and turns on the spot
//   │   4 ─ 3 │
//   0   └───▶       its brakes are half as good as they are taken for, and nobody said so
TEST(Course, BrakesHalfAsGoodAreSeenAtTheFirstStop) {
  for (const std::uint64_t seed : {1u, 2u}) {
    Disturbance d = hard();
    d.sim.emplace_back("drive.decel_mps2", 0.3);
    d.sim.emplace_back("drive.accel_mps2", 0.5);
    const auto run =
        drive(course_of({{0, 0}, {0, 12}, {12, 12}, {12, 0}, {4, 0}, {4, 8}}), d, seed);
    EXPECT_LT(run.truth.cross.max_m, 0.3) << seed;
    double later_m = 0.0;
    for (const nav::Matched& at : run.matched) {
      if (at.s_m > 30.0) later_m = std::max(later_m, std::abs(at.cross_m));
    }
    EXPECT_LT(later_m, 0.1) << seed;
  }
}

TEST(Course, TheOtherLawsDriveToo) {
  for (const std::string law : {"pure_pursuit", "stanley"}) {
    Disturbance d = hard();
    d.robot.push_back("nav.track.law=" + law);
    const auto run = drive(course_of({{0, 0}, {0, 12}, {12, 12}}), d);
    EXPECT_LT(run.truth.cross.rms_m, 0.06) << law;
    EXPECT_LT(run.truth.cross.max_m, 0.15) << law;
  }
}

TEST(Course, ReversesAlongAPathAsClosely) {
  Course c = course_of({{0, 0}, {0, 10}}, 0.5);
  c.reverse = true;
  c.start_heading_deg = 180.0;
  const auto run = drive(c, hard());
  EXPECT_LT(run.truth.cross.rms_m, 0.06);
  EXPECT_LT(run.truth.cross.max_m, 0.15);
}

TEST(Course, ACarAtTwoMetresASecondStaysWithinItsCorners) {
  Disturbance d;
  d.name = "car";
  d.sim = {{"drive.delay_s", 0.1},        {"drive.lag_s", 0.1},         {"car.wheel_lag_s", 0.1},
           {"drive.max_linear_mps", 2.5}, {"device.feedback_hz", 50.0}, {"imu.fitted", true}};
  d.robot = {"vehicle.max_speed_mps=2.5",           "nav.speed.max_mps=2.5",
             "nav.speed.lateral_mps2=1.0",          "nav.track.delay_s=0.2",
             "drivers.ackermann.max_speed_mps=2.5", "drivers.mti.enabled=true"};
  const auto run = drive(course_of({{0, 0}, {0, 30}, {30, 30}}, 2.0), d, 1, "uku");
  EXPECT_LT(run.truth.corner_max_m, 0.20);
  EXPECT_LT(run.truth.slalom_mean_m, 0.10);
}

TEST(Course, TheSameSeedDrivesTheSameWay) {
  const Course c = course_of({{0, 0}, {0, 8}});
  const auto a = drive(c, hard(), 7);
  const auto b = drive(c, hard(), 7);
  EXPECT_EQ(a.truth.cross.rms_m, b.truth.cross.rms_m);
  EXPECT_NE(a.truth.cross.rms_m, drive(c, hard(), 8).truth.cross.rms_m);
}

TEST(Course, WhatIsSetWronglyIsToldByName) {
  study::Setup setup;
  setup.config = tests::in_source("config/robot.toml");
  setup.vehicle = "bunker";
  const Course c = course_of({{0, 0}, {0, 8}});
  Disturbance d = hard();
  d.robot = {"nav.track.law=zigzag"};
  const auto refused = run_one(setup, {&c, &d, 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail,
            "--set nav.track.law=zigzag must be path_frame, pure_pursuit or stanley, is "
            "\"zigzag\"");
}

//   the point of a tool on a circle of 5 m; the vehicle itself goes beside it
TEST(Course, AToolsPointIsLedAlongTheWayInPlaceOfTheVehicle) {
  std::vector<base::EnuPoint> round;
  for (int i = 0; i <= 18; ++i) {
    const double at = base::rad_from_deg(10.0 * i);
    round.push_back({5.0 - 5.0 * std::cos(at), 5.0 * std::sin(at)});
  }
  for (const auto& tool :
       std::vector<std::vector<std::string>>{{"nav.tool.forward_m=0.6", "nav.tool.left_m=0.4"},
                                             {"nav.tool.forward_m=-0.8"},
                                             {"nav.tool.hitch_m=0.5", "nav.tool.trailer_m=1.2"}}) {
    Disturbance d = hard();
    d.robot.insert(d.robot.end(), tool.begin(), tool.end());
    const auto run = drive(course_of(round), d);
    EXPECT_LT(run.truth.cross.rms_m, 0.03) << tool[0];
    EXPECT_LT(run.truth.end_m, 0.06) << tool[0];
  }
}

}  // namespace
}  // namespace roverd::study
