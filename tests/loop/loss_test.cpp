// What happens when something is lost: the robot stops, says why, and does not go on by itself.
// The radio's take-over is the one exception.

#include "rig.hpp"

namespace roverd::loop {
namespace {

class Loss : public testing::TestWithParam<std::uint64_t> {
 protected:
  /// Somewhere on a 20 m line northwards.
  std::unique_ptr<Rig> driving(bool gyro = true) {
    RigOptions o;
    o.seed = GetParam();
    o.plant.imu.fitted = gyro;
    auto rig = std::make_unique<Rig>(o);
    rig->arm_and_start(rig->plan_of({{0, 20}}));
    EXPECT_TRUE(rig->run_until([&] { return rig->truth().driven_m > 5.0; }, 60.0));
    return rig;
  }
};
INSTANTIATE_TEST_SUITE_P(Loop, Loss, testing::Values(1, 2));

void expect_paused(Rig& rig, const std::string& condition) {
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  EXPECT_NE(rig.state()->mission.reason, "");
  EXPECT_TRUE(rig.has_condition(condition)) << condition;
}

TEST_P(Loss, TheEmergencyStopStopsAtOnceAndStaysUntilItIsReset) {
  auto rig = driving();
  ASSERT_TRUE(rig->ask(robot::Estop{"anna"}));
  const auto at = rig->truth().local;
  rig->run(3.0);
  EXPECT_TRUE(rig->stands());
  EXPECT_LT(base::distance_m(at, rig->truth().local), 0.6);
  EXPECT_TRUE(rig->state()->estop);
  EXPECT_FALSE(rig->state()->armed);
  EXPECT_FALSE(rig->ask(robot::ResumeMission{}));
  EXPECT_FALSE(rig->ask(robot::Arm{}));
  ASSERT_TRUE(rig->ask(robot::ResetEstop{}));
  EXPECT_FALSE(rig->state()->armed);
  EXPECT_EQ(rig->state()->mode, Mode::Hold);
  ASSERT_TRUE(rig->ask(robot::Arm{}));
  ASSERT_TRUE(rig->ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig->finish(60.0));
  EXPECT_LT(rig->distance_to_m({0, 20}), 0.2);
}

TEST_P(Loss, TheButtonAtTheBaseLatchesOurStopAndMustBeReleasedFirst) {
  auto rig = driving();
  rig->fault([](sim::Faults& f) { f.estop = true; });
  rig->run(2.0);
  EXPECT_TRUE(rig->stands());
  EXPECT_TRUE(rig->state()->estop);
  EXPECT_TRUE(rig->has_condition("base_estop"));
  EXPECT_FALSE(rig->ask(robot::ResetEstop{}));
  rig->fault([](sim::Faults&) {});
  rig->run(1.0);
  EXPECT_TRUE(rig->state()->estop);
  EXPECT_TRUE(rig->ask(robot::ResetEstop{}));
  EXPECT_FALSE(rig->state()->estop);
}

TEST_P(Loss, TheRadioTakesOverAndTheMissionGoesOnFromTheSamePlace) {
  auto rig = driving();
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  radio.left_lr = 0.6;
  radio.right_ud = 0.5;
  rig->plant.set_radio(radio);
  rig->run(4.0);
  EXPECT_EQ(rig->state()->control, base::Driver::Radio);
  EXPECT_EQ(rig->execution(), ExecutionState::Running);
  EXPECT_EQ(rig->state()->mode, Mode::Auto);
  EXPECT_GT(std::abs(rig->truth().local.east_m), 0.5);  // the sticks led it off the line
  EXPECT_EQ(rig->state()->command, base::DriveCommand{});
  rig->plant.set_radio({});
  ASSERT_TRUE(rig->finish(90.0)) << rig->state()->mission.reason;
  EXPECT_LT(rig->distance_to_m({0, 20}), 0.2);
  EXPECT_TRUE(rig->has_event("radio_takeover"));
  EXPECT_TRUE(rig->has_event("radio_released"));
}

TEST_P(Loss, ARadioThatIsLostStopsTheRobotEvenWithoutAFlagFromTheBase) {
  for (const bool flagged : {true, false}) {
    auto rig = driving();
    const auto at = rig->truth().local;
    rig->fault([&](sim::Faults& f) {
      f.radio_loss = true;
      f.radio_loss_unflagged = !flagged;
    });
    rig->run(3.0);
    expect_paused(*rig, "radio_lost");
    EXPECT_LT(base::distance_m(at, rig->truth().local), 1.5);
    rig->fault([](sim::Faults&) {});
    rig->run(3.0);
    EXPECT_TRUE(rig->stands());
    EXPECT_EQ(rig->execution(), ExecutionState::Paused);
    ASSERT_TRUE(rig->ask(robot::ResumeMission{}));
    ASSERT_TRUE(rig->finish(90.0));
    EXPECT_LT(rig->distance_to_m({0, 20}), 0.2);
  }
}

TEST_P(Loss, ARadioWhoseCounterStandsStillCountsAsLost) {
  auto rig = driving();
  rig->fault([](sim::Faults& f) {
    f.radio_freeze = true;
    f.radio_loss_unflagged = true;
  });
  rig->run(3.0);
  expect_paused(*rig, "radio_lost");
}

TEST_P(Loss, ABusThatGoesSilentStopsTheRobotAndItSaysSo) {
  auto rig = driving();
  rig->fault([](sim::Faults& f) { f.bus_off = true; });
  rig->run(3.0);
  expect_paused(*rig, "base_lost");
  rig->fault([](sim::Faults&) {});
  rig->run(5.0);
  EXPECT_TRUE(rig->stands());
  EXPECT_EQ(rig->execution(), ExecutionState::Paused);
  EXPECT_FALSE(rig->has_condition("base_lost"));
  ASSERT_TRUE(rig->ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig->finish(90.0)) << rig->state()->mission.reason;
  EXPECT_LT(rig->distance_to_m({0, 20}), 0.2);
}

TEST_P(Loss, OneFrameInTwentyMayGetLost) {
  RigOptions o;
  o.seed = GetParam();
  Rig rig(o);
  rig.fault([](sim::Faults& f) {
    f.loss_to_base = 0.05;
    f.loss_from_base = 0.05;
  });
  rig.arm_and_start(rig.plan_of({{0, 6}, {6, 6}}));
  ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 6}), 0.3);
  EXPECT_LT(rig.distance_to_m({6, 6}), 0.3);
}

TEST_P(Loss, WithoutAGyroAShortOutageOfGnssIsDrivenThroughSlowlyALongOneStops) {
  auto rig = driving(false);
  rig->fault([](sim::Faults& f) { f.gnss_outage = true; });
  rig->run(4.0);
  EXPECT_EQ(rig->execution(), ExecutionState::Running);
  EXPECT_TRUE(rig->has_condition("gnss_lost"));
  EXPECT_LT(rig->truth().twist.linear_mps, 0.5);
  rig->fault([](sim::Faults&) {});
  rig->run(2.0);
  EXPECT_EQ(rig->execution(), ExecutionState::Running);
  EXPECT_FALSE(rig->has_condition("gnss_lost"));
  rig->fault([](sim::Faults& f) { f.gnss_silent = true; });
  rig->run(10.0);
  EXPECT_TRUE(rig->stands());
  EXPECT_EQ(rig->execution(), ExecutionState::Paused);
  EXPECT_LT(rig->farthest_from_line_m({0, 0}, {0, 20}), 0.5);
}

TEST_P(Loss, AJumpOfGnssForFiveSecondsDoesNotMoveTheRobot) {
  auto rig = driving();
  // For so long that a wrong receiver would have contradicted itself
  ASSERT_TRUE(rig->run_until([&] { return rig->truth().driven_m > 12.0; }, 30.0));
  rig->fault([](sim::Faults& f) {
    f.gnss_jump_east_m = 3.0;
    f.gnss_jump_s = 5.0;
  });
  rig->run(5.0);
  EXPECT_LT(rig->position_error_m(), 0.5);
  ASSERT_TRUE(rig->run_until([&] { return rig->execution() == ExecutionState::Finished; }, 90.0))
      << rig->state()->mission.reason;
  EXPECT_LT(rig->farthest_from_line_m({0, 0}, {0, 20}), 0.5);
}

TEST_P(Loss, ARobotWhoseTracksAreHeldFastStopsTryingAndSaysSo) {
  auto rig = driving();
  auto p = rig->plant.params();
  p.drive.max_linear_mps = p.drive.max_angular_radps = 0.0;  // as if the tracks were chained
  rig->plant.set_params(p);
  rig->run(3.0);
  expect_paused(*rig, "base_not_following");
}

// Frames from the base arrive, none to it do.
TEST_P(Loss, ABaseThatHearsNoCommandIsNamedAndTheMissionWaitsForAnOperator) {
  for (const bool leaves_can : {false, true}) {
    SCOPED_TRACE(leaves_can ? "goes to standby by itself" : "stays in CAN mode");
    auto rig = driving();
    auto p = rig->plant.params();
    p.drive.timeout_leaves_can = leaves_can;
    rig->plant.set_params(p);
    // When the way to the base is lost,
    rig->fault([](sim::Faults& f) { f.loss_to_base = 1.0; });
    rig->run(1.5);
    // then that is named within 1.5 s, and the mission waits.
    const char* condition = leaves_can ? "base_not_ready" : "base_not_following";
    EXPECT_TRUE(rig->has_condition(condition));
    EXPECT_TRUE(rig->has_event(leaves_can ? "base_left_control" : "base_not_following"));
    EXPECT_EQ(rig->state()->mode, Mode::Hold);
    rig->run(3.0);
    expect_paused(*rig, condition);
    // Resumed while it is still lost, it is refused or stops again.
    if (rig->ask(robot::ResumeMission{})) rig->run(2.0);
    EXPECT_EQ(rig->execution(), ExecutionState::Paused);
    // When frames arrive again, the robot still stands until an operator goes on.
    rig->fault([](sim::Faults&) {});
    rig->run(5.0);
    EXPECT_TRUE(rig->stands());
    EXPECT_EQ(rig->execution(), ExecutionState::Paused);
    ASSERT_TRUE(rig->ask(robot::ResumeMission{}));
    ASSERT_TRUE(rig->finish(90.0)) << rig->state()->mission.reason;
    EXPECT_LT(rig->distance_to_m({0, 20}), 0.2);
    EXPECT_FALSE(rig->has_condition(condition));
    EXPECT_TRUE(rig->has_event(leaves_can ? "base_back" : "base_follows"));
  }
}

TEST_P(Loss, ABaseThatIsSwitchedOffAndOnHoldsTheMission) {
  for (const double off_s : {0.0, 0.2, 3.0}) {
    SCOPED_TRACE(off_s);
    auto rig = driving();
    rig->fault([&](sim::Faults& f) { f.bus_off = off_s > 0.0; });
    rig->run(off_s);
    rig->plant.power_cycle();
    rig->fault([](sim::Faults&) {});
    rig->run(4.0);
    EXPECT_TRUE(rig->stands());
    EXPECT_EQ(rig->state()->mode, Mode::Hold);
    EXPECT_EQ(rig->execution(), ExecutionState::Paused);
    EXPECT_NE(rig->state()->mission.reason, "");
    EXPECT_TRUE(rig->has_event("mission_paused"));
    EXPECT_TRUE(rig->has_event(off_s < 0.4 ? "base_left_control" : "driver_down"));
    EXPECT_TRUE(rig->has_event(off_s < 0.4 ? "base_back" : "driver_up"));
    ASSERT_TRUE(rig->ask(robot::ResumeMission{}));
    ASSERT_TRUE(rig->finish(90.0)) << rig->state()->mission.reason;
    EXPECT_LT(rig->distance_to_m({0, 20}), 0.2);
  }
}

TEST_P(Loss, WithAGyroItDrivesOnWithoutGnssAsFarAsItMay) {
  RigOptions o;
  o.seed = GetParam();
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 25}, {0, 50}, {0, 75}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 5.0; }, 60.0));
  const double sigma_m = rig.state()->pose->horizontal_sigma_m;
  rig.fault([](sim::Faults& f) { f.gnss_outage = true; });
  const double from_m = rig.truth().driven_m;
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > from_m + 30.0; }, 90.0));
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
  EXPECT_TRUE(rig.has_condition("gnss_lost"));
  EXPECT_EQ(rig.state()->pose->source, "odometry");
  // It knows less and less, says so, and is not farther off than that.
  EXPECT_GT(rig.state()->pose->horizontal_sigma_m, 3.0 * sigma_m);
  EXPECT_LT(rig.position_error_m(), 3.0 * rig.state()->pose->horizontal_sigma_m);
  EXPECT_LT(rig.position_error_m(), 0.6);
  rig.run(20.0);
  expect_paused(rig, "gnss_lost");
  EXPECT_NEAR(rig.truth().driven_m - from_m, 35.0, 2.0);
  EXPECT_FALSE(rig.ask(robot::ResumeMission{}));
  rig.fault([](sim::Faults&) {});
  rig.run(3.0);
  EXPECT_TRUE(rig.ask(robot::ResumeMission{}));
}

TEST_P(Loss, AGyroThatFallsSilentIsReplacedByTheTracksAndComesBack) {
  auto rig = driving();
  EXPECT_TRUE(rig->state()->estimator.gyro);
  rig->fault([](sim::Faults& f) { f.imu_silent = true; });
  rig->run(3.0);
  EXPECT_FALSE(rig->state()->estimator.gyro);
  EXPECT_TRUE(rig->has_event("gyro_lost"));
  EXPECT_TRUE(rig->has_condition("gyro_lost"));
  EXPECT_LT(std::abs(rig->yaw_error_deg()), 2.0);
  rig->fault([](sim::Faults&) {});
  rig->events.clear();
  rig->run(3.0);
  EXPECT_TRUE(rig->state()->estimator.gyro);
  EXPECT_TRUE(rig->has_event("gyro_back"));
  ASSERT_TRUE(rig->finish(60.0)) << rig->state()->mission.reason;
  EXPECT_LT(rig->farthest_from_line_m({0, 0}, {0, 20}), 0.3);
}

TEST_P(Loss, WhatIsWrongWithThePositionStaysListedWhileTheRobotHolds) {
  auto rig = driving(false);
  rig->fault([](sim::Faults& f) { f.gnss_outage = true; });
  rig->run(12.0);
  expect_paused(*rig, "gnss_lost");
  rig->run(30.0);
  EXPECT_TRUE(rig->has_condition("gnss_lost"));
  ASSERT_TRUE(rig->ask(robot::SetMode{Mode::Manual}));
  rig->run(1.0);
  EXPECT_EQ(rig->state()->mode, Mode::Manual);  // driving by hand needs no position
  EXPECT_TRUE(rig->has_condition("gnss_lost"));
  rig->fault([](sim::Faults&) {});
  rig->run(3.0);
  EXPECT_FALSE(rig->has_condition("gnss_lost"));
}

TEST_P(Loss, AnEmptyBatteryStopsTheMission) {
  auto rig = driving();
  rig->plant.set_battery_pct(4.0);
  rig->run(4.0);
  EXPECT_TRUE(rig->stands());
  EXPECT_EQ(rig->execution(), ExecutionState::Paused);
  EXPECT_TRUE(rig->has_condition("battery"));
}

// The same losses in the middle of a turn on the spot, while reversing, and close to the goal.
TEST_P(Loss, ALossWhilePivotingReversingOrArrivingStopsJustAsWell) {
  const std::vector<std::pair<std::string, void (*)(sim::Faults&)>> losses{
      {"base_lost", [](sim::Faults& f) { f.bus_off = true; }},
      {"radio_lost", [](sim::Faults& f) { f.radio_loss = true; }},
  };
  const std::vector<std::pair<std::string, bool (*)(Rig&)>> moments{
      {"pivoting", [](Rig& r) { return std::abs(r.truth().twist.angular_radps) > 0.3; }},
      {"reversing", [](Rig& r) { return r.truth().twist.linear_mps < -0.2; }},
      {"arriving",
       [](Rig& r) {
         return r.state()->mission.current_item == 2 && r.distance_to_m({-2, 5}) < 0.15;
       }},
  };
  for (const auto& [condition, lose] : losses) {
    for (const auto& [moment, is_now] : moments) {
      SCOPED_TRACE(condition + " while " + moment);
      RigOptions o;
      o.seed = GetParam();
      Rig rig(o);
      auto plan = rig.plan_of({{3, 5}, {-2, 5}});
      std::get<mission::Waypoint>(plan.items[1]).reverse = true;
      rig.arm_and_start(plan);
      ASSERT_TRUE(rig.run_until([&, now = is_now] { return now(rig); }, 90.0));
      rig.fault(lose);
      rig.run(2.5);
      expect_paused(rig, condition);
      rig.fault([](sim::Faults&) {});
      rig.run(3.0);
      EXPECT_TRUE(rig.stands());
      ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
      ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
      EXPECT_LT(rig.distance_to_m({-2, 5}), 0.2);
    }
  }
}

TEST_P(Loss, ARadioTakeOverDuringATurnOnTheSpotIsGivenBackToTheSameTurn) {
  RigOptions o;
  o.seed = GetParam();
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 5}, {5, 5}}));
  ASSERT_TRUE(rig.run_until(
      [&] {
        return rig.nearest_m({0, 5}) < 0.2 && rig.truth().twist.angular_radps < -0.2;
      },
      60.0));
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  rig.plant.set_radio(radio);
  rig.run(3.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.state()->mission.current_item, 2);
  rig.plant.set_radio({});
  ASSERT_TRUE(rig.finish(60.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({5, 5}), 0.2);
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 5}, {5, 5}}), 0.3);
}

TEST(LossOnce, DrivingByHandStopsWithoutFreshCommandsAndWantsTheHandleLetGo) {
  Rig rig({});
  rig.arm();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Manual}));
  rig.let_go();
  for (int i = 0; i < 100; ++i) {
    rig.drive(0.5, 0.0);
    rig.tick();
  }
  EXPECT_EQ(rig.state()->control, base::Driver::Teleop);
  EXPECT_GT(rig.truth().twist.linear_mps, 0.3);
  rig.run(1.5);
  EXPECT_TRUE(rig.stands());
  EXPECT_TRUE(rig.has_condition("teleop_stale"));
  for (int i = 0; i < 50; ++i) {
    rig.drive(0.5, 0.0);
    rig.tick();
  }
  EXPECT_TRUE(rig.stands());
  rig.drive(0.0, 0.0, false);
  for (int i = 0; i < 50; ++i) {
    rig.tick();
    rig.drive(0.5, 0.0);
  }
  EXPECT_GT(rig.truth().twist.linear_mps, 0.3);
  rig.drive(0.5, 0.0, false);
  rig.run(1.0);
  EXPECT_TRUE(rig.stands());
}

TEST(LossOnce, NothingMovesThatIsNotArmed) {
  Rig rig({});
  rig.run(8.0);
  rig.load(rig.plan_of({{0, 5}}));
  EXPECT_FALSE(rig.ask(robot::StartMission{"m1", 1}));
  EXPECT_FALSE(rig.ask(robot::SetMode{Mode::Auto}));
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Manual}));
  for (int i = 0; i < 100; ++i) {
    rig.drive(0.5, 0.2);
    rig.tick();
  }
  EXPECT_LT(rig.truth().driven_m, 0.001);
  EXPECT_EQ(rig.truth().commands, 0u);
}

}  // namespace
}  // namespace roverd::loop
