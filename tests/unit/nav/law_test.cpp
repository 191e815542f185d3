#include "nav/track/law.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/track/observer.hpp"

namespace roverd::nav {
namespace {

TEST(Law, TheWordsOfTheParameterAreKnown) {
  EXPECT_EQ(law_from("path_frame"), TrackLaw::PathFrame);
  EXPECT_EQ(law_from("pure_pursuit"), TrackLaw::PurePursuit);
  EXPECT_EQ(law_from("stanley"), TrackLaw::Stanley);
  EXPECT_FALSE(law_from("pathframe"));
}

TEST(Law, OnThePathItDrivesThePathsCurvature) {
  const TrackParams p;
  EXPECT_DOUBLE_EQ(path_frame_1pm({0.0, 0.0, 0.2, 1.0}, p), 0.2);
  EXPECT_DOUBLE_EQ(stanley_1pm({0.0, 0.0, 0.2, 1.0}, 1.0, p), 0.2);
}

//   left of the path, or pointing left of it: turn right
TEST(Law, OffsetAndHeadingAreTurnedAgainst) {
  const TrackParams p;
  for (const double off : {0.05, 0.5, 5.0}) {
    EXPECT_LT(path_frame_1pm({off, 0.0, 0.0, 1.0}, p), 0.0);
    EXPECT_GT(path_frame_1pm({-off, 0.0, 0.0, 1.0}, p), 0.0);
    EXPECT_LT(stanley_1pm({off, 0.0, 0.0, 1.0}, 1.0, p), 0.0);
  }
  for (const double deg : {1.0, 30.0, 89.0, 91.0, 179.0}) {
    EXPECT_LT(path_frame_1pm({0.0, base::rad_from_deg(deg), 0.0, 1.0}, p), 0.0) << deg;
    EXPECT_GT(path_frame_1pm({0.0, base::rad_from_deg(-deg), 0.0, 1.0}, p), 0.0) << deg;
  }
}

//   κ·cos ψe/(1 − κe) − e/L² − (2ζ/L)·sin ψe by hand: L = 0.5, ζ = 1
TEST(Law, TheFormulaHolds) {
  TrackParams p;
  p.settle_min_m = 0.5;
  p.settle_time_s = 0.0;
  p.delay_s = 0.0;
  p.damping = 1.0;
  const double want = 0.3 * std::cos(0.1) / (1.0 - 0.3 * 0.05) - 0.05 / 0.25 - 4.0 * std::sin(0.1);
  EXPECT_NEAR(path_frame_1pm({0.05, 0.1, 0.3, 1.0}, p), want, 1e-12);
}

TEST(Law, FarAwayThePathIsApproachedAtThirtyDegrees) {
  const TrackParams p;
  EXPECT_NEAR(path_frame_1pm({8.0, base::rad_from_deg(-30.0), 0.0, 1.0}, p), 0.0, 1e-9);
  EXPECT_NEAR(course_error_rad(8.0, base::rad_from_deg(-30.0), 0.5, 0.9), 0.0, 1e-9);
}

TEST(Law, BeyondTheCentreOfTheBendItStaysFinite) {
  const TrackParams p;
  for (const double e : {1.9, 2.0, 2.1, 50.0}) {
    EXPECT_TRUE(std::isfinite(path_frame_1pm({e, 0.3, 0.5, 1.0}, p)));
    EXPECT_LT(std::abs(path_frame_1pm({e, 0.3, 0.5, 1.0}, p)), 10.0);
  }
}

TEST(Law, TheLongerTheDelayTheCalmer) {
  TrackParams p;
  p.delay_s = 0.0;
  const double quick = settle_length_m(1.0, p);
  p.delay_s = 0.6;
  EXPECT_GT(settle_length_m(1.0, p), quick);
  EXPECT_GE(settle_length_m(1.0, p), 1.5 * 0.6);
  EXPECT_EQ(settle_length_m(-1.0, p), settle_length_m(1.0, p));
}

TEST(Law, TheLessTheHeadingIsKnownTheCalmer) {
  const double known = base::rad_from_deg(4.0);
  EXPECT_EQ(calm_of(0.0, known), 1.0);
  EXPECT_EQ(calm_of(known, known), 1.0);
  EXPECT_DOUBLE_EQ(calm_of(2.0 * known, known), 2.0);
  EXPECT_EQ(calm_of(3.0, known), 2.5);
  const TrackParams p;
  const double sure = path_frame_1pm({0.0, 0.1, 0.0, 0.4, 1.0}, p);
  EXPECT_NEAR(path_frame_1pm({0.0, 0.1, 0.0, 0.4, 4.0}, p), sure / 4.0, 1e-12);
}

TEST(Observer, LearnsATurnThatNobodyCommanded) {
  const TrackParams p;
  YawObserver o;
  for (int i = 0; i < 500; ++i) o.step({1.0, 0.15}, 0.1, false, p, 0.02);
  EXPECT_NEAR(o.radps(), 0.05, 0.001);
}

TEST(Observer, IsFrozenWhereItsModelIsWorthLittle) {
  const TrackParams p;
  YawObserver o;
  for (int i = 0; i < 500; ++i) {
    o.step({0.1, 0.9}, 0.0, false, p, 0.02);  // slow
    o.step({1.0, 0.9}, 0.7, false, p, 0.02);  // turning hard
    o.step({1.0, 0.9}, 0.0, true, p, 0.02);   // saturated
    o.step({1.0, NAN}, 0.0, false, p, 0.02);
  }
  EXPECT_EQ(o.radps(), 0.0);
}

TEST(Observer, NeverCountersMoreThanAllowed) {
  TrackParams p;
  YawObserver o;
  for (int i = 0; i < 5000; ++i) o.step({1.0, 2.0}, 0.0, false, p, 0.02);
  EXPECT_EQ(o.radps(), p.observer_max_radps);
  p.observer_max_radps = 0.0;
  o.step({1.0, 2.0}, 0.0, false, p, 0.02);
  EXPECT_EQ(o.radps(), 0.0);
}

}  // namespace
}  // namespace roverd::nav
