// The vehicle is learned: by the plant of the simulator, its tracks and their delay, without bus,
// receiver or estimator.
//
//   told ──▶ delay ──▶ lag ──▶ limits ──▶ tracks ──▶ what the base shows, what a gyro shows

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "nav/identify/vehicle_learner.hpp"
#include "sim/tracks.hpp"

namespace roverd::nav {
namespace {

constexpr double kTick_s = 0.02;

/// The vehicle under its learner.
class Drive {
 public:
  explicit Drive(const sim::DriveParams& p) : plant(p), tracks(1) { use = set; }

  void tick(base::BodyTwist told) {
    if (base::seconds(now - told_at) > told_every_s - 0.001) {
      told_at = now;
      seen = tracks.measured();
    }
    learner.see({.now = now,
                 .tracks = seen,
                 .tracks_stamp = told_at,
                 .yaw_rate_radps = tracks.ground().twist.angular_radps,
                 .ours = ours});
    learner.handle(set, use);
    learner.sent(told, set);
    for (int k = 0; k < 4; ++k) tracks.step(plant, told, false, kTick_s / 4.0);
    now += base::from_seconds(kTick_s);
  }
  void drive(double seconds, const std::function<base::BodyTwist(double)>& told) {
    for (int i = 0; i * kTick_s < seconds; ++i) tick(told(i * kTick_s));
  }
  /// From standing to 1 m/s at 0.7, on for a while, and down at `decel`.
  void run_and_stop(double decel_mps2, double on_s = 3.0) {
    drive(1.0 / 0.7, [](double t) { return base::BodyTwist{0.7 * t, 0.0}; });
    drive(on_s, [](double) { return base::BodyTwist{1.0, 0.0}; });
    drive(1.0 / decel_mps2, [&](double t) {
      return base::BodyTwist{std::max(0.0, 1.0 - decel_mps2 * t), 0.0};
    });
    drive(4.0, [](double) { return base::BodyTwist{}; });
  }
  /// Small corrections to both sides at 1 m/s, as steering along a line makes them.
  void steer(double seconds) {
    drive(1.0 / 0.7, [](double t) { return base::BodyTwist{0.7 * t, 0.0}; });
    drive(seconds, [](double t) {
      return base::BodyTwist{1.0, 0.08 * std::sin(2.1 * t) + 0.04 * std::sin(5.3 * t + 1.0)};
    });
  }

  sim::DriveParams plant;
  sim::Tracks tracks;
  VehicleLearner learner;
  PathParams set;
  PathParams use;
  bool ours = true;
  double told_every_s = 0.0;
  base::Time told_at{};
  base::BodyTwist seen;
  base::Time now = base::Time{} + std::chrono::seconds(10);
};

sim::DriveParams plant_with(double delay_s, double decel_mps2 = 1.2, double accel_mps2 = 1.0) {
  sim::DriveParams p;
  p.delay_s = delay_s;
  p.decel_mps2 = decel_mps2;
  p.accel_mps2 = accel_mps2;
  return p;
}

TEST(Identify, TheDelayOfSteeringIsFoundWithinThirtyMilliseconds) {
  for (const double delay_s : {0.1, 0.2, 0.3, 0.4}) {
    Drive d(plant_with(delay_s));
    d.steer(15.0);
    const auto found = d.learner.learned(d.set).delay_s;
    ASSERT_TRUE(found) << delay_s;
    EXPECT_NEAR(found->value, delay_s + d.plant.lag_s, 0.03) << delay_s;
    EXPECT_LT(found->sigma, 0.03);
    EXPECT_NEAR(d.use.track.delay_s, found->value, 0.011);
  }
}

TEST(Identify, SpeedingUpTellsTheDelayBeforeAnythingWasSteered) {
  for (const double delay_s : {0.1, 0.35}) {
    Drive d(plant_with(delay_s));
    d.drive(1.0 / 0.7, [](double t) { return base::BodyTwist{0.7 * t, 0.0}; });
    d.drive(1.0, [](double) { return base::BodyTwist{1.0, 0.0}; });
    const auto found = d.learner.learned(d.set).delay_s;
    ASSERT_TRUE(found) << delay_s;
    EXPECT_NEAR(found->value, delay_s + d.plant.lag_s, 0.05) << delay_s;
  }
}

TEST(Identify, ADelayBeyondTheBoundsIsKnownButNotUsed) {
  Drive d(plant_with(0.65));
  d.set.track.delay_s = d.use.track.delay_s = 0.15;
  d.steer(15.0);
  ASSERT_TRUE(d.learner.learned(d.set).delay_s);
  EXPECT_GT(d.learner.learned(d.set).delay_s->value, 0.65);
  EXPECT_NEAR(d.use.track.delay_s, 0.55, 1e-9);
}

TEST(Identify, WhatBrakesLessThanToldIsMeasuredWithinATenth) {
  for (const double decel_mps2 : {0.2, 0.3, 0.45}) {
    for (const double delay_s : {0.06, 0.35}) {
      Drive d(plant_with(delay_s, decel_mps2));
      d.run_and_stop(0.7);
      const auto found = d.learner.learned(d.set).braking_mps2;
      ASSERT_TRUE(found) << decel_mps2;
      EXPECT_NEAR(found->value, decel_mps2, 0.1 * decel_mps2);
      EXPECT_LE(d.use.speed.decel_mps2, decel_mps2);
      EXPECT_GT(d.use.speed.decel_mps2, 0.8 * decel_mps2);
    }
  }
}

TEST(Identify, BrakesThatDoAsToldKeepWhatWasSetOnceTheyShowedIt) {
  Drive d(plant_with(0.06));
  d.tick({});
  d.tick({});
  d.tick({});
  EXPECT_TRUE(d.use.prove_braking);
  d.run_and_stop(0.8);
  EXPECT_FALSE(d.use.prove_braking);
  EXPECT_NEAR(d.use.speed.decel_mps2, d.set.speed.decel_mps2, 1e-9);
  EXPECT_FALSE(d.learner.learned(d.set).braking_mps2);
}

TEST(Identify, BrakesThatAreBetterThanSetAreNotPlannedWith) {
  Drive d(plant_with(0.06, 1.0));
  d.run_and_stop(2.0);  // harder than it can
  ASSERT_TRUE(d.learner.learned(d.set).braking_mps2);
  EXPECT_NEAR(d.learner.learned(d.set).braking_mps2->value, 1.0, 0.1);
  EXPECT_NEAR(d.use.speed.decel_mps2, d.set.speed.decel_mps2, 1e-9);
}

TEST(Identify, ALoadThatSlowsItDownIsNotTakenForADelay) {
  for (const double delay_s : {0.1, 0.3}) {
    Drive d(plant_with(delay_s, 0.5, 0.4));
    for (int runs = 0; runs < 3; ++runs) d.run_and_stop(0.7);
    const auto found = d.learner.learned(d.set);
    ASSERT_TRUE(found.delay_s && found.acceleration_mps2) << delay_s;
    EXPECT_NEAR(found.delay_s->value, delay_s + d.plant.lag_s, 0.05) << delay_s;
    EXPECT_GT(found.delay_s->sigma, 0.03);
    EXPECT_NEAR(found.acceleration_mps2->value, 0.4, 0.04);
  }
}

TEST(Identify, ABaseThatTellsTwentyTimesASecondTeachesBrakingToo) {
  for (const double decel_mps2 : {0.3, 1.2}) {
    Drive d(plant_with(0.15, decel_mps2));
    d.told_every_s = 0.05;
    for (int runs = 0; runs < 3; ++runs) d.run_and_stop(0.7);
    EXPECT_FALSE(d.use.prove_braking) << decel_mps2;
    EXPECT_NEAR(d.use.speed.decel_mps2, std::min(0.6, 0.92 * decel_mps2), 0.03) << decel_mps2;
    EXPECT_NEAR(d.use.track.delay_s, 0.24, 0.06);
  }
}

TEST(Identify, ALoadThatWasTakenOffIsForgottenAfterAStopThatShowsMore) {
  Drive d(plant_with(0.06, 0.3));
  d.run_and_stop(0.8);
  ASSERT_LT(d.use.speed.decel_mps2, 0.31);
  d.plant.decel_mps2 = 1.2;
  d.learner.doubt_braking();
  for (int stops = 0; stops < 3; ++stops) d.run_and_stop(0.8);
  EXPECT_NEAR(d.use.speed.decel_mps2, d.set.speed.decel_mps2, 0.02);
}

TEST(Identify, ALateVehicleIsNotTakenForOneThatDoesNotBrake) {
  Drive d(plant_with(0.45));
  d.set.track.delay_s = d.use.track.delay_s = 0.1;
  d.run_and_stop(0.6);
  EXPECT_FALSE(d.learner.learned(d.set).braking_mps2);
}

TEST(Identify, WhatSomebodyElseDrivesTeachesNothing) {
  Drive d(plant_with(0.2, 0.3));
  d.ours = false;
  d.steer(15.0);
  d.run_and_stop(0.8);
  EXPECT_FALSE(d.learner.learned(d.set).delay_s);
  EXPECT_FALSE(d.learner.learned(d.set).braking_mps2);
}

TEST(Identify, WhereSomebodyElseDroveTheFirstSecondIsNotLookedAt) {
  Drive d(plant_with(0.2));
  d.steer(15.0);
  const double before_s = d.learner.learned(d.set).delay_s->value;
  for (int i = 0; i < 20; ++i) {  // the radio brakes hard, gives back, and takes it again
    d.ours = false;
    d.drive(0.6, [](double) { return base::BodyTwist{}; });
    d.ours = true;
    d.drive(0.6, [](double) { return base::BodyTwist{1.0, 0.2}; });
  }
  EXPECT_NEAR(d.learner.learned(d.set).delay_s->value, before_s, 0.005);
}

TEST(Identify, StandingTeachesNothing) {
  Drive d(plant_with(0.2));
  d.drive(30.0, [](double) { return base::BodyTwist{}; });
  EXPECT_FALSE(d.learner.learned(d.set).delay_s);
  EXPECT_NEAR(d.use.track.delay_s, d.set.track.delay_s, 1e-9);
}

TEST(Identify, WhatWasLearnedBeforeHoldsUntilItIsLearnedAnew) {
  Drive d(plant_with(0.3));
  base::VehicleLearned known;
  known.delay_s = base::LearnedNumber{0.25, 0.01};
  known.braking_mps2 = base::LearnedNumber{0.4, 0.02};
  d.learner.recall(known);
  d.tick({});
  EXPECT_NEAR(d.use.track.delay_s, 0.25, 1e-9);
  EXPECT_LE(d.use.speed.decel_mps2, 0.92 * 0.4 + 1e-9);
  d.steer(15.0);
  EXPECT_NEAR(d.use.track.delay_s, 0.39, 0.03);
}

}  // namespace
}  // namespace roverd::nav
