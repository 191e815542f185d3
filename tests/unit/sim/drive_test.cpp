// Where the robot goes, against physics done by hand.

#include <gtest/gtest.h>

#include "plant.hpp"

namespace roverd::sim {
namespace {

TEST(Drive, TenSecondsStraightWithEightPercentSlipGiveTheHandComputedWay) {
  Params p = ideal();
  p.drive.slip = 0.08;
  p.drive.delay_s = 0.06;
  p.drive.lag_s = 0.0;
  Plant plant(p);
  plant.enter_can();

  plant.drive(1.0, 0.0, 10s);

  // 0.06 s nothing, 1 s of acceleration at 1 m/s² (0.5 m), 8.94 s at 1 m/s: 9.44 m of track.
  const Truth t = plant.truth();
  EXPECT_NEAR(t.local.east_m, 9.44 * 0.92, 0.01);
  EXPECT_NEAR(t.local.north_m, 0.0, 1e-9);
  EXPECT_NEAR(t.twist.linear_mps, 0.92, 1e-9);
  EXPECT_NEAR(i32(plant.last(0x311), 0), 9440, 25);
}

TEST(Drive, TheLagIsOneTimeConstantToSixtyThreePercent) {
  Params p = ideal();
  p.drive.delay_s = 0.06;
  p.drive.lag_s = 0.09;
  p.drive.accel_mps2 = 10.0;
  Plant plant(p);
  plant.enter_can();

  plant.drive(0.5, 0.0, 60ms);
  EXPECT_EQ(plant.truth().left_track_mps, 0.0);  // still on its way
  plant.drive(0.5, 0.0, 80ms);
  EXPECT_NEAR(plant.truth().left_track_mps, 0.5 * (1.0 - std::exp(-80.0 / 90.0)), 0.02);
}

//   told 0 → 1 again and again; how long the tracks take to begin
TEST(Drive, ADelayThatJittersStaysWithinItsBoundsAndKeepsTheOrder) {
  Params p = ideal();
  p.drive.delay_s = 0.05;
  p.drive.delay_jitter_s = 0.35;
  p.drive.delay_hold_s = 0.7;
  p.drive.lag_s = 0.0;
  p.drive.accel_mps2 = p.drive.decel_mps2 = 10.0;
  Plant plant(p);
  plant.enter_can();
  double least_s = 1.0;
  double most_s = 0.0;
  for (int i = 0; i < 60; ++i) {
    double waited_s = 0.0;
    while (plant.truth().left_track_mps == 0.0 && waited_s < 1.0) {
      plant.bunker.receive(drive_frame(0.5, 0.0));
      plant.wait(5ms);
      waited_s += 0.005;
    }
    least_s = std::min(least_s, waited_s);
    most_s = std::max(most_s, waited_s);
    plant.drive(0.0, 0.0, 1s);
    ASSERT_EQ(plant.truth().left_track_mps, 0.0);
  }
  EXPECT_GE(least_s, 0.05);
  EXPECT_LT(least_s, 0.12);
  EXPECT_GT(most_s, 0.3);
  EXPECT_LE(most_s, 0.405);
}

TEST(Drive, CommandsNeverOvertakeEachOther) {
  Delay<double> delay;
  double last = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    const double delay_s = 0.005 * static_cast<double>((i * 37) % 61);
    const double out = delay.step(static_cast<double>(i), delay_s, 0.005);
    EXPECT_GE(out, last);
    last = out;
  }
}

TEST(Drive, AnUnevenBatteryReachesLessAndTheEncodersTellIt) {
  Params p = ideal();
  p.battery.uneven = 0.3;
  p.battery.resistance_ohm = 0.0;
  for (const double charge_pct : {100.0, 50.0, 20.0}) {
    Plant plant(p);
    plant.bunker.set_battery_pct(charge_pct);
    plant.enter_can();
    plant.drive(1.0, 0.0, 4s);
    const double reached_mps = 1.0 - 0.3 * (1.0 - charge_pct / 100.0);
    EXPECT_NEAR(plant.truth().twist.linear_mps, reached_mps, 0.002);
    EXPECT_NEAR(i16(plant.last(0x221), 0) / 1000.0, reached_mps, 0.002);
  }
}

//        ╭─╮  a left pivot: the left track runs back, the right one ahead
//    L ▼ │·│ ▲ R
TEST(Drive, APivotScrubsAwayPartOfTheTurn) {
  Params p = ideal();
  p.drive.turn_loss = 1.3;
  p.drive.slip = 0.08;
  Plant plant(p);
  plant.enter_can();

  plant.drive(0.0, 0.5, 2s);

  const Truth t = plant.truth();
  EXPECT_NEAR(t.twist.angular_radps, 0.5 * 0.92 / 1.3, 1e-4);
  EXPECT_NEAR(t.left_track_mps, -0.15, 1e-4);
  EXPECT_NEAR(t.right_track_mps, 0.15, 1e-4);
  EXPECT_NEAR(i16(plant.last(0x221), 2), 500, 1);  // the base believes in its nominal width
  EXPECT_NEAR(t.local.east_m, 0.0, 1e-9);
}

TEST(Drive, TheCentreOfRotationLiesAheadOfTheOrigin) {
  Params p = ideal();
  p.drive.pivot_centre_m = 0.10;
  Plant plant(p);
  plant.enter_can();
  while (plant.truth().yaw_rad < base::kPi / 2.0) plant.drive(0.0, 0.5, 20ms);
  // A quarter turn about (0.10, 0): the origin ends at (0.10, −0.10).
  EXPECT_NEAR(plant.truth().local.east_m, 0.10, 0.005);
  EXPECT_NEAR(plant.truth().local.north_m, -0.10, 0.005);
}

TEST(Drive, UnevenSidesBendAStraightCommandToTheLeft) {
  Params p = ideal();
  p.drive.side_difference = 0.02;
  Plant plant(p);
  plant.enter_can();
  plant.drive(1.0, 0.0, 5s);
  EXPECT_NEAR(plant.truth().twist.angular_radps, 0.02 / 0.60, 1e-4);
  EXPECT_EQ(i16(plant.last(0x221), 2), 0);  // the encoders do not see it
}

TEST(Drive, ATurnBrakesHalfAsHardAsItStarts) {
  Params p = ideal();
  p.drive.delay_s = p.drive.lag_s = 0.0;
  Plant plant(p);
  plant.enter_can();
  plant.drive(0.0, 0.8, 500ms);  // 1.6 rad/s²
  EXPECT_NEAR(plant.truth().twist.angular_radps, 0.8, 1e-6);
  plant.drive(0.0, 0.0, 500ms);  // 0.8 rad/s²
  EXPECT_NEAR(plant.truth().twist.angular_radps, 0.4, 0.01);
  plant.drive(0.0, 0.0, 520ms);
  EXPECT_EQ(plant.truth().twist.angular_radps, 0.0);
}

TEST(Drive, CommandsAreCutToTheBasesLimits) {
  Plant plant;
  plant.enter_can();
  plant.drive(3.0, 0.0, 5s);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 1.5, 1e-6);
}

TEST(Drive, AStandingTrackIgnoresACommandTooSmall) {
  Params p = ideal();
  p.drive.stick_mps = 0.05;
  Plant plant(p);
  plant.enter_can();
  plant.drive(0.04, 0.0, 2s);
  EXPECT_EQ(plant.truth().driven_m, 0.0);
  plant.drive(0.06, 0.0, 2s);
  EXPECT_NEAR(plant.truth().left_track_mps, 0.06, 1e-3);
}

TEST(Drive, EncodersOdometerAndCurrentsAgreeWithTheMotion) {
  Plant plant;
  plant.enter_can();
  plant.drive(1.0, 0.3, 5s);
  plant.drive(0.0, 0.0, 3s);
  const std::int32_t left_mm = i32(plant.last(0x311), 0);
  const std::int32_t right_mm = i32(plant.last(0x311), 4);
  const double turned = plant.truth().yaw_rad;
  EXPECT_NEAR((right_mm - left_mm) / 1000.0 / 0.60, turned, 0.01);
  // motor 1 is the right one: 33 rev/m, 1024 pulses each
  EXPECT_NEAR(i32(plant.last(0x251), 4), right_mm / 1000.0 * 33.0 * 1024.0, 40.0);
  EXPECT_NEAR(i32(plant.last(0x252), 4), left_mm / 1000.0 * 33.0 * 1024.0, 40.0);
  EXPECT_EQ(i16(plant.last(0x251), 0), 0);
  plant.drive(1.0, 0.0, 3s);
  EXPECT_NEAR(i16(plant.last(0x251), 0), 1.0 * 33.0 * 60.0, 2);
  // rolling: 0.08·150·9.81/2 = 58.9 N, 25 N/A
  EXPECT_NEAR(i16(plant.last(0x252), 2) / 10.0, 2.35, 0.06);
  plant.drive(-0.5, 0.0, 3s);
  EXPECT_LT(i16(plant.last(0x252), 2), 0);
  EXPECT_LT(i32(plant.last(0x311), 0), left_mm + 3000);
}

TEST(Drive, ABaseWithFourMotorsTellsOfAllOfThem) {
  Params four = ideal();
  four.base.motors = 4;
  Plant plant(four);
  plant.enter_can();
  plant.drive(1.0, 0.3, 3s);
  for (const std::uint32_t fast : {0x251u, 0x252u}) {
    EXPECT_EQ(plant.last(fast + 2).data, plant.last(fast).data) << fast;  // the same side
    EXPECT_EQ(plant.last(fast + 0x12).data, plant.last(fast + 0x10).data) << fast;
  }
  EXPECT_GT(i16(plant.last(0x253), 0), i16(plant.last(0x254), 0)) << "turning left";
}

TEST(Drive, TheBatteryDrainsBySumOfPowerAndSagsUnderLoad) {
  Params p = ideal();
  p.battery.start_pct = 50.0;
  p.battery.capacity_ah = 1.0;
  Plant plant(p);
  plant.wait(60s);
  // 45 W at 48 V are 0.94 A; a minute of it is 1.56 % of 1 Ah.
  EXPECT_NEAR(plant.truth().battery_pct, 50.0 - 1.56, 0.03);
  EXPECT_NEAR(i16(plant.last(0x211), 2) / 10.0, 47.7, 0.11);
  const int resting = i16(plant.last(0x361), 2);
  plant.enter_can();
  plant.drive(0.0, 1.0, 3s);
  EXPECT_LT(i16(plant.last(0x361), 2), resting);
}

}  // namespace
}  // namespace roverd::sim
