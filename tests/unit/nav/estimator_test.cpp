#include "nav/estimate/estimator.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "rails.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using std::chrono::milliseconds;

TEST(Estimator, KnowsNothingBeforeTheFirstUsableFix) {
  Drive d;
  d.fix = base::FixType::Estimated;
  d.run(3.0);
  EXPECT_FALSE(d.pose());
  d.fix = base::FixType::Single;
  d.run(1.0);
  ASSERT_TRUE(d.pose());
  EXPECT_EQ(d.estimator.frame()->id(), 1u);
  EXPECT_GT(d.pose()->horizontal_sigma_m, 1.0);
}

TEST(Estimator, ACompassTwentyDegreesOffIsFoundOutWithinFiveMetres) {
  for (const double bias_deg : {-20.0, 20.0}) {
    Drive d;
    d.compass_bias_rad = rad_from_deg(bias_deg);
    d.run(3.0);
    EXPECT_NEAR(d.yaw_error_deg(), bias_deg, 4.0);  // standing, the compass is all there is
    EXPECT_GT(d.pose()->yaw_sigma_rad, rad_from_deg(10.0));
    d.speed_mps = 0.5;
    d.run(10.0);
    EXPECT_LT(std::abs(d.yaw_error_deg()), 1.0);
    EXPECT_NEAR(base::deg_from_rad(d.estimator.health().compass_bias_rad), bias_deg, 3.0);
  }
}

TEST(Estimator, ABiasThatChangesDuringATurnOnTheSpotIsLearnedAgain) {
  Drive d;
  d.speed_mps = 0.8;
  d.run(15.0);
  d.speed_mps = 0.0;
  d.rate_radps = 0.5;
  d.compass_bias_rad = rad_from_deg(15.0);
  d.run(3.0);
  d.rate_radps = 0.0;
  d.speed_mps = 0.4;
  d.run(6.0);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 2.0);
}

TEST(Estimator, LearnsHowMuchTheTracksSlipInStraightsAndTurns) {
  Drive d;
  d.slip = 0.9;
  d.yaw_scale = 0.6;
  for (int i = 0; i < 8; ++i) {
    d.speed_mps = 0.8;
    d.rate_radps = 0.0;
    d.run(6.0);
    d.speed_mps = 0.3;
    d.rate_radps = 0.4;
    d.run(4.0);
  }
  EXPECT_NEAR(d.estimator.health().odometry_scale, 0.9, 0.02);
  EXPECT_NEAR(d.estimator.yaw_scale(), 0.6, 0.05);
}

TEST(Estimator, DrivingBackwardsDoesNotTurnTheHeadingRound) {
  Drive d;
  d.speed_mps = -0.6;
  d.run(20.0);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 1.0);
  EXPECT_LT(d.position_error_m(), 0.05);
  EXPECT_LT(d.pose()->speed_mps.value(), -0.5);
}

TEST(Estimator, FindsTheHeadingByDrivingWhenThereIsNoCompass) {
  for (const double speed : {0.4, -0.4}) {
    Drive d;
    d.compass = false;
    d.yaw_rad = 2.5;
    d.run(2.0);
    EXPECT_FALSE(d.estimator.heading_known());
    EXPECT_NEAR(d.pose()->yaw_sigma_rad, base::kPi, 1e-9);
    d.speed_mps = speed;
    d.run(4.0);
    EXPECT_LT(std::abs(d.yaw_error_deg()), 2.0);
  }
}

TEST(Estimator, AHeadingWrongByHalfATurnIsSetAnewFromTheCourse) {
  Drive d;
  d.compass_bias_rad = base::kPi;
  d.run(2.0);
  d.speed_mps = 0.5;
  d.run(6.0);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 3.0);
  EXPECT_GE(d.estimator.health().resets, 1u);
}

TEST(Estimator, ThirtySecondsWithoutGnssDriftLittleAndSaySo) {
  Drive d;
  d.speed_mps = 0.8;
  d.run(30.0);
  d.gnss = false;
  d.run(30.0);
  EXPECT_EQ(d.pose()->source, "odometry");
  EXPECT_LT(d.position_error_m(), 0.5);
  EXPECT_GT(d.pose()->horizontal_sigma_m, 0.1);
}

TEST(Estimator, AJumpOfThreeMetresForFiveSecondsIsRefused) {
  Drive d;
  d.speed_mps = 0.5;
  d.run(15.0);
  d.offset_east_m = 3.0;
  d.run(5.0);
  EXPECT_LT(d.position_error_m(), 0.1);
  EXPECT_GT(d.estimator.health().rejected, 10u);
  d.offset_east_m = 0.0;
  d.run(2.0);
  EXPECT_EQ(d.estimator.health().resets, 0u);
}

TEST(Estimator, AJumpThatStaysIsBelievedAfterTenSecondsAndCounted) {
  Drive d;
  d.speed_mps = 0.5;
  d.run(15.0);
  d.offset_east_m = 3.0;
  d.run(14.0);
  EXPECT_NEAR(d.position_error_m(), 3.0, 0.1);
  EXPECT_EQ(d.estimator.health().resets, 1u);
}

TEST(Estimator, AJumpBeyondTwentyFiveMetresIsBelievedSoonerWhereNobodyOutvotesIt) {
  Drive d;
  d.speeds = false;
  d.run(5.0);
  d.offset_east_m = 100.0;
  d.run(2.0);
  EXPECT_NEAR(d.position_error_m(), 100.0, 0.1);
  EXPECT_EQ(d.estimator.health().resets, 1u);
}

TEST(Estimator, AJumpThatVelocityAndOdometryDenyIsLeftOutUntilItStayed) {
  Drive d;
  d.run(5.0);
  d.offset_east_m = 100.0;
  d.run(10.0);
  EXPECT_TRUE(d.estimator.health().votes[base::Sense::Position].left_out);
  EXPECT_LT(d.position_error_m(), 0.1);
  d.run(3.0);
  EXPECT_NEAR(d.position_error_m(), 100.0, 0.1);
  EXPECT_EQ(d.estimator.health().resets, 1u);
}

TEST(Estimator, StandingStillHoldsPositionAndYawAgainstADriftingReceiver) {
  Drive d;
  d.fix = base::FixType::Single;
  d.speed_mps = 0.5;
  d.run(20.0);
  d.speed_mps = 0.0;
  d.run(3.0);
  const auto before = d.pose();
  for (int i = 0; i < 600; ++i) {
    d.offset_east_m = 1.5 * std::sin(i * 0.02);
    d.compass_bias_rad = rad_from_deg(3.0) * std::sin(i * 0.05);
    d.run(1.0);
  }
  EXPECT_LT(base::distance_m(before->at, d.pose()->at), 0.05);
  EXPECT_LT(std::abs(base::angle_diff_rad(before->yaw_rad, d.pose()->yaw_rad)), 0.002);
}

TEST(Estimator, AWorseFixOpensTheOffsetInsteadOfMovingTheRobot) {
  Drive d;
  d.speed_mps = 0.5;
  d.run(20.0);
  d.fix = base::FixType::Single;
  d.offset_east_m = 1.0;
  d.run(5.0);
  EXPECT_LT(d.position_error_m(), 0.5);
  d.fix = base::FixType::RtkFixed;
  d.offset_east_m = 0.0;
  d.run(5.0);
  EXPECT_LT(d.position_error_m(), 0.05);
}

TEST(Estimator, AFixedSolutionThatDoesNotLastMakesNoVaguePlaceACertainOne) {
  Drive d;
  d.fix = base::FixType::RtkFloat;
  d.offset_east_m = 0.6;
  d.run(6.0);
  d.fix = base::FixType::RtkFixed;
  d.run(2.0);
  d.fix = base::FixType::RtkFloat;
  d.run(1.0);
  EXPECT_GT(d.pose()->horizontal_sigma_m, 0.25);
}

TEST(Estimator, AFixedSolutionThatLastsIsBelievedAfterThreeSeconds) {
  Drive d;
  d.run(2.0);
  EXPECT_GT(d.pose()->horizontal_sigma_m, 0.25);
  d.run(2.5);
  EXPECT_LT(d.pose()->horizontal_sigma_m, 0.05);
}

TEST(Estimator, WorksWithAReceiverAloneAndSaysSo) {
  Drive d;
  d.tracks = false;
  d.compass = false;
  d.fix = base::FixType::Single;
  d.speed_mps = 1.2;
  d.run(20.0);
  ASSERT_TRUE(d.pose());
  EXPECT_EQ(d.pose()->source, "gnss");
  EXPECT_LT(d.position_error_m(), 0.5);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 10.0);
  EXPECT_NEAR(d.pose()->speed_mps.value(), 1.2, 0.1);
}

TEST(Estimator, APositionThatNothingCarriesOnGrowsOld) {
  Drive d;
  d.speed_mps = 0.8;
  d.run(20.0);
  EXPECT_EQ(d.pose()->stamp, d.now());
  d.gnss = false;  // the tracks carry on
  d.run(10.0);
  EXPECT_EQ(d.pose()->stamp, d.now());
  d.tracks = false;
  d.run(3.0);
  EXPECT_NEAR(base::seconds(d.now() - d.pose()->stamp), 3.0, 0.1);
  d.gnss = true;
  d.run(1.0);
  EXPECT_EQ(d.pose()->stamp, d.now());
}

// Nobody tells how fast it goes: it may stand, or be carried off.
TEST(Estimator, WithoutOdometryAndReceiverTheSpeedIsUnknownAndTheDoubtGrowsWithTime) {
  Drive d;
  d.speed_mps = 0.8;
  d.run(20.0);
  EXPECT_NEAR(d.pose()->speed_mps.value(), 0.8, 0.05);
  EXPECT_TRUE(d.pose()->yaw_rate_radps);
  // Given tracks that fall silent, the receiver still tells a speed, but no turn rate.
  d.tracks = false;
  d.run(3.0);
  EXPECT_NEAR(d.pose()->speed_mps.value(), 0.8, 0.05);
  EXPECT_FALSE(d.pose()->yaw_rate_radps);
  EXPECT_LT(d.pose()->horizontal_sigma_m, 0.5);
  // When it does so as well while the robot drives on,
  d.gnss = false;
  for (const double silent_s : {3.0, 10.0, 30.0}) {
    d.run(silent_s);
    EXPECT_FALSE(d.pose()->speed_mps) << silent_s;
    // then the truth stays within three sigma, which is not without bounds either.
    EXPECT_LT(d.position_error_m(), 3.0 * d.pose()->horizontal_sigma_m) << silent_s;
    EXPECT_LT(d.pose()->horizontal_sigma_m, 45.0) << silent_s;
  }
  EXPECT_GT(d.pose()->horizontal_sigma_m, 20.0);
  // A position ends the doubt.
  d.gnss = d.tracks = true;
  d.run(3.0);
  EXPECT_LT(d.position_error_m(), 0.2);
  EXPECT_LT(d.pose()->horizontal_sigma_m, 0.1);
}

TEST(Estimator, RefusesAndCountsWhatCannotBe) {
  Drive d;
  d.run(3.0);
  const auto before = d.estimator.belief().x;
  const auto rejected = d.estimator.health().rejected;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const Time now = d.now();
  base::GnssFix fix;
  fix.fix = base::FixType::RtkFixed;
  fix.stamp = now + milliseconds(1);
  fix.position = base::LatLon{nan, 26.0};
  d.estimator.take(fix, now);
  fix.stamp = now + std::chrono::seconds(1);  // from the future
  fix.position = base::LatLon{58.4, 26.8};
  d.estimator.take(fix, now);
  fix.stamp = now - std::chrono::seconds(2);  // older than the last one
  d.estimator.take(fix, now);
  d.estimator.take(base::GnssVelocity{now, inf, 0.0, {}}, now);
  d.estimator.take(base::Heading{now, nan, base::HeadingSource::Compass}, now);
  d.estimator.take(base::WheelTravel{now + milliseconds(1), nan, 0.0}, now);
  d.estimator.take(base::WheelTravel{now, 0.0, 0.0}, now);  // doubled stamp
  d.estimator.take(base::WheelTravel{now + milliseconds(2), 500.0, 500.0}, now);
  d.estimator.take(base::BaseMotion{now + milliseconds(3), {nan, 0.0}}, now);
  d.estimator.take(base::Attitude{now + std::chrono::hours(1), 0.0, 0.3}, now);
  EXPECT_EQ(d.estimator.health().rejected - rejected, 10u);
  EXPECT_EQ(before, d.estimator.belief().x);
}

TEST(Estimator, TheCovarianceStaysSymmetricAndPositiveForAVeryLongTime) {
  Drive d;
  d.noise_m = 0.02;
  d.fix = base::FixType::RtkFloat;
  for (int i = 0; i < 400; ++i) {
    d.speed_mps = i % 3 == 0 ? 0.0 : 0.8;
    d.rate_radps = i % 5 == 0 ? 0.5 : i % 7 == 0 ? -0.4 : 0.0;
    d.run(5.0);
    const StateMatrix& P = d.estimator.belief().P;
    ASSERT_TRUE(P.allFinite());
    ASSERT_LT((P - P.transpose()).norm(), 1e-12);
    const Eigen::SelfAdjointEigenSolver<StateMatrix> solver(P);
    ASSERT_GT(solver.eigenvalues().minCoeff(), -1e-12);
  }
}

// The error, measured with the filter's own idea of it, stays of the size that it claims.
TEST(Estimator, ItsCertaintyMatchesItsError) {
  double worse = 0.0;
  int count = 0;
  for (int run = 0; run < 10; ++run) {
    Drive d;
    d.noise_m = 0.015;
    d.compass_bias_rad = rad_from_deg(5.0 * (run - 5));
    d.slip = 0.9 + 0.02 * run;
    for (int i = 0; i < 20; ++i) {
      d.speed_mps = 0.7;
      d.rate_radps = i % 4 == 3 ? 0.3 : 0.0;
      d.run(2.0);
      if (i < 4) continue;
      const double sigma = std::max(0.005, d.pose()->horizontal_sigma_m);
      worse += std::pow(d.position_error_m() / sigma, 2);
      ++count;
    }
  }
  EXPECT_LT(worse / count, 3.0);  // 2 degrees of freedom
}

/// An inertial unit's receiver: its messages come late, with the time at which they were valid.
TEST(Estimator, PositionsThatComeLateAreFusedWhereTheyWereMeasured) {
  for (const double late_s : {0.04, 0.25, 1.0, 2.5}) {
    Drive d;
    d.gyro = true;
    d.told_late_s = late_s;
    d.run(5.0);
    d.speed_mps = 1.0;
    d.rate_radps = 0.2;
    d.run(20.0);
    double worst_m = 0.0;
    for (int i = 0; i < 1000; ++i) {
      d.tick();
      worst_m = std::max(worst_m, d.position_error_m());
    }
    EXPECT_LT(worst_m, 0.05) << late_s;  // taken for the present, they would be 2.5 m off
    EXPECT_LT(std::abs(d.yaw_error_deg()), 1.0) << late_s;
    // So late that the heading was still open when the first of them came, some are not believed.
    const auto h = d.estimator.health();
    EXPECT_LE(h.position.rejected, late_s > 2.0 ? 3u : 0u) << late_s;
    EXPECT_LE(h.velocity.rejected, late_s > 2.0 ? 30u : 0u) << late_s;
    EXPECT_EQ(h.resets, 0u) << late_s;
    EXPECT_NEAR(base::seconds(d.now() - *d.estimator.last_position()), late_s, 0.25) << late_s;
  }
}

// Velocities that err by 3 cm/s for ten seconds each add up to 0.13 m times the root of the
// seconds.
TEST(Estimator, AfterAFixIsLostThePlaceIsKnownNoBetterThanACoarseReceiverCanKeepIt) {
  Drive d;
  d.gyro = true;
  d.speed_mps = 1.0;
  d.run(30.0);
  EXPECT_LT(d.pose()->horizontal_sigma_m, 0.05);
  d.fix = base::FixType::Single;
  d.run(30.0);
  EXPECT_NEAR(d.pose()->horizontal_sigma_m, 0.73, 0.1);
  EXPECT_LT(d.position_error_m(), d.pose()->horizontal_sigma_m);
  // Standing it loses nothing more.
  d.speed_mps = 0.0;
  d.run(60.0);
  EXPECT_NEAR(d.pose()->horizontal_sigma_m, 0.75, 0.12);
  // However far it drives: no worse than the receiver itself.
  d.speed_mps = 1.0;
  d.run(600.0);
  EXPECT_LT(d.pose()->horizontal_sigma_m, 1.6);
  d.fix = base::FixType::RtkFixed;
  d.run(60.0);
  EXPECT_LT(d.pose()->horizontal_sigma_m, 0.05);
}

}  // namespace
}  // namespace roverd::nav
