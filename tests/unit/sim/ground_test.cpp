// What the field does to the robot, against figures done by hand.

#include <array>

#include <gtest/gtest.h>

#include "cart.hpp"
#include "plant.hpp"

namespace roverd::sim {
namespace {

/// East at 1 m/s for so long.
Truth after(const Params& p, base::Duration d, double yaw_rate = 0.0, std::uint64_t seed = 1) {
  Plant plant(p, seed);
  plant.enter_can();
  plant.drive(1.0, yaw_rate, d);
  return plant.truth();
}

//   ─────────▶ east: told      the way driven is ten metres, the place half a metre to the right
//   ╲____________▶
TEST(Ground, FivePercentOfCrabPutTenMetresHalfAMetreAside) {
  Params p = ideal();
  p.drive.crab = 0.05;
  const Truth t = after(p, 11s);
  EXPECT_GT(t.local.east_m, 10.0);
  EXPECT_NEAR(t.local.north_m, -0.05 * t.local.east_m, 1e-6);
  EXPECT_EQ(t.yaw_rad, 0.0);
  EXPECT_NEAR(t.lateral_mps, -0.05, 1e-6);

  p.drive.crab = -0.1;
  const Truth left = after(p, 11s);
  EXPECT_NEAR(left.local.north_m, 0.1 * left.local.east_m, 1e-6);
}

TEST(Ground, CrabGoesToTheSameSideInReverse) {
  Params p = ideal();
  p.drive.crab = 0.05;
  Plant plant(p);
  plant.enter_can();
  plant.drive(-1.0, 0.0, 6s);
  EXPECT_NEAR(plant.truth().local.north_m, 0.05 * plant.truth().local.east_m, 1e-6);
  EXPECT_LT(plant.truth().local.north_m, -0.2);
}

//  uphill north, robot to the east: left side up
TEST(Ground, AcrossASlopeTheRobotRollsByItAndSlidesDown) {
  Params p = ideal();
  p.ground.slope_deg = 10.0;
  p.ground.uphill_deg = 0.0;
  p.ground.slide = 0.3;
  const Truth t = after(p, 11s);
  EXPECT_NEAR(base::deg_from_rad(t.roll_rad), 10.0, 1e-9);
  EXPECT_NEAR(t.pitch_rad, 0.0, 1e-12);
  const double share = 0.3 * std::tan(base::rad_from_deg(10.0)) * std::cos(base::rad_from_deg(10));
  EXPECT_NEAR(t.local.north_m, -share * t.local.east_m, 1e-6);  // about 5 % of the way
}

TEST(Ground, UphillTheNoseIsUpAndTracksLoseWay) {
  Params p = ideal();
  p.ground.slope_deg = 15.0;
  p.ground.uphill_deg = 90.0;
  const double level_m = after(ideal(), 11s).local.east_m;
  const Truth up = after(p, 11s);
  p.ground.uphill_deg = 270.0;
  const Truth down = after(p, 11s);
  EXPECT_NEAR(base::deg_from_rad(up.pitch_rad), 15.0, 1e-9);
  EXPECT_NEAR(base::deg_from_rad(down.pitch_rad), -15.0, 1e-9);
  EXPECT_NEAR(up.roll_rad, 0.0, 1e-9);
  EXPECT_LT(up.local.east_m, 0.9 * level_m);
  const double slide = 0.3 * std::tan(base::rad_from_deg(15.0));
  EXPECT_NEAR(up.twist.linear_mps, (1.0 - slide) * std::cos(base::rad_from_deg(15.0)), 1e-6);
  EXPECT_NEAR(down.twist.linear_mps, (1.0 + slide) * std::cos(base::rad_from_deg(15.0)), 1e-6);
}

TEST(Ground, StandingTracksHoldOnASlope) {
  Params p = ideal();
  p.ground.slope_deg = 20.0;
  Plant plant(p);
  plant.wait(20s);
  EXPECT_EQ(plant.truth().local.north_m, 0.0);
  EXPECT_EQ(plant.truth().local.east_m, 0.0);
}

TEST(Ground, BrakingIsLongerDownhillAndShorterUphill) {
  const auto way_to_stop_m = [](double uphill_deg) {
    Params p = ideal();
    p.drive.delay_s = p.drive.lag_s = 0.0;
    p.ground.slope_deg = 5.0;
    p.ground.uphill_deg = uphill_deg;
    p.ground.slide = 0.0;
    Plant plant(p);
    plant.enter_can();
    plant.drive(1.0, 0.0, 3s);
    const double from_m = plant.truth().driven_m;
    plant.drive(0.0, 0.0, 6s);
    EXPECT_EQ(plant.truth().twist.linear_mps, 0.0);
    return plant.truth().driven_m - from_m;
  };
  // v²/2a with a = 1.2 ± half of g·sin(5°), along the slope.
  const double gravity = 0.5 * 9.81 * std::sin(base::rad_from_deg(5.0));
  const double level = std::cos(base::rad_from_deg(5.0));
  EXPECT_NEAR(way_to_stop_m(90.0), level / (2.0 * (1.2 + gravity)), 0.01);
  EXPECT_NEAR(way_to_stop_m(270.0), level / (2.0 * (1.2 - gravity)), 0.01);
}

TEST(Ground, APayloadOfTwoHalvesBrakingAndAcceleration) {
  Params p = ideal();
  p.drive.delay_s = p.drive.lag_s = 0.0;
  p.drive.payload = 2.0;
  Plant plant(p);
  plant.enter_can();
  plant.drive(1.0, 0.0, 1s);
  EXPECT_NEAR(plant.truth().twist.linear_mps, 0.5, 1e-9);  // 1 m/s² of a robot without load
  plant.drive(1.0, 0.0, 2s);
  const double from_m = plant.truth().driven_m;
  plant.drive(0.0, 0.0, 4s);
  EXPECT_NEAR(plant.truth().driven_m - from_m, 1.0 / (2.0 * 0.6), 0.01);
}

TEST(Ground, TwentyPercentOfOneSideTurnTheRobotByTheFormula) {
  Params p = ideal();
  p.drive.slip_left = 0.2;
  Plant plant(p);
  plant.enter_can();
  plant.drive(1.0, 0.0, 5s);
  const Truth t = plant.truth();
  EXPECT_NEAR(t.twist.angular_radps, 0.2 / 0.6, 1e-9);
  EXPECT_NEAR(t.twist.linear_mps, 0.9, 1e-9);
  EXPECT_NEAR(t.left_track_mps, t.right_track_mps, 1e-12);  // the encoders see nothing
}

TEST(Ground, PatchesReachFromNothingToWhatIsSaidAndStayWhereTheyAre) {
  Params p = ideal();
  p.ground.slip_patches = 0.4;
  p.ground.patch_m = 2.0;
  double least = 1.0;
  double most = 0.0;
  double sum = 0.0;
  int count = 0;
  for (double east_m = -40.0; east_m < 40.0; east_m += 0.5) {
    for (double north_m = -40.0; north_m < 40.0; north_m += 0.5) {
      const Footing f = footing_at(p, 7, {east_m, north_m}, 0.3);
      least = std::min(least, f.left_slip);
      most = std::max(most, f.left_slip);
      sum += f.left_slip;
      ++count;
    }
  }
  EXPECT_LT(least, 0.02);
  EXPECT_GT(most, 0.38);
  EXPECT_LE(most, 0.4);
  EXPECT_NEAR(sum / count, 0.2, 0.02);
  const Footing here = footing_at(p, 7, {1.3, -2.1}, 0.3);
  EXPECT_EQ(here.left_slip, footing_at(p, 7, {1.3, -2.1}, 0.3).left_slip);
  EXPECT_NE(here.left_slip, here.right_slip);
  EXPECT_NE(here.left_slip, footing_at(p, 8, {1.3, -2.1}, 0.3).left_slip);
  // A step of a centimetre is no jump.
  EXPECT_NEAR(here.left_slip, footing_at(p, 7, {1.31, -2.1}, 0.3).left_slip, 0.01);
}

TEST(Ground, CrabPatchesSlideToBothSides) {
  Params p = ideal();
  p.ground.crab_patches = 0.1;
  double left = 0.0;
  double right = 0.0;
  for (double east_m = 0.0; east_m < 200.0; east_m += 1.0) {
    const double crab = footing_at(p, 3, {east_m, 5.0}, 0.0).crab;
    left = std::min(left, crab);
    right = std::max(right, crab);
  }
  EXPECT_NEAR(left, -0.1, 0.03);
  EXPECT_NEAR(right, 0.1, 0.03);
}

TEST(Ground, RutsAreMetAsOftenAsSaidAndPushToBothSides) {
  Params p = ideal();
  p.ground.rut_dps = 10.0;
  p.ground.rut_every_m = 5.0;
  int met = 0;
  double left = 0.0;
  double right = 0.0;
  bool inside = false;
  for (double way_m = 0.0; way_m < 2000.0; way_m += 0.02) {
    const double rut = footing_at(p, 1, {way_m, 0.37 * way_m}, 0.0).rut_rad;
    met += rut != 0.0 && !inside ? 1 : 0;
    inside = rut != 0.0;
    left = std::max(left, rut);
    right = std::min(right, rut);
  }
  EXPECT_NEAR(met, 2000.0 * std::hypot(1.0, 0.37) / 5.0, 90.0);  // where two meet they count once
  EXPECT_NEAR(base::deg_from_rad(left), 10.0, 3.0);
  EXPECT_NEAR(base::deg_from_rad(right), -10.0, 3.0);

  // A robot that stands in one is not turned.
  Plant plant(p);
  plant.wait(5s);
  EXPECT_EQ(plant.truth().yaw_rad, 0.0);
}

TEST(Ground, TheSameSeedDrivesTheSameWayAndAnotherDoesNot) {
  Params p = ideal();
  p.ground.slip_patches = 0.4;
  p.ground.rut_dps = 20.0;
  p.ground.slope_deg = 8.0;
  const Truth a = after(p, 8s, 0.1, 4);
  const Truth b = after(p, 8s, 0.1, 4);
  const Truth c = after(p, 8s, 0.1, 5);
  EXPECT_EQ(a.local.east_m, b.local.east_m);
  EXPECT_EQ(a.yaw_rad, b.yaw_rad);
  EXPECT_GT(base::distance_m(a.local, c.local), 0.01);
}

TEST(Ground, ACarSlidesAndLosesTheMeanOfBothSides) {
  Params p = ideal_cart("ackermann");
  p.drive.slip_left = 0.1;
  p.drive.slip_right = 0.3;
  p.drive.crab = 0.05;
  CartPlant plant(p);
  const std::array<float, 3> told{0.0F, 0.0F, 0.0F};
  plant.repeat(told, 100ms);
  Radio sticks;
  sticks.swb = base::Switch::Down;
  sticks.right_ud = 1.0;
  plant.cart.set_radio(sticks);
  plant.wait(5s);
  const Truth t = plant.truth();
  EXPECT_NEAR(t.twist.linear_mps, 0.8 * t.left_track_mps, 1e-9);
  EXPECT_GT(t.local.east_m, 3.0);
  EXPECT_NEAR(t.local.north_m, -0.05 * t.local.east_m, 1e-6);
}

}  // namespace
}  // namespace roverd::sim
