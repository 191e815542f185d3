// Slopes: speed, braking, turns on the spot, rolling over.

#include "nav/track/slope.hpp"

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;
using base::rad_from_deg;

TEST(Slope, TheSpeedFallsFromFreeToCreeping) {
  const SlopeParams p;
  EXPECT_DOUBLE_EQ(slope_mps(rad_from_deg(6.0), 1.2, 0.4, p), 1.2);
  EXPECT_NEAR(slope_mps(rad_from_deg(13.0), 1.2, 0.4, p), 0.8, 1e-9);
  EXPECT_NEAR(slope_mps(rad_from_deg(25.0), 1.2, 0.4, p), 0.4, 1e-9);
}

TEST(Slope, BrakingIsLessDownhillAndAsEverUphill) {
  const SlopeParams p;
  EXPECT_DOUBLE_EQ(slope_decel_mps2(0.6, 0.0, p), 0.6);
  EXPECT_DOUBLE_EQ(slope_decel_mps2(0.6, rad_from_deg(-10.0), p), 0.6);
  EXPECT_NEAR(slope_decel_mps2(0.6, rad_from_deg(5.0), p), 0.6 - 0.3 * 9.81 * 0.0871557, 1e-6);
  EXPECT_DOUBLE_EQ(slope_decel_mps2(0.6, rad_from_deg(30.0), p), 0.15);
}

TEST(Slope, AVehicleTipsOverHalfItsSupportByItsHeight) {
  VehicleParams v;
  v.support_width_m = 1.0;
  v.mass_height_m = 0.5;
  EXPECT_NEAR(base::deg_from_rad(tips_over_rad(v)), 45.0, 1e-9);
  EXPECT_NEAR(base::deg_from_rad(most_roll_rad(v, {})), 27.0, 1e-9);
  // Near that limit nothing is left for bends.
  EXPECT_DOUBLE_EQ(slope_lateral_mps2(0.5, 0.0, v, {}), 0.5);
  EXPECT_NEAR(slope_lateral_mps2(0.5, rad_from_deg(25.0), v, {}),
              9.81 * std::tan(rad_from_deg(2.0)), 1e-6);
  EXPECT_DOUBLE_EQ(slope_lateral_mps2(0.5, rad_from_deg(30.0), v, {}), 0.05);
}

/// Where the robot is slower than the way's speed for the stop that comes.
double brakes_before_m(double pitch_deg) {
  Ride r;
  r.behave.join_m = 0.0;
  r.vehicle.pitch_rad = rad_from_deg(pitch_deg);
  r.load(plan({at(20, 0)}));
  r.start();
  while (r.vehicle.at.east_m < 10.0 && r.executor.running()) r.tick();
  const double full_mps = r.vehicle.speed_mps;
  while (r.vehicle.speed_mps > full_mps - 0.02 && r.executor.running()) r.tick();
  return 20.0 - r.vehicle.at.east_m;
}

TEST(Slope, AStopDownhillIsBegunEarlier) {
  const double level_m = brakes_before_m(0.0);
  // v²/2a of 0.8 m/s with 0.297 m/s² instead of 0.6.
  EXPECT_NEAR(brakes_before_m(-5.9), level_m + 0.32 / 0.297 - 0.32 / 0.6, 0.15);
  EXPECT_NEAR(brakes_before_m(5.9), level_m, 0.02);
}

TEST(Slope, NoTurnOnTheSpotWhereItIsTooSteep) {
  Ride r;
  r.vehicle.yaw_rad = base::kPi / 2.0;
  r.vehicle.roll_rad = rad_from_deg(17.0);
  r.load(plan({at(20, 0)}));
  r.start();
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Blocked);
  EXPECT_EQ(r.executor.reason(), "too steep to turn on the spot: leans 17 deg, at most 15 deg");
  EXPECT_NEAR(r.vehicle.yaw_rad, base::kPi / 2.0, 1e-9);
  EXPECT_EQ(r.vehicle.at.east_m, 0.0);
  // On less of a slope it goes on.
  r.vehicle.roll_rad = rad_from_deg(10.0);
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  ASSERT_TRUE(r.run(90.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
}

TEST(Slope, ASlightTurnIsDrivenAsAnArcThere) {
  Ride r;
  r.vehicle.yaw_rad = rad_from_deg(40.0);
  r.vehicle.roll_rad = rad_from_deg(17.0);
  r.load(plan({at(20, 0)}));
  r.start();
  double slowest_mps = 1.0;
  r.run(1.0);
  for (int i = 0; i < 100; ++i) {
    r.tick();
    slowest_mps = std::min(slowest_mps, r.vehicle.speed_mps);
  }
  EXPECT_GT(slowest_mps, 0.05);
  ASSERT_TRUE(r.run(120.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
}

TEST(Slope, ATurnThatIsAnItemIsNotBegunEither) {
  Ride r;
  mission::TurnBy turn;
  turn.turn_deg = 90.0;
  r.vehicle.pitch_rad = rad_from_deg(-17.0);
  r.load(plan({turn, at(0, 20)}));
  r.start();
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.reason(), "too steep to turn on the spot: leans 17 deg, at most 15 deg");
}

}  // namespace
}  // namespace roverd::nav
