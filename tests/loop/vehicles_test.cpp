// Every vehicle that is shipped does the main job with its own kinematics, judged by the true pose.

#include "source_folder.hpp"
#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

/// One L, and how near the true body comes to what was asked.
struct Job {
  const char* vehicle;
  double leg_m;  ///< a car wants room to come back to the line after a corner
  double speed_mps;
  /// A vehicle that turns on the spot goes to the corner. A car's swing is planned 0.1 m beside it,
  /// and pure pursuit cuts by about lookahead²/8R more: 0.24 m (uku), 0.26 m (imiev).
  double corner_m;
  double end_m;
};

void PrintTo(const Job& job, std::ostream* out) {
  *out << job.vehicle;
}

const Job kUku{"uku", 20.0, 1.2, 0.40, 0.15};
const Job kImiev{"imiev", 40.0, 1.2, 0.40, 0.15};
const Job kSpotTurners[] = {{"probot", 6.0, 0.5, 0.15, 0.15},
                            {"donkey", 8.0, 0.5, 0.15, 0.15},
                            {"husky", 8.0, 0.8, 0.15, 0.15}};

class EachCart : public testing::TestWithParam<std::tuple<Job, int>> {
 protected:
  Job job() const { return std::get<0>(GetParam()); }
  CartOptions options() const {
    return {.vehicle = job().vehicle,
            .seed = static_cast<std::uint64_t>(std::get<1>(GetParam())),
            .heading_deg = 70.0};
  }
};
INSTANTIATE_TEST_SUITE_P(Loop, EachCart,
                         testing::Combine(testing::Values(kUku, kImiev, kSpotTurners[0],
                                                          kSpotTurners[1], kSpotTurners[2]),
                                          testing::Values(1, 2, 3)),
                         [](const auto& made) {
                           return std::get<0>(made.param).vehicle + std::string("_") +
                                  std::to_string(std::get<1>(made.param));
                         });

//             3
//             │
//   0 ─ 1 ──▶ 2     starts at 0, looking 20 deg to the left of the way
TEST_P(EachCart, DrivesAnLThroughItsCornerAndStopsAtTheEnd) {
  const double leg = job().leg_m;
  CartRig rig(options());
  rig.arm_and_start(rig.plan_of({{leg / 4.0, 0}, {leg, 0}, {leg, leg}}, job().speed_mps));
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({leg / 4.0, 0}), 0.3);
  EXPECT_LT(rig.nearest_m({leg, 0}), job().corner_m);
  EXPECT_LT(rig.distance_to_m({leg, leg}), job().end_m);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  const double most_mps = plant_of(job().vehicle).drive.max_linear_mps;
  EXPECT_LE(rig.fastest_mps, most_mps);
}

TEST_P(EachCart, StandsWhenTheDriveLinkDies) {
  CartRig rig(options());
  rig.arm_and_start(rig.plan_of({{job().leg_m, 0}}, job().speed_mps));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 1.5; }, 60.0));
  rig.fault([](sim::Faults& f) { f.bus_off = true; });
  rig.run(4.0);  // the device's own watchdog, and its brakes
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.truth().control_mode, base::ControlMode::Standby);
}

TEST_P(EachCart, HoldsWithoutGnssAndGoesOnWithIt) {
  CartRig rig(options());
  const double leg = job().leg_m;
  rig.arm_and_start(rig.plan_of({{leg, 0}}, job().speed_mps));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 1.5; }, 60.0));
  rig.fault([](sim::Faults& f) { f.gnss_outage = true; });
  ASSERT_TRUE(rig.run_until([&] { return rig.execution() != ExecutionState::Running; }, 20.0));
  rig.run(3.0);
  EXPECT_TRUE(rig.stands());
  rig.fault([](sim::Faults&) {});
  rig.run(6.0);
  const auto resumed = rig.ask(robot::ResumeMission{});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  ASSERT_TRUE(rig.finish(200.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({leg, 0}), 0.3);
}

TEST_P(EachCart, DrivesOnWhenEveryTenthMessageIsLost) {
  CartRig rig(options());
  const double leg = job().leg_m;
  rig.fault([](sim::Faults& f) { f.loss_to_base = f.loss_from_base = 0.1; });
  rig.arm_and_start(rig.plan_of({{leg, 0}}, job().speed_mps));
  ASSERT_TRUE(rig.finish(200.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({leg, 0}), 0.3);
}

/// The Bunker does what the others do, with its shipped profile.
TEST(Vehicles, TheBunkerDrivesTheSameL) {
  Rig rig({.heading_deg = 70.0, .plant = plant_of("bunker"), .robot = settings_of("bunker").robot});
  rig.arm_and_start(rig.plan_of({{2, 0}, {8, 0}, {8, 8}}));
  ASSERT_TRUE(rig.finish(200.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({8, 0}), 0.15);
  EXPECT_LT(rig.distance_to_m({8, 8}), 0.15);
  EXPECT_TRUE(rig.stands());
}

//   1 ──── 2      the page's main job: 8 m to each side of the start, which is in the middle; twice
//     0    │      that for the i-MiEV, which needs 23 m to swing round a corner of 90 deg
//   4 ──── 3
TEST(Vehicles, EachDoesTheMainJobOfThePage) {
  for (const char* vehicle : {"uku", "imiev", "probot", "donkey", "husky"}) {
    SCOPED_TRACE(vehicle);
    const double half_m = vehicle == std::string("imiev") ? 16.0 : 8.0;
    const std::vector<Metres> square{{-half_m, half_m},
                                     {half_m, half_m * 1.1},
                                     {half_m * 1.2, -half_m * 0.6},
                                     {-half_m * 0.8, -half_m}};
    CartRig rig({.vehicle = vehicle, .heading_deg = 40.0});
    rig.arm_and_start(rig.plan_of(square));
    ASSERT_TRUE(rig.finish(400.0)) << rig.state()->mission.reason;
    for (const Metres& m : square) EXPECT_LT(rig.nearest_m(m), 0.5);
    EXPECT_LT(rig.distance_to_m(square.back()), 0.15);
    EXPECT_TRUE(rig.stands());
  }
}

class EachCar : public testing::TestWithParam<Job> {};
INSTANTIATE_TEST_SUITE_P(Loop, EachCar, testing::Values(kUku, kImiev),
                         [](const auto& made) { return std::string(made.param.vehicle); });

//         2
//         │       the stop at 1 forbids the swing: it goes round with full lock
//   0 ──▶ 1 ╮
TEST_P(EachCar, GoesRoundWhenItHasStoppedAtASharpCorner) {
  const double leg = GetParam().leg_m;
  CartRig rig({.vehicle = GetParam().vehicle, .heading_deg = 90.0});
  rig.arm_and_start(rig.plan_of({{leg, 0}, {leg, leg}}, 1.0));
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({leg, 0}), 0.2);
  EXPECT_LT(rig.distance_to_m({leg, leg}), GetParam().end_m);
}

//   ╭ ◀ 0 ────────▶ 1     the way lies behind it: a wide turn, then back to the line
//   ╰──────▶
TEST_P(EachCar, NeverTurnsNarrowerThanItsLock) {
  const double leg = 45.0;
  const sim::CarParams car = plant_of(GetParam().vehicle).car;
  CartRig rig({.vehicle = GetParam().vehicle, .heading_deg = 250.0});
  rig.arm_and_start(rig.plan_of({{leg, 0}}, 1.0));
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  const double most_1pm = std::tan(car.max_wheel_rad + std::abs(car.linkage_rad)) / car.wheelbase_m;
  for (const sim::Truth& t : rig.track) {
    EXPECT_LE(std::abs(t.twist.angular_radps), std::abs(t.twist.linear_mps) * most_1pm + 1e-9);
  }
}

/// A steering zero that is 3 deg off must not let the vehicle drive beside the straight.
double beside_the_straight_m(const std::string& vehicle, double sim::CarParams::*zero,
                             double leg_m) {
  CartRig rig({.vehicle = vehicle, .heading_deg = 90.0, .change_plant = [zero](sim::Params& p) {
                 p.car.linkage_rad = p.car.servo_rad = 0.0;
                 p.car.*zero = 0.052;
               }});
  rig.arm_and_start(rig.plan_of({{leg_m, 0}}, 1.0));
  EXPECT_TRUE(rig.run_until([&] { return rig.truth().local.east_m > leg_m / 2.0; }, 100.0));
  rig.track.clear();
  EXPECT_TRUE(rig.finish(100.0)) << rig.state()->mission.reason;
  return rig.farthest_from_line_m({0, 0}, {leg_m, 0});
}

TEST_P(EachCar, StaysOnTheStraightWithASteeringZeroThatIsOff) {
  const std::string vehicle = GetParam().vehicle;
  EXPECT_LT(beside_the_straight_m(vehicle, &sim::CarParams::linkage_rad, GetParam().leg_m), 0.15);
  EXPECT_LT(beside_the_straight_m(vehicle, &sim::CarParams::servo_rad, GetParam().leg_m), 0.15);
}

TEST(Vehicles, TheHuskysBumperLatchesTheStop) {
  CartRig rig({.vehicle = "husky", .heading_deg = 90.0});
  rig.arm_and_start(rig.plan_of({{8, 0}}, 0.8));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 2.0; }, 60.0));
  rig.fault([](sim::Faults& f) { f.bumper = 1; });
  rig.run(0.2);
  rig.fault([](sim::Faults&) {});
  rig.run(2.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_TRUE(rig.state()->estop);
  EXPECT_LT(rig.distance_to_m({2, 0}), 1.0);
}

TEST(Vehicles, TheHuskyStandsWhileItsBumperIsNotHeard) {
  CartRig rig({.vehicle = "husky", .heading_deg = 90.0});
  rig.arm_and_start(rig.plan_of({{8, 0}}, 0.8));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 2.0; }, 60.0));
  rig.fault([](sim::Faults& f) { f.bumper_silent = true; });
  rig.run(4.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_TRUE(rig.has_condition("driver_hazard"));
}

TEST(Vehicles, AnEmergencyStopAtTheDonkeyIsTold) {
  CartRig rig({.vehicle = "donkey", .heading_deg = 90.0});
  rig.arm_and_start(rig.plan_of({{8, 0}}, 0.5));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 2.0; }, 60.0));
  rig.fault([](sim::Faults& f) { f.estop = true; });
  rig.run(2.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_TRUE(rig.has_condition("base_estop"));
}

TEST(Vehicles, AnUnknownWordForTheKinematicsIsRefused) {
  const auto refused = load_settings({.config = tests::in_source("config/robot.toml"),
                                      .vehicle = "uku",
                                      .overrides = {"vehicle.kinematics=ackerman"}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail,
            "--set vehicle.kinematics=ackerman must be skid_steer, differential or ackermann, is "
            "\"ackerman\"");
}

/// What the navigation believes, what the driver may send, and what the vehicle can do: one story.
TEST(Vehicles, ProfileAndPlantAgree) {
  for (const char* name : {"uku", "imiev"}) {
    const Settings s = settings_of(name);
    const sim::Params p = plant_of(name);
    EXPECT_EQ(s.robot.vehicle.kinematics, "ackermann") << name;
    EXPECT_EQ(s.robot.vehicle.wheelbase_m, p.car.wheelbase_m) << name;
    EXPECT_EQ(s.ackermann.params.wheelbase_m, p.car.wheelbase_m) << name;
    EXPECT_EQ(s.ackermann.params.max_wheel_rad, p.car.max_wheel_rad) << name;
    EXPECT_LE(base::rad_from_deg(s.robot.vehicle.max_steering_deg), p.car.max_wheel_rad) << name;
    EXPECT_LE(base::rad_from_deg(s.robot.vehicle.max_steering_rate_dps), p.car.wheel_rate_radps)
        << name;
    EXPECT_LE(s.robot.vehicle.max_speed_mps, p.drive.max_linear_mps) << name;
    EXPECT_EQ(s.robot.estimate.antenna_forward_m, p.gnss.antenna_forward_m) << name;
    EXPECT_TRUE(s.ackermann.wiring.enabled) << name;
  }
  for (const char* name : {"probot", "donkey", "husky", "bunker"}) {
    const Settings s = settings_of(name);
    const sim::Params p = plant_of(name);
    EXPECT_EQ(s.robot.vehicle.kinematics,
              name == std::string("probot") ? "differential" : "skid_steer");
    EXPECT_EQ(s.robot.estimate.track_width_m, p.drive.track_width_m) << name;
    EXPECT_LE(s.robot.vehicle.max_speed_mps, p.drive.max_linear_mps) << name;
  }
  EXPECT_EQ(settings_of("probot").ratio.params.track_width_m, 0.4);
  EXPECT_EQ(settings_of("husky").twist.params.form, "text");
  EXPECT_EQ(settings_of("donkey").twist.params.form, "binary");
}

}  // namespace
}  // namespace roverd::loop
