// The guided calibration drive with the whole robot: what it measures against what the plant is
// made of, what ends it, and what is kept of it.

#include "robot/calibration.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

using base::CalibrationKind;
using base::CalibrationPhase;
using base::Quantity;

base::CalibrationValue of(const RigBase& rig, Quantity q) {
  const base::CalibrationState& c = rig.state()->calibration;
  for (std::size_t i = 0; i < c.count; ++i) {
    if (c.values[i].of == q) return c.values[i];
  }
  ADD_FAILURE() << to_string(q) << " is not measured";
  return {};
}
double value(const RigBase& rig, Quantity q) {
  return of(rig, q).after.value_or(std::nan(""));
}

CalibrationPhase phase(const RigBase& rig) {
  return rig.state()->calibration.phase;
}

/// Some metres with RTK, so that the heading is known; then back to rest.
void settle(RigBase& rig) {
  rig.arm();
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->pose.has_value(); }, 10.0));
  robot::MoveBy ahead;
  ahead.forward_m = 6.0;
  ahead.speed_mps = 0.5;
  const auto moved = rig.ask(ahead);
  ASSERT_TRUE(moved) << moved.error().detail;
  rig.run_until([&] { return rig.has_event("goal_reached") || rig.has_event("goal_failed"); },
                60.0);
  rig.run(2.0);
  rig.track.clear();
}

void calibrate(RigBase& rig, CalibrationKind kind, double limit_s = 240.0) {
  const auto begun = rig.ask(robot::Calibrate{kind});
  ASSERT_TRUE(begun) << begun.error().detail;
  ASSERT_TRUE(rig.run_until([&] { return phase(rig) != CalibrationPhase::Running; }, limit_s));
  ASSERT_EQ(phase(rig), CalibrationPhase::Done) << rig.state()->calibration.reason;
}

void expect_figures(const RigBase& rig, double delay_s, double braking_mps2, double turn_scale) {
  EXPECT_NEAR(value(rig, Quantity::SteeringDelay), delay_s, 0.03);
  EXPECT_NEAR(value(rig, Quantity::Braking), braking_mps2, 0.1 * braking_mps2);
  EXPECT_NEAR(value(rig, Quantity::TurnScale), turn_scale, 0.02 * turn_scale);
}

TEST(Calibration, OfTheBunkerMeetsItsFiguresWithinTwoMinutes) {
  Rig rig({.seed = 3});
  settle(rig);
  const base::EnuPoint from = rig.truth().local;
  const double began_s = rig.now_s();
  calibrate(rig, CalibrationKind::Drive);
  const sim::DriveParams& p = rig.plant.params().drive;
  expect_figures(rig, p.delay_s + p.lag_s, p.decel_mps2, (1.0 - p.slip) / p.turn_loss);
  EXPECT_NEAR(value(rig, Quantity::SpeedScale), 1.0 - p.slip, 0.015);
  EXPECT_NEAR(value(rig, Quantity::SideBias), 0.0256, 0.008);
  EXPECT_LT(rig.now_s() - began_s, 150.0);
  EXPECT_LT(base::distance_m(from, rig.truth().local), 0.6);
  EXPECT_TRUE(rig.has_event("calibration_done"));
}

/// What else is done to the Bunker, by name.
struct Trial {
  const char* name;
  void (*change)(sim::DriveParams& p);
};
void PrintTo(const Trial& t, std::ostream* out) {
  *out << t.name;
}

class CalibrationFigures : public testing::TestWithParam<Trial> {};
INSTANTIATE_TEST_SUITE_P(
    Loop, CalibrationFigures,
    testing::Values(Trial{"level", [](sim::DriveParams&) {}},
                    Trial{"payload", [](sim::DriveParams& p) { p.payload = 2.0; }},
                    Trial{"one side slips", [](sim::DriveParams& p) { p.slip_right = 0.2; }},
                    Trial{"delay jitters", [](sim::DriveParams& p) {
                            p.delay_s = 0.1;
                            p.delay_jitter_s = 0.2;
                          }}));

TEST_P(CalibrationFigures, AreMetByTheBunker) {
  for (const std::uint64_t seed : std::array<std::uint64_t, 4>{11, 12, 13, 14}) {
    RigOptions o{.seed = seed};
    GetParam().change(o.plant.drive);
    Rig rig(o);
    settle(rig);
    calibrate(rig, CalibrationKind::Drive);
    const sim::DriveParams& p = o.plant.drive;
    const double grip = 1.0 - p.slip - 0.5 * p.slip_right;
    expect_figures(rig, p.delay_s + 0.5 * p.delay_jitter_s + p.lag_s, p.decel_mps2 / p.payload,
                   grip / p.turn_loss);
    EXPECT_NEAR(value(rig, Quantity::SpeedScale), grip, 0.02);
    if (p.payload == 1.0) continue;
    EXPECT_NEAR(value(rig, Quantity::Acceleration), p.accel_mps2 / p.payload, 0.05);
  }
}

TEST(Calibration, OfACarMeetsItsFigures) {
  for (const std::uint64_t seed : std::array<std::uint64_t, 2>{5, 6}) {
    CartRig rig({.vehicle = "imiev", .seed = seed});
    settle(rig);
    calibrate(rig, CalibrationKind::Drive);
    const sim::Params& p = rig.plant.params();
    expect_figures(rig, p.drive.delay_s + p.car.wheel_lag_s, p.drive.decel_mps2, 1.0);
  }
}

/// It tells nothing of itself: only its way shows.
TEST(Calibration, OfACarWithoutFeedbackTellsWhatItsWayShows) {
  CartRig rig({.vehicle = "uku", .seed = 5});
  settle(rig);
  calibrate(rig, CalibrationKind::Drive);
  EXPECT_NEAR(value(rig, Quantity::TurnScale), 1.0, 0.03);
  EXPECT_NEAR(value(rig, Quantity::SteeringZero), -rig.plant.params().car.linkage_rad, 0.006);
  EXPECT_FALSE(of(rig, Quantity::Braking).after);
  EXPECT_FALSE(of(rig, Quantity::SteeringDelay).after);
  const double zero = value(rig, Quantity::SteeringZero);
  ASSERT_TRUE(rig.ask(robot::SettleCalibration{.keep = true}));
  rig.tick();
  EXPECT_NEAR(rig.state()->estimator.pull_1pm, std::tan(zero) / 1.3, 1e-3);
  rig.run(2.0);
  ASSERT_TRUE(rig.robot.learned()->pull_1pm);
  EXPECT_NEAR(rig.robot.learned()->pull_1pm->value, std::tan(zero) / 1.3, 1e-6);
}

TEST(Calibration, WhatWasKeptBeginsTheNextStart) {
  nav::Learned known;
  known.yaw_scale = nav::LearnedValue{0.71, 0.005};
  known.pull_1pm = nav::LearnedValue{0.03, 0.003};
  known.acceleration_mps2 = nav::LearnedValue{0.5, 0.02};
  Rig rig({.seed = 9});
  rig.robot.recall(known);
  rig.run(5.0);
  EXPECT_TRUE(rig.state()->learned.kept);
  EXPECT_NEAR(rig.state()->learned.acceleration_used_mps2, 0.46, 1e-6);
  EXPECT_NEAR(rig.state()->estimator.pull_1pm, 0.03, 1e-6);
}

TEST(Calibration, WhatIsKeptIsUsedToldAndForgotten) {
  RigOptions o{.seed = 4};
  o.plant.drive.payload = 2.0;
  Rig rig(o);
  settle(rig);
  calibrate(rig, CalibrationKind::Drive);
  ASSERT_TRUE(rig.ask(robot::SettleCalibration{.keep = true}));
  rig.run(2.0);
  const base::VehicleLearned used = rig.state()->learned;
  EXPECT_TRUE(used.kept);
  EXPECT_NEAR(used.acceleration_used_mps2, 0.46, 0.05);
  EXPECT_LT(used.braking_used_mps2, 0.6);
  EXPECT_NEAR(used.delay_used_s, 0.15, 0.03);
  const auto file = rig.robot.learned();
  ASSERT_TRUE(file && file->yaw_scale && file->pull_1pm && file->acceleration_mps2);
  EXPECT_NEAR(file->yaw_scale->value, 0.92 / 1.3, 0.02);
  EXPECT_GT(file->yaw_scale->age_s, 1.0);
  EXPECT_FALSE(rig.ask(robot::SettleCalibration{.keep = true})) << "twice";
  ASSERT_TRUE(rig.ask(robot::ForgetCalibration{}));
  rig.run(2.0);
  EXPECT_FALSE(rig.state()->learned.kept);
  EXPECT_FALSE(rig.robot.learned()->yaw_scale);
  EXPECT_TRUE(rig.robot.learned()->forgotten);
  EXPECT_NEAR(rig.state()->learned.acceleration_used_mps2, 0.7, 1e-9);
}

TEST(Calibration, WhatIsDiscardedChangesNothing) {
  Rig rig({.seed = 4});
  settle(rig);
  const auto before = rig.state()->learned;
  calibrate(rig, CalibrationKind::Drive);
  ASSERT_TRUE(rig.ask(robot::SettleCalibration{.keep = false}));
  rig.tick();
  EXPECT_EQ(phase(rig), CalibrationPhase::None);
  EXPECT_EQ(rig.state()->learned.delay_used_s, before.delay_used_s);
  EXPECT_EQ(rig.state()->learned.braking_used_mps2, before.braking_used_mps2);
  EXPECT_FALSE(rig.robot.learned()->yaw_scale);
  EXPECT_FALSE(rig.ask(robot::SettleCalibration{.keep = false}));
}

TEST(Calibration, WhatOneKindMeasuredIsNotForgottenByKeepingAnother) {
  robot::KeptCalibration kept;
  nav::Learned drive;
  drive.yaw_scale = nav::LearnedValue{0.71, 0.005};
  kept.keep(drive, base::Time{});
  kept.keep({}, base::Time{std::chrono::seconds(5)});  // two antennas: nothing of this kind
  nav::Learned told;
  kept.tell(told, base::Time{std::chrono::seconds(60)});
  ASSERT_TRUE(told.yaw_scale);
  EXPECT_EQ(told.yaw_scale->value, 0.71);
  EXPECT_EQ(told.yaw_scale->age_s, 60.0);
  nav::Learned steering;
  steering.pull_1pm = nav::LearnedValue{0.02, 0.001};
  kept.keep(steering, base::Time{std::chrono::seconds(30)});
  nav::Learned both;
  kept.tell(both, base::Time{std::chrono::seconds(60)});
  EXPECT_TRUE(both.yaw_scale && both.pull_1pm);
}

TEST(Calibration, IsBegunFromHoldAndOnlyAtRest) {
  Rig rig({.seed = 6});
  settle(rig);
  // While it drives to a goal: its space would lie elsewhere.
  robot::MoveBy ahead;
  ahead.forward_m = 4.0;
  ASSERT_TRUE(rig.ask(ahead));
  rig.run(3.0);
  const auto rolling = rig.ask(robot::Calibrate{});
  ASSERT_FALSE(rolling);
  EXPECT_NE(rolling.error().detail.find("moves"), std::string::npos) << rolling.error().detail;
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Hold}));
  rig.run(3.0);
  ASSERT_TRUE(rig.ask(robot::Calibrate{}));
  rig.run(15.0);
  EXPECT_EQ(phase(rig), CalibrationPhase::Running) << rig.state()->calibration.reason;
}

/// A drive that was begun, and 15 s of it.
class CalibrationEnds : public testing::Test {
 protected:
  void SetUp() override {
    settle(rig);
    ASSERT_TRUE(rig.ask(robot::Calibrate{}));
    rig.run(15.0);
    ASSERT_EQ(phase(rig), CalibrationPhase::Running);
  }
  void expect_aborted(const std::string& why) {
    rig.run(0.1);
    EXPECT_EQ(phase(rig), CalibrationPhase::Aborted);
    EXPECT_NE(rig.state()->calibration.reason.find(why), std::string::npos)
        << rig.state()->calibration.reason;
    rig.run(3.0);
    EXPECT_TRUE(rig.stands());
    EXPECT_EQ(rig.state()->activity.state, base::ActivityState::Failed);
    const auto kept = rig.ask(robot::SettleCalibration{.keep = true});
    ASSERT_FALSE(kept);
    EXPECT_EQ(kept.error().code, base::Code::Conflict);
    EXPECT_FALSE(rig.state()->learned.kept);
  }
  Rig rig{{.seed = 6}};
};

TEST_F(CalibrationEnds, AtTheEmergencyStop) {
  ASSERT_TRUE(rig.ask(robot::Estop{"a person"}));
  expect_aborted("emergency stop");
}

TEST_F(CalibrationEnds, AtAnotherMode) {
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Hold}));
  expect_aborted("HOLD");
}

TEST_F(CalibrationEnds, WhenTheRobotIsDisarmed) {
  ASSERT_TRUE(rig.ask(robot::Disarm{}));
  expect_aborted("disarmed");
}

TEST_F(CalibrationEnds, WhenThePositionIsLost) {
  rig.fault([](sim::Faults& f) { f.gnss_outage = true; });
  ASSERT_TRUE(rig.run_until([&] { return phase(rig) != CalibrationPhase::Running; }, 30.0));
  EXPECT_EQ(rig.state()->calibration.reason, "no position came for 2 s");
  rig.run(3.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_FALSE(rig.ask(robot::SettleCalibration{.keep = true}));
}

TEST_F(CalibrationEnds, WhenTheRadioTakesOverAndDoesNotGoOnByItself) {
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  rig.plant.set_radio(radio);
  rig.run(2.0);
  EXPECT_EQ(phase(rig), CalibrationPhase::Aborted);
  radio.swb = base::Switch::Up;
  rig.plant.set_radio(radio);
  expect_aborted("radio");
}

TEST_F(CalibrationEnds, AtAnotherGoal) {
  robot::MoveBy ahead;
  ahead.forward_m = 1.0;
  ASSERT_TRUE(rig.ask(ahead));
  rig.tick();
  EXPECT_EQ(phase(rig), CalibrationPhase::Aborted);
  EXPECT_NE(rig.state()->calibration.reason.find("else to do: move"), std::string::npos);
}

TEST_F(CalibrationEnds, BeforeAnythingCouldBeKept) {
  const auto kept = rig.ask(robot::SettleCalibration{.keep = true});
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().detail.find("still measures"), std::string::npos);
  EXPECT_EQ(phase(rig), CalibrationPhase::Running);
}

TEST(CalibrationRefused, WhereItCannotBeDriven) {
  Rig rig({.seed = 7});
  rig.run(5.0);
  EXPECT_FALSE(rig.ask(robot::Calibrate{})) << "not armed";
  settle(rig);
  const auto steering = rig.ask(robot::Calibrate{CalibrationKind::Steering});
  ASSERT_FALSE(steering);
  EXPECT_NE(steering.error().detail.find("steered"), std::string::npos);
  EXPECT_FALSE(rig.ask(robot::Calibrate{CalibrationKind::Antennas})) << "none are heard";
  EXPECT_FALSE(rig.ask(robot::SettleCalibration{.keep = false})) << "nothing was measured";
  EXPECT_FALSE(rig.ask(robot::ForgetCalibration{})) << "nothing was kept";
}

TEST(CalibrationRefused, WhereTheFigureWouldLeaveTheFence) {
  Rig rig({.seed = 8});
  settle(rig);
  const auto asked = rig.robot.calibration(CalibrationKind::Drive);
  ASSERT_TRUE(asked && asked->possible) << asked->reason;
  ASSERT_EQ(asked->corners.size(), 4u);
  EXPECT_GT(asked->seconds, 60.0);
  EXPECT_LT(asked->seconds, 150.0);
  // Room to stand and to drive, but less than the figure needs ahead.
  const base::EnuPoint here = rig.truth().local;
  mission::Fence fence;
  fence.name = "narrow";
  mission::FencePolygon around;
  for (const Metres& m : {Metres{-8.0, -8.0}, {8.0, -8.0}, {8.0, 5.0}, {-8.0, 5.0}}) {
    around.points.push_back(rig.place({here.east_m + m.east_m, here.north_m + m.north_m}));
  }
  fence.areas.push_back({mission::AreaKind::Inclusion, around});
  ASSERT_TRUE(
      rig.ask(robot::SetFence{rig.robot.lay_fence(std::make_shared<const mission::Fence>(fence))}));
  const auto refused = rig.ask(robot::Calibrate{});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("leave the fence"), std::string::npos);
  const auto shown = rig.robot.calibration(CalibrationKind::Drive);
  ASSERT_TRUE(shown);
  EXPECT_FALSE(shown->possible);
  EXPECT_EQ(shown->reason, refused.error().detail);
}

}  // namespace
}  // namespace roverd::loop
