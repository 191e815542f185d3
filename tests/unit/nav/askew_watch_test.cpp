#include "nav/estimate/askew_watch.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

/// So many headings, each after 0.2 m of way; courses of a slow robot scatter by 5 degrees.
AskewWatch seen(double off_deg, int headings, double slide_deg = 0.0) {
  AskewWatch w;
  std::mt19937 random{7};
  std::normal_distribution<double> noise{0.0, base::rad_from_deg(5.0)};
  for (int i = 0; i < headings; ++i) {
    const double slides = base::rad_from_deg(i % 2 == 0 ? slide_deg : -slide_deg);
    w.take(base::wrap_rad(base::rad_from_deg(off_deg) + slides + noise(random)),
           base::rad_from_deg(5.0), 0.2);
  }
  return w;
}

TEST(AskewWatch, MeasuresAConstantOffsetEitherWayAndAcrossTheSeam) {
  for (const double off_deg : {20.0, -20.0, 90.0, 179.5, -120.0}) {
    const AskewWatch w = seen(off_deg, 60);
    ASSERT_TRUE(w.askew()) << off_deg;
    const auto m = w.measured();
    const double error_rad = base::angle_diff_rad(base::rad_from_deg(off_deg), m->rad);
    EXPECT_LT(std::abs(error_rad), 3.0 * m->sigma_rad) << off_deg;
    EXPECT_LT(base::deg_from_rad(m->sigma_rad), 1.5) << off_deg;
    EXPECT_NEAR(m->way_m, 12.0, 1e-9);
  }
}

TEST(AskewWatch, ATwentiethOfATurnIsFoundOutWithinThreeMetres) {
  EXPECT_TRUE(seen(20.0, 15).askew());
}

TEST(AskewWatch, WhatASlopeMakesOfItIsNoMounting) {
  EXPECT_FALSE(seen(6.0, 200).askew());
  EXPECT_FALSE(seen(0.0, 200, 6.0).askew());
  EXPECT_TRUE(seen(6.0, 200).proved());
}

TEST(AskewWatch, SaysNothingOfAFewHeadingsNorOfARobotThatStands) {
  EXPECT_FALSE(seen(40.0, 4).measured());
  AskewWatch w;
  for (int i = 0; i < 50; ++i) w.take(0.7, 0.05, 0.0);
  EXPECT_FALSE(w.askew());
  EXPECT_FALSE(w.proved());
}

TEST(AskewWatch, ForgetsAndLearnsANewMounting) {
  AskewWatch w = seen(20.0, 60);
  w.forget();
  EXPECT_FALSE(w.measured());
  for (int i = 0; i < 60; ++i) w.take(0.0, 0.05, 0.2);
  EXPECT_TRUE(w.proved());
}

}  // namespace
}  // namespace roverd::nav
