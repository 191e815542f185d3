// Positions that wander away from their receiver's own velocity.

#include "nav/estimate/wander_watch.hpp"

#include <random>

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

using std::chrono::milliseconds;

/// A receiver that drives a bend at 1 m/s, five times a second.
struct Wanderer {
  std::mt19937_64 random{7};
  WanderWatch watch;
  base::Time now{};
  base::EnuPoint at;
  base::EnuPoint error;  ///< first order, 15 s
  double white_m = 0.03;
  double wander_m = 0.0;
  double velocity_off_mps = 0.0;
  base::EnuPoint shift;

  double normal() { return std::normal_distribution<double>()(random); }
  void epoch() {
    constexpr double kDt_s = 0.2;
    now += milliseconds(200);
    const double yaw = 0.05 * base::seconds(now.time_since_epoch());
    at.east_m += std::cos(yaw) * kDt_s;
    at.north_m += std::sin(yaw) * kDt_s;
    const double keep = std::exp(-kDt_s / 15.0);
    for (double* e : {&error.east_m, &error.north_m}) {
      *e = *e * keep + wander_m * std::sqrt(1.0 - keep * keep) * normal();
    }
    watch.velocity(
        {std::cos(yaw) + velocity_off_mps + 0.05 * normal(), std::sin(yaw) + 0.05 * normal()}, now);
    watch.position({at.east_m + error.east_m + shift.east_m + white_m * normal(),
                    at.north_m + error.north_m + shift.north_m + white_m * normal()},
                   now);
  }
  /// @return the share of epochs in which it was said to wander
  double drive(double seconds) {
    int wandering = 0;
    const int n = static_cast<int>(seconds * 5.0);
    for (int i = 0; i < n; ++i) {
      epoch();
      wandering += watch.wanders() ? 1 : 0;
    }
    return static_cast<double>(wandering) / n;
  }
};

TEST(WanderWatch, ReflectionsAreFoundWithinSecondsAndMeasured) {
  Wanderer w;
  w.wander_m = 0.8;
  w.drive(8.0);
  EXPECT_TRUE(w.watch.wanders());
  double sum = 0.0;
  for (int i = 0; i < 60; ++i) {
    w.drive(1.0);
    sum += w.watch.rate_m2ps() / 60.0;
  }
  EXPECT_NEAR(sum, 2.0 * 0.8 * 0.8 / 15.0, 0.02);
  w.wander_m = 0.0;  // out of the trees
  w.drive(20.0);
  EXPECT_FALSE(w.watch.wanders());
}

TEST(WanderWatch, NoiseASlowDriftAVelocityThatErrsAndAMovedBaseAreNoWandering) {
  Wanderer white;
  white.white_m = 0.15;
  EXPECT_EQ(white.drive(300.0), 0.0);
  Wanderer slow;  // as an honest float solution's: 0.25 m within minutes
  slow.wander_m = 0.12;
  EXPECT_EQ(slow.drive(300.0), 0.0);
  Wanderer lies;
  lies.velocity_off_mps = 0.5;
  EXPECT_EQ(lies.drive(60.0), 0.0);
  Wanderer moved;
  EXPECT_EQ(moved.drive(20.0), 0.0);
  moved.shift = {3.0, 0.0};
  EXPECT_EQ(moved.drive(20.0), 0.0);
}

TEST(WanderWatch, ShortGapsDoNotMakeItForgetAndLongOnesDo) {
  Wanderer w;
  w.wander_m = 0.8;
  w.drive(12.0);
  ASSERT_TRUE(w.watch.wanders());
  w.now += std::chrono::seconds(3);
  w.epoch();
  EXPECT_TRUE(w.watch.wanders());
  w.now += std::chrono::seconds(30);
  w.epoch();
  w.epoch();
  EXPECT_FALSE(w.watch.wanders());
  EXPECT_EQ(w.watch.rate_m2ps(), 0.0);
}

TEST(WanderWatch, CalmPositionsAreKnownAfterFiveSecondsAndThoseThatWanderOnceTheyAreFound) {
  int known_too_soon = 0;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Wanderer calm;
    calm.random.seed(seed);
    calm.drive(3.0);
    EXPECT_GT(calm.watch.unknown_s(), 4.0) << seed;
    calm.drive(2.2);
    EXPECT_EQ(calm.watch.unknown_s(), 0.0) << seed;
    Wanderer w;
    w.random.seed(seed);
    w.wander_m = 0.8;
    w.drive(5.0);
    known_too_soon += w.watch.unknown_s() == 0.0 ? 1 : 0;
    w.drive(3.2);
    EXPECT_EQ(w.watch.unknown_s(), 0.0) << seed;
    found += w.watch.wanders() ? 1 : 0;
  }
  EXPECT_LE(known_too_soon, 3);
  EXPECT_GE(found, 95);
}

TEST(WanderWatch, WithoutAVelocityNothingIsSaid) {
  WanderWatch watch;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  base::Time now{};
  for (int i = 0; i < 200; ++i, now += milliseconds(200)) {
    watch.position({normal(random), normal(random)}, now);
    if (i == 30) {
      EXPECT_GT(watch.unknown_s(), 1.0);
    }
    if (i == 41) {
      EXPECT_EQ(watch.unknown_s(), 0.0);  // 8 s: it never will
    }
  }
  EXPECT_FALSE(watch.wanders());
  EXPECT_EQ(watch.rate_m2ps(), 0.0);
}

}  // namespace
}  // namespace roverd::nav
