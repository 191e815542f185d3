// A compass that the motors' currents disturb, and values that outlive a restart.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/estimate/estimator.hpp"

namespace roverd::nav {
namespace {

using base::rad_from_deg;
using std::chrono::milliseconds;

/// Drives north with currents that change all the time; the left one turns the compass by
/// 2 deg/A, the right one by -1 deg/A, at once.
struct DisturbedDrive {
  explicit DisturbedDrive(EstimateParams params) : estimator(params) {}

  void run(double seconds, double scale = 0.92) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      now += milliseconds(20);
      ++ticks;
      const double left_a = 4.0 + 3.0 * std::sin(0.02 * ticks);
      const double right_a = 4.0 + 3.0 * std::sin(0.013 * ticks + 1.0);
      for (const int motor : {1, 2}) {
        base::MotorState m;
        m.stamp = now;
        m.motor = motor;
        m.current_a = motor == 2 ? left_a : right_a;
        estimator.take(m, now);
      }
      base::Inertial inertial;
      inertial.stamp = now;
      inertial.rate_radps = base::BodyVector{0.0, 0.0, rad_from_deg(0.3)};
      estimator.take(inertial, now);
      const double ahead_m = 0.016 / scale;
      north_m += 0.016;
      estimator.take(base::WheelTravel{now, ahead_m, ahead_m}, now);
      estimator.take(base::BaseMotion{now, {ahead_m / 0.02, 0.0}}, now);
      if (ticks % 10 == 0) hear_receiver();
      // Clockwise on a compass is a smaller yaw.
      base::Heading compass{now, 0.0, base::HeadingSource::Compass};
      compass.yaw_rad = base::wrap_rad(base::kPi / 2.0 + rad_from_deg(10.0) -
                                       rad_from_deg(2.0) * left_a + rad_from_deg(1.0) * right_a);
      if (ticks % 5 == 0) estimator.take(compass, now);
      estimator.advance(now);
    }
  }
  void hear_receiver() {
    base::GnssFix fix;
    fix.stamp = now;
    fix.fix = base::FixType::RtkFixed;
    fix.position = frame.to_global({0.0, north_m - 0.8 * 0.12});
    estimator.take(fix, now);
    estimator.take(base::GnssVelocity{now, 0.0, 0.8, {}}, now);
  }

  Estimator estimator;
  base::LocalFrame frame{9, {58.378, 26.729}};
  base::Time now{std::chrono::seconds(100)};
  double north_m = 0.0;
  int ticks = 0;
};

EstimateParams learning() {
  EstimateParams p;
  p.compass_current_sigma_deg_per_a = 1.5;
  p.compass_current_lag_s = 0.0;
  p.compass_latency_s = 0.0;
  p.gyro_bias_sigma_dps = 0.5;
  return p;
}

TEST(EstimatorCurrents, WhatEachMotorDoesToTheCompassIsLearned) {
  DisturbedDrive d(learning());
  d.run(180.0);
  const StateVector& x = d.estimator.belief().x;
  EXPECT_NEAR(base::deg_from_rad(x(kCompassLeft)), -2.0, 0.4);
  EXPECT_NEAR(base::deg_from_rad(x(kCompassRight)), 1.0, 0.4);
  EXPECT_NEAR(base::deg_from_rad(base::angle_diff_rad(base::kPi / 2.0, x(kYaw))), 0.0, 1.0);
}

TEST(EstimatorLearned, ScaleAndGyroBiasAreToldOnceTheyAreKnownAndRecalled) {
  DisturbedDrive d{EstimateParams{}};
  EXPECT_FALSE(d.estimator.learned().odometry_scale);
  d.run(60.0);
  const Learned learned = d.estimator.learned();
  ASSERT_TRUE(learned.odometry_scale);
  EXPECT_NEAR(learned.odometry_scale->value, 0.92, 0.01);
  ASSERT_TRUE(learned.gyro_bias_radps);
  EXPECT_NEAR(base::deg_from_rad(learned.gyro_bias_radps->value), 0.3, 0.1);
  // Another life begins with them, less certain, and tells them only when they are learned again.
  DisturbedDrive next{EstimateParams{}};
  next.estimator.recall(learned);
  EXPECT_DOUBLE_EQ(next.estimator.health().odometry_scale, learned.odometry_scale->value);
  EXPECT_FALSE(next.estimator.learned().odometry_scale);
  next.run(60.0, 0.90);  // other ground
  ASSERT_TRUE(next.estimator.learned().odometry_scale);
  EXPECT_NEAR(next.estimator.learned().odometry_scale->value, 0.90, 0.01);
}

}  // namespace
}  // namespace roverd::nav
