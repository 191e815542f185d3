// A receiver that drifts, and says so with its velocity too, against what ground does to a robot.

#include "nav/vote/run_off.hpp"

#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::rad_from_deg;

/// What tracks, gyro and an RTK receiver tell of a drive that begins eastwards.
class StraightTold {
 public:
  double scale = 0.95;
  double crab = 0.0;      ///< to its left, for each metre
  EnuPoint slide;         ///< over ground, for each metre
  EnuPoint drift_mps;     ///< the receiver's lie
  double gyro_radps = 0;  ///< the gyro's
  RunOff::Look look;
  RunOff run_off;

  explicit StraightTold(unsigned seed = 5) : random_(seed) {
    look.judgeable = true;
    look.at.yaw_sigma_rad = rad_from_deg(2.0);
  }

  /// @return the most that was proved meanwhile.
  double go(double speed_mps, double rate_radps, double for_s) {
    double most = 0.0;
    constexpr double kDt_s = 0.02;
    for (int i = 0; i < for_s / kDt_s; ++i) {
      step(speed_mps * kDt_s, rate_radps * kDt_s, kDt_s);
      if (++count_ % 10 != 0) continue;
      tell();
      most = std::max(most, run_off.proved());
    }
    return most;
  }

  /// Bends to and fro, 24 s.
  double serpentine(double speed_mps) {
    double most = 0.0;
    for (int i = 0; i < 4; ++i) {
      most = std::max(most, go(speed_mps, 0.2, 3.0));
      most = std::max(most, go(speed_mps, -0.2, 3.0));
    }
    return most;
  }

 private:
  void step(double ahead_m, double turn_rad, double dt_s) {
    now_ += base::from_seconds(dt_s);
    yaw_rad_ += turn_rad;
    const double c = std::cos(yaw_rad_);
    const double s = std::sin(yaw_rad_);
    const double path_m = std::abs(ahead_m);
    at_.east_m +=
        ahead_m * (scale * c - crab * s) + path_m * slide.east_m + drift_mps.east_m * dt_s;
    at_.north_m +=
        ahead_m * (scale * s + crab * c) + path_m * slide.north_m + drift_mps.north_m * dt_s;
    Moment& m = look.at;
    m.ref_rad += turn_rad + gyro_radps * dt_s;
    m.x_m += ahead_m * std::cos(m.ref_rad);
    m.y_m += ahead_m * std::sin(m.ref_rad);
    m.ahead_m += ahead_m;
    m.path_m += path_m;
    m.t = now_;
  }

  void tell() {
    look.spot.t = now_;
    look.spot.at = {at_.east_m + 0.015 * normal_(random_), at_.north_m + 0.015 * normal_(random_)};
    look.spot.sigma_m = 0.015;
    run_off.look(look);
  }

  Time now_{};
  int count_ = 0;
  double yaw_rad_ = 0.0;
  EnuPoint at_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

TEST(RunOff, AReceiverThatDriftsAsideIsProvedWithinThreeSecondsAndItsWayIsTold) {
  for (const double mps : {0.3, 0.5, 0.8}) {
    StraightTold drive;
    EXPECT_LT(drive.go(1.0, 0.0, 12.0), 0.5) << mps;
    drive.drift_mps = {0.0, mps};
    EXPECT_GE(drive.go(1.0, 0.0, 3.0), 1.0) << mps;
    const Difference off = drive.run_off.off();
    EXPECT_EQ(off.of, Difference::Of::Way);
    EXPECT_NEAR(off.window_s, 3.0, 0.5) << mps;
    EXPECT_NEAR(off.size, 3.0 * mps, 0.3 * 3.0 * mps) << mps;
  }
}

TEST(RunOff, AtRestMuchLessIsEnough) {
  StraightTold drive;
  drive.go(1.0, 0.0, 8.0);
  EXPECT_LT(drive.go(0.0, 0.0, 20.0), 1.0);
  drive.drift_mps = {0.08, 0.0};
  EXPECT_GE(drive.go(0.0, 0.0, 5.0), 1.0);
}

TEST(RunOff, GroundThatSlipsOrCrabsProvesNothing) {
  for (const double scale : {1.0, 0.8, 0.65}) {
    for (const double crab : {0.0, 0.1, -0.1}) {
      StraightTold drive;
      drive.scale = scale;
      drive.crab = crab;
      EXPECT_LT(drive.serpentine(1.0), 1.0) << scale << " " << crab;
      EXPECT_LT(drive.go(-0.6, 0.1, 5.0), 1.0) << scale << " " << crab;
    }
  }
}

TEST(RunOff, GroundThatGivesWayAllAtOnceProvesNothing) {
  for (const auto& [before, after] : {std::pair{1.0, 0.7}, {0.92, 0.6}, {1.0, 0.6}, {0.8, 0.6}}) {
    StraightTold drive;
    drive.scale = before;
    EXPECT_LT(drive.go(1.0, 0.0, 15.0), 1.0) << before;
    drive.scale = after;
    EXPECT_LT(drive.go(1.0, 0.0, 30.0), 1.0) << before << " to " << after;
    EXPECT_LT(drive.go(1.0, 0.3, 5.0), 1.0) << before << " to " << after;
  }
}

TEST(RunOff, GroundThatSlipsFromNoneToMuchByPlaceProvesNothingWhereTheHeadingIsNotSure) {
  std::mt19937_64 ground(17);
  std::uniform_real_distribution<double> slip(0.02, 0.45);
  std::uniform_real_distribution<double> askew(-1.0, 1.0);
  int accused = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    StraightTold drive(seed);
    drive.look.at.yaw_sigma_rad = rad_from_deg(4.6);
    drive.look.at.yaw_rad = rad_from_deg(6.0) * askew(ground);
    double most = 0.0;
    for (int place = 0; place < 5; ++place) {
      drive.scale = 1.0 - slip(ground);
      most = std::max(most, drive.go(1.0, 0.0, 4.0));
    }
    accused += most >= 1.0 ? 1 : 0;
  }
  EXPECT_EQ(accused, 0);
}

TEST(RunOff, ALieThatDrawsAsideAsWellIsNoGroundThatGivesWay) {
  StraightTold drive;
  drive.go(1.0, 0.0, 10.0);
  drive.drift_mps = {-0.3, 0.1};
  EXPECT_GE(drive.go(1.0, 0.0, 8.0), 1.0);
}

TEST(RunOff, ASlideIsGroundsWhereTheSlopeIsThatSteepAndALieOnTheLevel) {
  StraightTold slope;
  const double fall = std::tan(rad_from_deg(20.0));
  // It falls to the south and the robot drives east: downhill is to its right.
  slope.look.downhill = {0.0, -fall};
  slope.slide = {0.0, -0.5 * fall};
  EXPECT_LT(slope.go(1.0, 0.0, 15.0), 1.0);

  StraightTold level;
  level.go(1.0, 0.0, 8.0);
  level.slide = slope.slide;
  EXPECT_GE(level.go(1.0, 0.0, 8.0), 1.0);

  StraightTold nothing_tells;  // how it leans
  nothing_tells.look.doubt = 0.36;
  nothing_tells.slide = slope.slide;
  EXPECT_LT(nothing_tells.go(1.0, 0.0, 15.0), 1.0);
}

TEST(RunOff, AGyroThatLiesIsNotTakenForAReceiverThatDrifts) {
  for (const double dps : {2.0, -4.0}) {
    StraightTold drive;
    drive.go(1.0, 0.0, 10.0);
    drive.gyro_radps = rad_from_deg(dps);
    EXPECT_LT(drive.go(1.0, 0.0, 6.0), 1.0) << dps;
  }
}

TEST(RunOff, OnePositionThatJumpsIsNoDrift) {
  StraightTold drive;
  drive.go(1.0, 0.0, 10.0);
  drive.drift_mps = {0.0, 0.6};  // 0.12 m, and stays there
  double most = drive.go(1.0, 0.0, 0.2);
  drive.drift_mps = {};
  most = std::max(most, drive.go(1.0, 0.0, 5.0));
  EXPECT_LT(most, 1.0);
}

TEST(RunOff, WhereItCannotBeJudgedItIsForgotten) {
  StraightTold drive;
  drive.go(1.0, 0.0, 10.0);
  drive.drift_mps = {0.0, 0.6};
  ASSERT_GE(drive.go(1.0, 0.0, 3.0), 1.0);
  drive.look.judgeable = false;
  drive.go(1.0, 0.0, 0.2);
  EXPECT_EQ(drive.run_off.proved(), 0.0);
}

}  // namespace
}  // namespace roverd::nav
