// What cannot be driven because nobody sees, what was measured in vain, and the dock.

#include "seeing.hpp"

namespace roverd::robot {
namespace {

TEST_F(Seeing, ABlindSensorIsALineOfTheChecksAndRefusesAStart) {
  field.run(8.0);
  ASSERT_TRUE(field.load(plan_of({{0, 20}})));
  ASSERT_TRUE(field.ask(Arm{}));
  EXPECT_TRUE(field.check("sensors").ok);
  EXPECT_TRUE(field.robot.objections(StartMission{"m", 1}).empty());
  health = base::SensorHealth::Blind;
  field.run(1.0);
  EXPECT_FALSE(field.check("sensors").ok);
  EXPECT_EQ(field.check("sensors").detail,
            "the sensor front does not see: the glass is blocked: nothing drives by itself");
  EXPECT_TRUE(field.state()->ready_to_arm) << "a hand may drive";
  const auto against = field.robot.objections(StartMission{"m", 1});
  ASSERT_EQ(against.size(), 1u);
  EXPECT_EQ(against[0].code, "sensor_blind");
  const auto start = field.ask(StartMission{"m", 1});
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().detail.find("front does not see"), std::string::npos);
}

TEST_F(Seeing, AMissionThatWasPausedByABlindSensorWaitsForAWordAndIsToldThatItSees) {
  field.drive_mission();
  heard = false;
  field.run(1.0);
  ASSERT_EQ(field.execution(), ExecutionState::Paused);
  heard = true;
  field.run(4.0);
  EXPECT_FALSE(field.has_event("sees_again"));
  field.run(30.0);
  EXPECT_TRUE(field.has_event("sees_again"));
  EXPECT_EQ(field.execution(), ExecutionState::Paused);
}

TEST_F(Seeing, WhereItIsChosenItGoesOnByItselfAfterTheTime) {
  BlockedParams blocked;
  blocked.resume_blind = true;
  blocked.resume_after_s = 2.0;
  field.robot.guard_by({}, true, blocked);
  field.drive_mission();
  heard = false;
  field.run(1.0);
  ASSERT_EQ(field.execution(), ExecutionState::Paused);
  // What sees for a moment only does not count.
  heard = true;
  field.run(1.5);
  heard = false;
  field.run(1.0);
  heard = true;
  field.run(1.8);
  EXPECT_EQ(field.execution(), ExecutionState::Paused);
  field.run(2.0);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
  EXPECT_TRUE(field.has_event("sees_again"));
  EXPECT_TRUE(field.moves());
}

TEST_F(Seeing, WhoeverSaysPauseMeanwhileIsObeyed) {
  BlockedParams blocked;
  blocked.resume_blind = true;
  blocked.resume_after_s = 2.0;
  field.robot.guard_by({}, true, blocked);
  field.drive_mission();
  heard = false;
  field.run(1.0);
  ASSERT_TRUE(field.ask(PauseMission{}));
  heard = true;
  field.run(10.0);
  EXPECT_EQ(field.execution(), ExecutionState::Paused);
  EXPECT_FALSE(field.moves());
}

TEST_F(Seeing, ACalibrationThatIsStoppedSaysByWhat) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  for (int i = 0; i < 500; ++i) {  // the heading is known then
    field.robot.request(Drive{{0.5, 0.0}, true}, field.now + std::chrono::seconds(1), {});
    field.tick();
  }
  field.let_go();
  field.run(2.0);
  const auto begun = field.ask(Calibrate{base::CalibrationKind::Drive});
  ASSERT_TRUE(begun) << begun.error().detail;
  wall_at(driven_m() + 2.0);
  field.run(60.0);
  const base::CalibrationState& drive = field.state()->calibration;
  EXPECT_NE(drive.phase, base::CalibrationPhase::Running);
  EXPECT_NE(drive.phase, base::CalibrationPhase::Done);
  EXPECT_NE(drive.reason.find("something stands in the way"), std::string::npos) << drive.reason;
}

class Docking : public Seeing {
 protected:
  /// To a place 4 m ahead, whose dock stands so far before the nose.
  void dock(double before_m, nav::sense::ProtectParams params = {}) {
    field.robot.guard_by(params);
    field.run(8.0);
    ASSERT_TRUE(field.ask(Arm{}));
    wall_m = 4.0 + 0.5 * VehicleLength + before_m;
    SetMode to;
    to.mode = Mode::Dock;
    to.goal.emplace();
    to.goal->at = kFrame.to_global({0.0, 4.0});
    to.goal->yaw_rad = base::kPi / 2.0;
    const auto taken = field.ask(to);
    ASSERT_TRUE(taken) << taken.error().detail;
    field.run(60.0);
  }
};

TEST_F(Docking, TheDockItselfStopsNobodyWhoDocks) {
  dock(0.05);
  EXPECT_TRUE(field.has_event("docked"));
  EXPECT_NEAR(driven_m(), 4.0, 0.06);
}

TEST_F(Docking, WithoutThatItStandsBeforeTheDock) {
  nav::sense::ProtectParams params;
  params.dock_m = 0.0;
  dock(0.05, params);
  EXPECT_FALSE(field.has_event("docked"));
  EXPECT_FALSE(field.moves());
  EXPECT_LT(driven_m(), 3.95);
}

TEST_F(Docking, ItComesToTheDockNoFasterThanAHandPassesTheGuard) {
  double fastest_mps = 0.0;
  field.more = [&] {
    look();
    if (wall_m && driven_m() > 3.55 && driven_m() < 3.9) {
      fastest_mps = std::max(fastest_mps, field.command.twist.linear_mps);
    }
  };
  dock(0.05);
  EXPECT_TRUE(field.has_event("docked"));
  EXPECT_GT(fastest_mps, 0.05);
  EXPECT_LE(fastest_mps, nav::sense::ProtectParams{}.override_mps + 1e-6);
}

TEST_F(Docking, ACrateRightBeforeTheDockStopsIt) {
  dock(-0.15);
  EXPECT_FALSE(field.has_event("docked"));
  EXPECT_FALSE(field.moves());
  EXPECT_GT(gap_m(), 0.05);
}

TEST_F(Docking, WhereTheGroundEndsIsNoDock) {
  wall_is = Known::Drop;
  dock(0.05);
  EXPECT_FALSE(field.has_event("docked"));
  EXPECT_FALSE(field.moves());
  EXPECT_GT(gap_m(), 0.05);
}

TEST_F(Docking, WhatStandsBeforeTheDockIsNotTheDock) {
  dock(-0.45);
  EXPECT_FALSE(field.has_event("docked"));
  EXPECT_FALSE(field.moves());
  EXPECT_GT(gap_m(), 0.05);
}

}  // namespace
}  // namespace roverd::robot
