// Parameters that are changed while the robot drives.

#include "field.hpp"

namespace roverd::robot {
namespace {

TEST(Parameters, AreListedWithTheirDefaults) {
  Field f;
  const auto all = f.robot.parameters();
  EXPECT_GT(all.size(), 80u);
  for (const Parameter& p : all) {
    EXPECT_EQ(p.info.value, p.initial) << p.section << p.info.name;
    EXPECT_FALSE(p.info.description.empty());
  }
}

TEST(Parameters, ActAtTheNextTickWhileDriving) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(SetParameter{"nav.speed.max_mps", 0.3}));
  f.run(2.0);
  EXPECT_LT(f.command.twist.linear_mps, 0.32);
  EXPECT_GT(f.command.twist.linear_mps, 0.2);
  EXPECT_EQ(f.robot.config()->speed.max_mps, 0.3);
  EXPECT_TRUE(f.has_event("safety_parameter"));
}

TEST(Parameters, AreRefusedWithAReasonAndChangeNothing) {
  Field f;
  f.run(0.1);
  const auto of = [&](const char* name, base::ParamValue value) {
    const auto done = f.ask(SetParameter{name, std::move(value)});
    return done ? std::string("done") : done.error().detail;
  };
  EXPECT_EQ(of("nav.speed.nothing", 1.0), "there is no parameter nav.speed.nothing");
  EXPECT_EQ(of("nothing", 1.0), "there is no parameter nothing");
  EXPECT_EQ(of("nav.speed.max_mps", 99.0), "nav.speed.max_mps must lie in 0.1 .. 5.0");
  EXPECT_EQ(of("nav.speed.max_mps", std::nan("")), "nav.speed.max_mps must lie in 0.1 .. 5.0");
  EXPECT_EQ(of("nav.wall.distance_m", 0.05), "nav.wall.distance_m must lie in 0.1 .. 20.0");
  EXPECT_EQ(of("nav.wall.offset_gain", 5.0), "nav.wall.offset_gain must lie in 0.25 .. 4.0");
  EXPECT_EQ(of("nav.landmarks.heading_gain", 0.1),
            "nav.landmarks.heading_gain must lie in 0.5 .. 3.0");
  EXPECT_EQ(of("nav.landmarks.corner_m", 0.3), "nav.landmarks.corner_m must lie in 0.01 .. 0.2");
  EXPECT_EQ(of("nav.sight.max_yaw_rate_radps", 0.0),
            "nav.sight.max_yaw_rate_radps must lie in 0.1 .. 5.0");
  EXPECT_EQ(of("nav.speed.max_mps", true), "nav.speed.max_mps must be a number");
  EXPECT_EQ(of("nav.behave.unreachable", std::string("fly")),
            "nav.behave.unreachable must be stop, skip or return, is \"fly\"");
  EXPECT_EQ(of("nav.speed.min_mps", 1.0),
            "nav.speed.reverse_max_mps must not be below "
            "nav.speed.min_mps");
  EXPECT_EQ(of("vehicle.kinematics", std::string("ackermann")),
            "vehicle.kinematics acts at the next start of the program");
  EXPECT_EQ(f.robot.config()->speed.max_mps, Config{}.speed.max_mps);
}

/// What the estimator takes as its first guess means nothing later; all else of it acts at once.
TEST(Parameters, OnlyWhatIsBelievedAtFirstWaitsForTheNextStart) {
  EXPECT_TRUE(acts_at_next_start("nav.estimate", "map_lat"));
  EXPECT_FALSE(acts_at_next_start("nav.estimate", "satellites_min"));
  EXPECT_FALSE(acts_at_next_start("nav.track", "map_lat"));
  EXPECT_TRUE(acts_at_next_start("vehicle", "wheelbase_m"));
}

/// File, change and start ask the same check: one text, whoever hears it.
TEST(Parameters, WhatAStartWouldRefuseAChangeRefusesInTheSameWords) {
  struct Wrong {
    const char* name;
    base::ParamValue value;
    void (*put)(Config&);
    const char* text;
  };
  const std::vector<Wrong> all{
      {"nav.track.law", std::string("zigzag"), [](Config& c) { c.track.law = "zigzag"; },
       "nav.track.law must be path_frame, pure_pursuit or stanley, is \"zigzag\""},
      {"battery.curve", std::string("garbage"), [](Config& c) { c.battery.curve = "garbage"; },
       "battery.curve: \"garbage\" must be a voltage (0 to 1000) and a charge (0 to 100)"},
      {"vehicle.kinematics", std::string("boat"), [](Config& c) { c.vehicle.kinematics = "boat"; },
       "vehicle.kinematics must be skid_steer, differential or ackermann, is \"boat\""},
      {"radio.knob_low", std::string("by_knob"), [](Config& c) { c.radio.knob_low = "by_knob"; },
       "radio.knob_low cannot be by_knob: the knob would ask itself"},
      {"nav.speed.min_mps", 1.0, [](Config& c) { c.speed.min_mps = 1.0; },
       "nav.speed.reverse_max_mps must not be below nav.speed.min_mps"},
      {"nav.modes.follow_brake_s", 9.0, [](Config& c) { c.modes.follow_brake_s = 9.0; },
       "nav.modes.follow_hold_s must not be below nav.modes.follow_brake_s"},
      {"nav.rows.low_m", 1.5, [](Config& c) { c.rows.low_m = 1.5; },
       "nav.rows.low_m must be smaller than high_m"},
      // Half of the vehicle is 0.39 m.
      {"nav.wall.distance_m", 0.38, [](Config& c) { c.wall.distance_m = 0.38; },
       "nav.wall.distance_m must be more than half of vehicle.width_m"},
      {"nav.landmarks.offset_m", 0.6, [](Config& c) { c.landmarks.offset_m = 0.6; },
       "nav.landmarks.offset_m must be more than half of vehicle.width_m and 0.25 m of a landmark"},
      {"nav.wall.heading_gain", 0.5, [](Config& c) { c.wall.gains.heading = 0.5; },
       "nav.wall.heading_gain must leave nav.track.damping times it, over the root of offset_gain, "
       "from 0.5 to 3.0"},
      {"nav.landmarks.offset_gain", 4.0, [](Config& c) { c.landmarks.gains.offset = 4.0; },
       "nav.landmarks.heading_gain must leave nav.track.damping times it, over the root of "
       "offset_gain, from 0.5 to 3.0"},
      {"robot.safety.gnss_slow_s", 50.0, [](Config& c) { c.safety.gnss_slow_s = 50.0; },
       "robot.safety.gnss_hold_s must not be below robot.safety.gnss_slow_s"},
      {"robot.safety.sigma_slow_m", 9.0, [](Config& c) { c.safety.sigma_slow_m = 9.0; },
       "robot.safety.sigma_hold_m must not be below robot.safety.sigma_slow_m"},
      {"robot.safety.battery_stop_pct", 50.0, [](Config& c) { c.safety.battery_stop_pct = 50.0; },
       "robot.safety.battery_warn_pct must not be below robot.safety.battery_stop_pct"},
  };
  Field f;
  f.run(0.1);
  for (const Wrong& wrong : all) {
    Config config;
    wrong.put(config);
    const auto start = check(config);
    ASSERT_FALSE(start) << wrong.name;
    EXPECT_EQ(start.error().detail, wrong.text);
    const auto change = f.robot.check_parameter(wrong.name, wrong.value);
    ASSERT_FALSE(change) << wrong.name;
    EXPECT_EQ(change.error().detail, wrong.text);
    EXPECT_EQ(change.error().fields.at(0).pointer, "/value");
  }
  EXPECT_FALSE(f.has_event("parameter"));
}

/// What an item without a distance takes of a vehicle that is too wide for it is refused when it is
/// to be driven; that vehicle starts as it did.
TEST(Parameters, TheDistancesOfTheFieldMayStandForAWideVehicle) {
  Config wide;
  wide.vehicle.width_m = 2.0;
  EXPECT_TRUE(check(wide));
  wide.wall.distance_m = 0.8;
  EXPECT_FALSE(check(wide));
}

/// Each law is held within what its own parameters may be; of the others nothing is asked.
TEST(Parameters, TheGainsAreBoundedByTheLawInUse) {
  Config c;
  c.track.settle_min_m = 0.2;
  c.wall.gains = {4.0, 2.0};
  ASSERT_FALSE(check(c));
  EXPECT_EQ(check(c).error().fields.at(0).pointer, "nav.wall.offset_gain");
  c.track.law = "pure_pursuit";
  EXPECT_TRUE(check(c));
  c.track.lookahead_min_m = 0.3;
  EXPECT_FALSE(check(c));
  c.track.law = "stanley";
  EXPECT_TRUE(check(c));
  c.track.stanley_gain_1ps = 3.0;
  EXPECT_FALSE(check(c));
}

/// With the gains as they are at first nothing is driven otherwise than any other way.
TEST(Parameters, WallsAndLandmarksAreDrivenAsAllElseUntilTheyAreToldOtherwise) {
  Config c;
  c.track.settle_min_m = 1.2;
  c.track.damping = 0.7;
  c.speed.max_yaw_rate_radps = 0.6;
  for (const nav::PathParams& p : {c.wall_path(), c.landmark_path()}) {
    EXPECT_EQ(p.track.settle_min_m, 1.2);
    EXPECT_EQ(p.track.settle_time_s, c.track.settle_time_s);
    EXPECT_EQ(p.track.damping, 0.7);
    EXPECT_EQ(p.track.lookahead_min_m, c.track.lookahead_min_m);
    EXPECT_EQ(p.track.stanley_gain_1ps, c.track.stanley_gain_1ps);
    EXPECT_EQ(p.speed.max_yaw_rate_radps, 0.6);
  }
  c.wall.gains = {4.0, 2.0};
  c.sight.max_yaw_rate_radps = 0.4;
  EXPECT_EQ(c.wall_path().track.settle_min_m, 0.6) << "half as long: four times as hard";
  EXPECT_EQ(c.wall_path().track.damping, 0.7);
  EXPECT_EQ(c.wall_path().speed.max_yaw_rate_radps, 0.4);
  EXPECT_EQ(c.landmark_path().track.settle_min_m, 1.2) << "each has its own";
}

/// The order in which the store tells them is not the one in which they were changed.
TEST(Parameters, KeptOnesGoInTogetherAndWhatIsNotTakenIsTold) {
  Config config;
  const auto refused = take_kept(config, {{"nav.speed.max_mps", 0.1},
                                          {"nav.speed.min_mps", 0.05},
                                          {"nav.track.gone_m", 2.0},
                                          {"nav.track.law", std::string("zigzag")},
                                          {"nav.track.settle_min_m", 99.0},
                                          {"radio.swb_down_blocks_swa", 1.0}});
  EXPECT_EQ(config.speed.max_mps, 0.1);
  EXPECT_EQ(config.speed.min_mps, 0.05);
  EXPECT_EQ(config.track.law, "path_frame");
  EXPECT_EQ(config.track.settle_min_m, Config{}.track.settle_min_m);
  EXPECT_EQ(refused, (std::vector<std::string>{
                         "there is no parameter nav.track.gone_m",
                         "nav.track.law must be path_frame, pure_pursuit or stanley, is \"zigzag\"",
                         "nav.track.settle_min_m must lie in 0.15 .. 20.0",
                         "radio.swb_down_blocks_swa must be true or false"}));
}

/// Every number to its ends, one after the other, while a mission runs: never away from the path.
TEST(Parameters, ExtremeValuesWhileDrivingNeverLeadAway) {
  for (const bool high : {false, true}) {
    Field f;
    f.run(8.0);
    ASSERT_TRUE(f.load(plan_of({{0, 20}, {10, 20}, {10, 0}, {0, 0}})));
    ASSERT_TRUE(f.ask(Arm{}));
    ASSERT_TRUE(f.ask(StartMission{"m", 1}));
    for (const Parameter& p : f.robot.parameters()) {
      const bool steers = p.section == "nav.track" || p.section == "nav.speed" ||
                          p.section == "nav.pivot" || p.section == "nav.behave";
      if (!steers || !p.info.min) continue;
      const std::string name = p.section + "." + p.info.name;
      (void)f.ask(SetParameter{name, high ? *p.info.max : *p.info.min});
      f.run(0.4);
      EXPECT_GT(f.at.east_m, -4.0) << name;
      EXPECT_LT(f.at.east_m, 14.0) << name;
      EXPECT_GT(f.at.north_m, -4.0) << name;
      EXPECT_LT(f.at.north_m, 24.0) << name;
    }
    for (int i = 0; i < 60; ++i) {
      f.run(1.0);
      ASSERT_LT(std::max(std::abs(f.at.east_m - 5.0), std::abs(f.at.north_m - 10.0)), 15.0);
    }
  }
}

TEST(Parameters, OfAConfigurationByTheirFullName) {
  Config c;
  ASSERT_TRUE(set_parameter(c, "vehicle.wheelbase_m", 2.0));
  EXPECT_EQ(c.vehicle.wheelbase_m, 2.0);
  EXPECT_FALSE(set_parameter(c, "vehicle.kinematics", std::string("boat")));
}

}  // namespace
}  // namespace roverd::robot
