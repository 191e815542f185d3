// Positions that scatter more than their receiver claims.

#include "nav/estimate/noise_watch.hpp"

#include <random>

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

using std::chrono::milliseconds;

/// Off from where odometry has the antenna: white noise, a slow error, a slide.
bool noisy_after(double white_m, double slide_mps, double for_s, NoiseWatch& watch) {
  static std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  static base::Time now{};
  for (double t_s = 0.0; t_s < for_s; t_s += 0.2, now += milliseconds(200)) {
    watch.take({slide_mps * t_s + white_m * normal(random), white_m * normal(random)}, 0.02, now);
  }
  return watch.noisy();
}

TEST(NoiseWatch, WhiteNoiseOfSeveralTimesTheClaimIsSeenAndForgivenWhenItIsOver) {
  NoiseWatch watch;
  EXPECT_FALSE(noisy_after(0.02, 0.0, 60.0, watch));
  EXPECT_TRUE(noisy_after(0.07, 0.0, 4.0, watch));
  EXPECT_FALSE(noisy_after(0.02, 0.0, 8.0, watch));
}

TEST(NoiseWatch, ASlideAJumpAndAGapAreNoNoise) {
  NoiseWatch watch;
  EXPECT_FALSE(noisy_after(0.015, 0.2, 20.0, watch));
  base::Time now = base::Time{} + std::chrono::hours(1);
  NoiseWatch other;
  for (int i = 0; i < 50; ++i, now += milliseconds(200)) {
    other.take({i < 25 ? 0.0 : 3.0, 0.0}, 0.02, now);  // the base was moved
    EXPECT_FALSE(i == 25 && other.noisy());
  }
  EXPECT_FALSE(other.noisy());
  NoiseWatch third;
  for (int i = 0; i < 20; ++i, now += std::chrono::seconds(2)) {
    third.take({0.5 * (i % 2), 0.0}, 0.02, now);
  }
  EXPECT_FALSE(third.noisy());
}

TEST(NoiseWatch, OneWildEpochConvictsNobody) {
  NoiseWatch watch;
  base::Time now{};
  for (int i = 0; i < 40; ++i, now += milliseconds(200)) {
    watch.take({i == 20 ? 0.10 : 0.0, 0.0}, 0.02, now);
    EXPECT_FALSE(watch.noisy()) << i;
  }
}

}  // namespace
}  // namespace roverd::nav
