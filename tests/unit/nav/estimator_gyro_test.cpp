// The estimator with a gyro: its bias, its silence, turns, standing, and what the operator tells.

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "rails.hpp"

namespace roverd::nav {
namespace {

using base::Alignment;
using base::rad_from_deg;

Drive with_gyro(double bias_dps = 0.3) {
  Drive d;
  d.gyro = true;
  d.gyro_bias_radps = rad_from_deg(bias_dps);
  return d;
}

TEST(EstimatorGyro, LearnsTheGyrosBiasAtRestAndHoldsTheHeading) {
  for (const double bias_dps : {-1.0, 0.3, 1.0}) {
    Drive d = with_gyro(bias_dps);
    d.run(15.0);
    const auto health = d.estimator.health();
    EXPECT_TRUE(health.gyro);
    EXPECT_NEAR(base::deg_from_rad(health.gyro_bias_radps.value()), bias_dps, 0.02);
    const double yaw = d.pose()->yaw_rad;
    d.run(600.0);
    EXPECT_LT(std::abs(base::angle_diff_rad(yaw, d.pose()->yaw_rad)), rad_from_deg(0.1));
    EXPECT_EQ(d.pose()->yaw_rate_radps, 0.0);
  }
}

//   Millimetres that are counted, at 50 Hz: most steps tell none.
TEST(EstimatorGyro, ACreepingTurnIsTurningAndNoBias) {
  for (const double turn_dps : {-0.8, 1.4, 4.0}) {
    Drive d = with_gyro(0.3);
    d.yaw_scale = 1.0;
    d.run(10.0);
    d.compass = d.gnss = d.tracks = false;
    d.rate_radps = rad_from_deg(turn_dps);
    const double before = d.yaw_rad;
    double told_m = 0.0;
    double gone_m = 0.0;
    for (int i = 0; i < 1000; ++i) {
      d.tick();
      gone_m += 0.5 * EstimateParams{}.track_width_m * d.rate_radps * 0.02;
      const double counted_m = 0.001 * std::trunc((gone_m - told_m) / 0.001);
      told_m += counted_m;
      d.estimator.take(base::WheelTravel{d.now(), -counted_m, counted_m}, d.now());
    }
    EXPECT_NEAR(base::deg_from_rad(base::angle_diff_rad(before, d.yaw_rad)), 20.0 * turn_dps, 0.1);
    EXPECT_LT(std::abs(d.yaw_error_deg()), 2.0) << turn_dps;
    EXPECT_NEAR(base::deg_from_rad(d.estimator.health().gyro_bias_radps.value()), 0.3, 0.05);
  }
}

//   One count to and fro, as an encoder on an edge tells it.
TEST(EstimatorGyro, ACountThatJittersAtRestLeavesTheBiasToBeLearned) {
  Drive d = with_gyro(1.0);
  d.tracks = false;
  for (int i = 0; i < 1000; ++i) {
    d.tick();
    const double one_m = i % 14 == 0 ? 0.001 : i % 14 == 7 ? -0.001 : 0.0;
    d.estimator.take(base::WheelTravel{d.now(), one_m, 0.0}, d.now());
  }
  EXPECT_TRUE(d.estimator.standing());
  EXPECT_NEAR(base::deg_from_rad(d.estimator.health().gyro_bias_radps.value()), 1.0, 0.05);
}

//   A load in its front: it turns about a place 8 cm ahead of its origin, and 8 cm behind.
TEST(EstimatorGyro, LearnsAheadOfWhatItTurnsAndHoldsItsPlaceByThat) {
  for (const double pivot_m : {-0.08, 0.0, 0.08}) {
    Drive d = with_gyro();
    d.pivot_m = pivot_m;
    d.noise_m = 0.01;
    d.run(10.0);
    d.speed_mps = 0.6;
    d.run(8.0);
    for (const double way : {1.0, -1.0, 1.0, -1.0, 1.0, -1.0}) {
      d.speed_mps = 0.0;
      d.rate_radps = 0.5 * way;
      d.run(4.0);
      d.rate_radps = 0.0;
      d.run(2.0);
    }
    ASSERT_TRUE(d.estimator.learned().pivot_m) << pivot_m;
    EXPECT_NEAR(d.estimator.learned().pivot_m->value, pivot_m, 0.012);
    // Without any help from outside it turns by half, and knows how far it went aside.
    d.gnss = d.compass = false;
    const double before_m = d.position_error_m();
    d.rate_radps = 0.5;
    d.run(6.28);
    EXPECT_NEAR(d.pose()->over_ground.value().left_mps, -0.5 * pivot_m, 0.006);
    d.rate_radps = 0.0;
    d.run(1.0);
    EXPECT_LT(d.position_error_m(), before_m + 0.025) << pivot_m;
  }
}

//   For each metre that it drives on a slope it slides south by 0.1 m, whichever way it points.
TEST(EstimatorGyro, TellsHowFastItSlides) {
  Drive d = with_gyro();
  d.antennas = true;
  d.slide_north = -0.1;
  d.run(10.0);
  // North, west, south, east.
  for (int leg = 0; leg < 4; ++leg) {
    if (leg > 0) {
      d.speed_mps = 0.0;
      d.rate_radps = 0.25 * base::kPi;
      d.run(2.0);
      d.rate_radps = 0.0;
    }
    d.speed_mps = 0.8;
    d.run(20.0);
  }
  EXPECT_NEAR(d.pose()->over_ground.value().left_mps, -0.08, 0.03);
  EXPECT_NEAR(d.pose()->over_ground.value().ahead_mps, 0.8, 0.015);
}

//   Antennas askew by 4 degrees look like a robot that drives aside: nothing is made of it.
TEST(EstimatorGyro, TakesWhatSeemsToBeCrabForNone) {
  Drive d = with_gyro();
  d.crab = 0.07;
  d.antennas = true;
  d.speed_mps = 0.8;
  d.run(60.0);
  EXPECT_NEAR(d.estimator.crab(), 0.07, 0.02);
  EXPECT_NEAR(d.pose()->over_ground.value().left_mps, 0.0, 0.8 * 0.02);
  EXPECT_NEAR(d.pose()->over_ground.value().ahead_mps, 0.8, 0.01);
}

//   A receiver that runs away to the side by 0.2 m/s for three seconds.
TEST(EstimatorGyro, MakesOfALyingReceiverNoMoreThanASlopesSlide) {
  Drive d = with_gyro();
  d.run(10.0);
  d.speed_mps = 0.6;
  d.run(20.0);
  double most = 0.0;
  for (int i = 0; i < 500; ++i) {
    if (i < 150) d.offset_east_m += 0.004;
    d.tick();
    most = std::max(most, std::abs(d.pose()->over_ground.value().left_mps) / 0.6);
  }
  EXPECT_LE(most, 0.12 + 1e-9);
}

//   Bends with a load in the front and a mast ahead, forwards and backwards, a receiver of 1 s.
TEST(EstimatorGyro, LearnsAheadOfWhatItTurnsInBendsAsWell) {
  for (const double pivot_m : {-0.1, 0.1}) {
    EstimateParams params;
    params.antenna_forward_m = 0.4;
    Drive d(params);
    d.gyro = true;
    d.antenna_forward_m = 0.4;
    d.pivot_m = pivot_m;
    d.told_late_s = 1.0;
    d.run(12.0);
    d.speed_mps = 0.6;
    d.run(10.0);
    for (const double way : {0.5, -0.5, 0.5, -0.5}) {
      d.speed_mps = way;
      for (const double rate_radps : {0.4, -0.4}) {
        d.rate_radps = rate_radps;
        d.run(8.0);
      }
    }
    EXPECT_NEAR(d.estimator.health().pivot_m, pivot_m, 0.03);
    EXPECT_LT(d.position_error_m(), 0.03);
  }
}

TEST(EstimatorGyro, WhatTurnsAboutItsAxleLearnsNothingElse) {
  EstimateParams params;
  params.pivot_sigma_m = 0.0;
  Drive d(params);
  d.gyro = true;
  d.pivot_m = 0.05;
  d.run(10.0);
  d.speed_mps = 0.6;
  d.run(8.0);
  d.rate_radps = 0.4;
  d.run(20.0);
  EXPECT_EQ(d.estimator.health().pivot_m, 0.0);
  EXPECT_FALSE(d.estimator.learned().pivot_m);
}

TEST(EstimatorGyro, RecallsAheadOfWhatItTurnsAndForgetsIt) {
  Drive d = with_gyro();
  Learned known;
  known.pivot_m = LearnedValue{0.06, 0.004};
  d.estimator.recall(known);
  EXPECT_EQ(d.estimator.health().pivot_m, 0.06);
  d.estimator.forget_vehicle();
  EXPECT_EQ(d.estimator.health().pivot_m, 0.0);
  known.pivot_m = LearnedValue{1.5, 0.004};  // no robot's
  d.estimator.recall(known);
  EXPECT_EQ(d.estimator.health().pivot_m, 0.0);
}

TEST(EstimatorGyro, TracksThatTurnLessThanTheySayDoNotMislead) {
  // Given tracks of which half of the turn is lost, which nobody told the estimator,
  Drive d = with_gyro();
  d.yaw_scale = 0.5;
  d.run(10.0);
  d.speed_mps = 0.6;
  d.run(8.0);
  d.gnss = d.compass = false;
  // when it turns without any help from outside,
  d.speed_mps = 0.0;
  d.rate_radps = 0.5;
  d.run(6.0);
  // then the gyro knows, and what the tracks are worth was learned by the way.
  EXPECT_LT(std::abs(d.yaw_error_deg()), 1.0);
  EXPECT_NEAR(d.estimator.yaw_scale(), 0.5, 0.05);
}

TEST(EstimatorGyro, ChangesToTheTracksWhenTheGyroFallsSilentAndBack) {
  Drive d = with_gyro();
  d.run(10.0);
  for (int i = 0; i < 4; ++i) {
    d.speed_mps = 0.6;
    d.rate_radps = i % 2 == 0 ? 0.3 : -0.3;
    d.run(4.0);
  }
  d.gyro = false;
  d.run(0.2);
  EXPECT_FALSE(d.estimator.gyro());
  d.run(4.0);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 2.0);
  d.gyro = true;
  d.run(0.2);
  EXPECT_TRUE(d.estimator.gyro());
  d.run(4.0);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 1.0);
}

TEST(EstimatorGyro, ARobotThatIsTurnedByHandKnowsIt) {
  Drive d = with_gyro();
  d.run(5.0);
  d.speed_mps = 0.6;
  d.run(8.0);
  d.speed_mps = 0.0;
  d.compass = false;
  d.run(2.0);
  d.tracks = false;  // they stand while the robot is turned: tell so by hand
  const double before = d.yaw_rad;
  d.rate_radps = 0.4;
  for (int i = 0; i < 100; ++i) {
    d.tick();
    d.estimator.take(base::WheelTravel{d.now(), 0.0, 0.0}, d.now());
  }
  EXPECT_GT(std::abs(base::angle_diff_rad(before, d.yaw_rad)), 0.7);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 3.0);
}

TEST(EstimatorGyro, AlignmentGoesFromUnknownToAlignedWithinFiveMetres) {
  Drive d = with_gyro();
  d.compass_bias_rad = rad_from_deg(20.0);
  EXPECT_FALSE(d.estimator.health().advice.empty());  // no position yet
  d.run(3.0);
  EXPECT_EQ(d.estimator.alignment(), Alignment::Unknown);
  EXPECT_EQ(d.estimator.health().advice, "drive 3 m straight to find the heading");
  d.speed_mps = 0.4;
  d.run(12.0);
  EXPECT_EQ(d.estimator.alignment(), Alignment::Aligned);
  EXPECT_TRUE(d.estimator.health().advice.empty());
  EXPECT_LT(std::abs(d.yaw_error_deg()), 1.0);
}

TEST(EstimatorGyro, ACompassIsNotBelievedForTwoSecondsAfterATurnOnTheSpot) {
  Drive d = with_gyro();
  d.run(5.0);
  d.speed_mps = 0.6;
  d.run(8.0);
  d.speed_mps = 0.0;
  d.rate_radps = 0.6;
  d.compass_bias_rad = rad_from_deg(25.0);  // as long as the currents flow
  d.run(2.6);
  d.rate_radps = 0.0;
  d.run(1.5);
  d.compass_bias_rad = 0.0;
  EXPECT_LT(std::abs(d.yaw_error_deg()), 0.5);
  const auto disturbed = static_cast<std::size_t>(base::Refusal::Disturbed);
  EXPECT_GT(d.estimator.health().refusals[disturbed], 10u);
  d.run(3.0);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 0.5);
}

TEST(EstimatorGyro, TwoAntennasGiveTheHeadingAtRest) {
  Drive d = with_gyro();
  d.compass = false;
  d.run(2.0);
  EXPECT_FALSE(d.estimator.heading_known());
  for (int i = 0; i < 50; ++i) {
    d.run(0.2);
    base::Heading h{d.now(), d.yaw_rad + rad_from_deg(i % 2 == 0 ? 0.5 : -0.5),
                    base::HeadingSource::DualAntenna, rad_from_deg(0.6)};
    d.estimator.take(h, d.now());
  }
  EXPECT_EQ(d.estimator.alignment(), Alignment::Aligned);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 0.4);
  // How they are mounted is only seen while driving: no claim is better than 3 degrees before.
  EXPECT_NEAR(d.pose()->yaw_sigma_rad, rad_from_deg(3.0), rad_from_deg(0.2));
}

TEST(EstimatorGyro, WithoutGnssTheDoubtGrowsAndCoversTheError) {
  Drive d = with_gyro();
  d.slip = 0.92;
  d.run(10.0);
  d.speed_mps = 0.8;
  d.run(20.0);
  const double sigma_m = d.pose()->horizontal_sigma_m;
  d.gnss = false;
  d.run(37.5);
  EXPECT_NEAR(d.estimator.health().free_m, 30.0, 0.5);
  EXPECT_LT(d.position_error_m(), 0.6);
  EXPECT_GT(d.pose()->horizontal_sigma_m, 3.0 * sigma_m);
  EXPECT_LT(d.position_error_m(), 3.0 * d.pose()->horizontal_sigma_m);
}

TEST(EstimatorGyro, ABetterFixIsApproachedSlowlyInsteadOfJumpedTo) {
  Drive d = with_gyro();
  d.fix = base::FixType::Single;
  d.offset_east_m = 1.0;
  d.run(12.0);
  d.speed_mps = 0.5;
  d.run(10.0);
  d.offset_east_m = 0.0;
  d.run(0.14);  // the last single fix arrives
  d.fix = base::FixType::RtkFixed;
  double fastest_m = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double before_m = d.position_error_m();
    d.tick();
    fastest_m = std::max(fastest_m, std::abs(d.position_error_m() - before_m));
  }
  EXPECT_LT(fastest_m, 0.08);
  EXPECT_LT(d.position_error_m(), 0.05);
}

TEST(EstimatorGyro, TheAnchorMovesTheReceiverUntilTheFixClassChanges) {
  Drive d = with_gyro();
  d.fix = base::FixType::Single;
  d.offset_east_m = 2.0;  // this session's shift
  d.run(12.0);
  const base::EnuPoint truth{d.pose()->at.east_m - 2.0, d.pose()->at.north_m};
  d.estimator.anchor(truth, 3);
  EXPECT_LT(base::distance_m(d.pose()->at, truth), 0.01);
  EXPECT_LT(d.position_error_m(), 0.3);
  ASSERT_TRUE(d.estimator.health().anchor);
  EXPECT_EQ(d.estimator.health().anchor->item, 3);
  EXPECT_NEAR(d.estimator.health().last_reset->jump.east_m, 2.0, 0.01);  // old minus new
  d.speed_mps = 0.5;
  d.run(20.0);
  EXPECT_LT(d.position_error_m(), 0.5);
  d.fix = base::FixType::RtkFixed;
  d.offset_east_m = 0.0;
  d.run(15.0);
  EXPECT_FALSE(d.estimator.health().anchor);
  EXPECT_LT(d.position_error_m(), 0.1);
}

TEST(EstimatorGyro, AnOperatorsPoseIsEnoughOnAMapWithoutGnss) {
  EstimateParams p;
  p.map_lat = 58.378;
  p.map_lon = 26.729;
  Drive d(p);
  d.gyro = true;
  d.gnss = d.compass = false;
  d.run(5.0);
  EXPECT_FALSE(d.pose());
  d.estimator.place(base::EnuPoint{3.0, 4.0}, base::kPi / 2.0);
  d.speed_mps = 0.5;
  d.run(20.0);
  ASSERT_TRUE(d.pose());
  EXPECT_EQ(d.pose()->source, "odometry");
  EXPECT_NEAR(d.pose()->at.east_m, 3.0, 0.2);
  EXPECT_NEAR(d.pose()->at.north_m, 14.0, 0.2);
  EXPECT_TRUE(d.estimator.health().placed);
  EXPECT_NEAR(d.estimator.health().free_m, 10.0, 0.2);
}

TEST(EstimatorGyro, TheCovarianceStaysPositiveOverAMillionSteps) {
  Belief b;
  for (int i = 0; i < kStates; ++i) b.P(i, i) = 0.1;
  b.x(kScale) = b.x(kYawScale) = 1.0;
  StateVector change;
  double nis = 0.0;
  for (int i = 0; i < 1'000'000; ++i) {
    Travel t{0.016, 0.002, 0.02, 0.002};
    if (i % 5000 > 4000) t.gyro_rad.reset();
    predict(b, t, {}, {0.8, 60.0}, false);
    if (i % 100 != 0) continue;
    Observation<2> o;
    o.innovation << 0.1 * std::sin(i), 0.1 * std::cos(i);
    o.H(0, kEast) = o.H(1, kNorth) = o.H(0, kDriftE) = o.H(1, kDriftN) = 1.0;
    o.R(0, 0) = o.R(1, 1) = 1e-4;
    if (i % 700 == 0) o.may_change(kEast) = o.may_change(kNorth) = 0.0;
    update(b, o, change, nis);
    if (i % 10'000 != 0) continue;
    ASSERT_TRUE(b.P.allFinite());
    ASSERT_LT((b.P - b.P.transpose()).norm(), 1e-12);
    const Eigen::SelfAdjointEigenSolver<StateMatrix> solver(b.P);
    ASSERT_GT(solver.eigenvalues().minCoeff(), -1e-10);
  }
}

}  // namespace
}  // namespace roverd::nav
