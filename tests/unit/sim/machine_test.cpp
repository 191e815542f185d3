// Every arrow of the base's mode machine, its watchdog, its faults.

#include <gtest/gtest.h>

#include "plant.hpp"

namespace roverd::sim {
namespace {

using base::ControlMode;
using base::Switch;
using base::VehicleState;

void set_swb(Plant& plant, Switch position) {
  Radio radio = plant.bunker.radio();
  radio.swb = position;
  plant.bunker.set_radio(radio);
}

TEST(BaseMachine, StandsInStandbyAtTheStartAndObeysOnlyTheModeFrame) {
  Plant plant;
  plant.drive(1.0, 0.0, 1s);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Standby);
  EXPECT_EQ(plant.truth().driven_m, 0.0);
  EXPECT_EQ(plant.truth().commands, 50u);
  plant.enter_can();
  plant.drive(1.0, 0.0, 1s);
  EXPECT_EQ(plant.last(0x211).data[1], 1);
  EXPECT_GT(plant.truth().driven_m, 0.3);
}

TEST(BaseMachine, ModeFramesOfOneByteSwitchAndUnknownValuesAreIgnored) {
  Plant plant;
  plant.bunker.receive(frame_of(0x421, {1}));
  plant.wait(5ms);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Can);
  plant.bunker.receive(frame_of(0x421, {7}));
  plant.bunker.receive(frame_of(0x421, {}));
  plant.wait(5ms);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Can);
  plant.bunker.receive(mode_frame(2));
  plant.drive(1.0, 0.0, 1s);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Uart);
  EXPECT_EQ(plant.truth().driven_m, 0.0);  // the bus is not the serial line
  plant.bunker.receive(mode_frame(0));
  plant.wait(5ms);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Standby);
}

TEST(BaseMachine, StopsHalfASecondAfterTheLastCommandAndStaysInCanMode) {
  Params p = ideal();
  p.drive.delay_s = p.drive.lag_s = 0.0;
  Plant plant(p);
  plant.enter_can();
  plant.drive(0.6, 0.0, 2s);
  plant.wait(475ms);  // the last frame came 20 ms before
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.6);
  plant.wait(10ms);
  EXPECT_LT(plant.truth().twist.linear_mps, 0.6);
  plant.wait(500ms);  // 0.6 m/s at 1.2 m/s²
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Can);
}

TEST(BaseMachine, MayAlsoLeaveCanModeAfterTheTimeOut) {
  Params p = ideal();
  p.drive.timeout_leaves_can = true;
  Plant plant(p);
  plant.enter_can();
  plant.drive(0.6, 0.0, 1s);
  plant.wait(600ms);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Standby);
}

TEST(BaseMachine, TheRadioTakesOverAndGivesBackOnlyToANewModeFrame) {
  Plant plant;
  plant.enter_can();
  plant.drive(1.0, 0.0, 2s);

  set_swb(plant, Switch::Middle);
  plant.drive(1.0, 0.0, 3s);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Radio);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);  // the sticks are centred

  Radio radio = plant.bunker.radio();
  radio.right_ud = -0.5;
  radio.left_lr = 1.0;  // to the right
  plant.bunker.set_radio(radio);
  plant.drive(1.0, 0.0, 3s);
  EXPECT_NEAR(plant.truth().twist.linear_mps, -0.6, 1e-3);
  EXPECT_NEAR(plant.truth().twist.angular_radps, -0.8, 1e-3);

  set_swb(plant, Switch::Up);
  plant.drive(1.0, 0.0, 3s);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Standby);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);

  plant.enter_can();
  plant.drive(1.0, 0.0, 2s);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 1.0, 1e-3);
}

TEST(BaseMachine, ALeverBetweenDetentsKeepsItsLastPosition) {
  Plant plant;
  set_swb(plant, Switch::Middle);
  plant.wait(50ms);
  set_swb(plant, Switch::Unknown);
  plant.wait(50ms);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Radio);
  EXPECT_EQ(plant.last(0x241).data[0] & 0x0C, 0);
}

TEST(BaseMachine, StartsInRadioModeWhenTheSticksAreSelected) {
  Plant plant;
  set_swb(plant, Switch::Down);
  plant.wait(200ms);
  EXPECT_EQ(plant.of(0x211).front().data[1], 3);
}

TEST(BaseMachine, CanRequestsAgainstTheRadioFlickerAndAtLastLatchAnException) {
  Plant plant;
  set_swb(plant, Switch::Middle);
  plant.wait(100ms);
  plant.bunker.receive(mode_frame(1));
  plant.wait(100ms);
  EXPECT_EQ(plant.last(0x211).data[1], 1);
  plant.wait(200ms);
  EXPECT_EQ(plant.last(0x211).data[1], 3);
  for (int i = 0; i < 9; ++i) plant.bunker.receive(mode_frame(1));
  plant.wait(200ms);
  EXPECT_EQ(plant.last(0x211).data[0], 2);
  set_swb(plant, Switch::Up);
  plant.bunker.receive(frame_of(0x441, {0}));
  plant.wait(200ms);
  EXPECT_EQ(plant.truth().vehicle_state, VehicleState::Exception);
  plant.bunker.power_cycle();
  plant.wait(200ms);
  EXPECT_EQ(plant.truth().vehicle_state, VehicleState::Normal);
}

TEST(BaseMachine, EStopBrakesHardButAcceptsModes) {
  Plant plant;
  plant.enter_can();
  plant.drive(1.0, 0.0, 3s);
  const double before_m = plant.truth().driven_m;
  set_fault(plant, [](Faults& f) { f.estop = true; });
  plant.drive(1.0, 0.0, 500ms);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
  EXPECT_NEAR(plant.truth().driven_m - before_m, 1.0 / (2.0 * 3.0), 0.02);  // v²/2a
  EXPECT_EQ(plant.last(0x211).data[0], 1);
  EXPECT_EQ(plant.last(0x211).data[5], 0x80);
  plant.bunker.receive(mode_frame(0));
  plant.wait(5ms);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Standby);
  plant.enter_can();
  plant.drive(1.0, 0.0, 500ms);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
  set_fault(plant, [](Faults& f) { f.estop = false; });
  plant.drive(1.0, 0.0, 500ms);
  EXPECT_GT(plant.truth().twist.linear_mps, 0.1);
}

TEST(BaseMachine, RadioLossIsSilentAndSetsTheBitAndDoesNotStopCanDriving) {
  Plant plant;
  plant.enter_can();
  plant.drive(0.5, 0.0, 1s);
  set_fault(plant, [](Faults& f) { f.radio_loss = true; });
  plant.forget();
  plant.drive(0.5, 0.0, 1s);
  EXPECT_TRUE(plant.of(0x241).empty());
  EXPECT_EQ(plant.last(0x211).data[5], 0x04);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 0.5, 1e-3);
  set_fault(plant, [](Faults& f) { f.radio_loss_unflagged = true; });
  plant.drive(0.5, 0.0, 200ms);
  EXPECT_EQ(plant.last(0x211).data[5], 0);
}

TEST(BaseMachine, RadioLossWhileTheSticksDriveStopsTheBase) {
  Plant plant;
  set_swb(plant, Switch::Middle);
  Radio radio = plant.bunker.radio();
  radio.right_ud = 1.0;
  plant.bunker.set_radio(radio);
  plant.wait(3s);
  EXPECT_GT(plant.truth().twist.linear_mps, 1.0);
  set_fault(plant, [](Faults& f) { f.radio_loss = true; });
  plant.wait(3s);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
  EXPECT_EQ(plant.truth().control_mode, ControlMode::Standby);
}

TEST(BaseMachine, AFrozenRadioRepeatsItsLastFrameWithTheSameCount) {
  Plant plant;
  plant.wait(200ms);
  const CanFrame before = plant.last(0x241);
  set_fault(plant, [](Faults& f) { f.radio_freeze = true; });
  plant.forget();
  plant.wait(200ms);
  ASSERT_EQ(plant.of(0x241).size(), 10u);
  for (const auto& f : plant.of(0x241)) EXPECT_EQ(f, before);
}

TEST(BaseMachine, ARadioThatWasNeverOnIsNotLost) {
  Plant plant;
  Radio radio;
  radio.on = false;
  plant.bunker.set_radio(radio);
  plant.wait(1s);
  EXPECT_TRUE(plant.of(0x241).empty());
  EXPECT_EQ(plant.last(0x211).data[5], 0);
}

TEST(BaseMachine, AnEmptyBatteryWarnsThenStops) {
  Plant plant;
  plant.enter_can();
  plant.bunker.set_battery_pct(10.0);
  plant.drive(0.5, 0.0, 2s);
  EXPECT_EQ(plant.last(0x211).data[5], 0x02);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 0.5, 1e-3);
  plant.bunker.set_battery_pct(3.0);
  plant.drive(0.5, 0.0, 2s);
  EXPECT_EQ(plant.last(0x211).data[5], 0x03);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
}

TEST(BaseMachine, AMotorErrorIsAnExceptionUntilCleared) {
  Plant plant;
  plant.enter_can();
  plant.drive(0.5, 0.0, 1s);
  set_fault(plant, [](Faults& f) { f.error_bits = 0x0018; });
  plant.drive(0.5, 0.0, 1s);
  EXPECT_EQ(plant.truth().vehicle_state, VehicleState::Exception);
  EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
  plant.bunker.receive(frame_of(0x441, {1}));
  plant.wait(200ms);
  EXPECT_EQ(plant.last(0x211).data[5], 0x10);
  plant.bunker.receive(frame_of(0x441, {0}));
  plant.wait(200ms);
  EXPECT_EQ(plant.last(0x211).data[5], 0x00);
  EXPECT_EQ(plant.truth().vehicle_state, VehicleState::Normal);
}

}  // namespace
}  // namespace roverd::sim
