// A robot that does not drive where it points: on a slope it slides downhill, and some drive aside
// by themselves.

#include <cmath>

#include <gtest/gtest.h>

#include "nav/track/tracker.hpp"
#include "rails.hpp"

namespace roverd::nav {
namespace {

constexpr double kQuarter_radps = base::kPi / 2.0 / 4.0;

/// RTK, a gyro and no compass, on a drive with a turn to the left after each leg.
Drive on_a_slope(double slide_east) {
  Drive d;
  d.gyro = true;
  d.compass = false;
  d.slide_east = slide_east;
  d.noise_m = 0.008;
  d.speed_mps = 1.0;
  return d;
}

void leg_and_turn(Drive& d, double leg_s) {
  d.rate_radps = 0.0;
  d.run(leg_s);
  d.rate_radps = kQuarter_radps;
  d.run(4.0);
  d.rate_radps = 0.0;
}

// Uphill is west; it drives north, then west, south, east.
//
//      ┌──◀──┐
//      ▼     ▲    ▶ downhill
//      └──▶──┘
TEST(SideSlip, ASlideDownhillIsLearnedAndNoPositionIsRefused) {
  for (const double slide : {0.02, 0.05, 0.10, -0.10}) {
    Drive d = on_a_slope(slide);
    for (int leg = 0; leg < 4; ++leg) leg_and_turn(d, 15.0);
    d.run(3.0);
    EXPECT_EQ(d.estimator.health().position.rejected, 0u) << slide;
    EXPECT_EQ(d.estimator.health().resets, 0u) << slide;
    EXPECT_LT(d.position_error_m(), 0.03) << slide;
    EXPECT_LT(std::abs(d.yaw_error_deg()), 1.5) << slide;
    EXPECT_NEAR(d.estimator.slide().east_m, slide, 0.02) << slide;
  }
}

TEST(SideSlip, AfterATurnOnASlopeItIsWhereItSaysWithinItsSigma) {
  Drive d = on_a_slope(0.10);
  leg_and_turn(d, 20.0);
  leg_and_turn(d, 20.0);
  double worst = 0.0;
  for (int i = 0; i < 40; ++i) {
    d.run(0.5);
    worst = std::max(worst, d.position_error_m() / d.pose()->horizontal_sigma_m);
  }
  EXPECT_LT(worst, 3.5);
}

TEST(SideSlip, TwoAntennasTellCrabFromHeading) {
  Drive d;
  d.gyro = d.antennas = true;
  d.compass = false;
  d.crab = 0.10;
  d.speed_mps = 1.0;
  d.run(20.0);
  EXPECT_NEAR(d.estimator.crab() - d.estimator.slide().east_m, 0.10, 0.015);
  EXPECT_LT(std::abs(d.yaw_error_deg()), 0.5);
  EXPECT_LT(d.position_error_m(), 0.03);
  EXPECT_EQ(d.estimator.health().rejected, 0u);
}

TEST(SideSlip, WithoutPositionsItGoesOnSlidingAsItDid) {
  Drive d = on_a_slope(0.10);
  leg_and_turn(d, 20.0);
  d.run(10.0);
  d.gnss = false;
  d.run(10.0);
  EXPECT_LT(d.position_error_m(), 0.30);  // 1 m if it forgot
}

TEST(SideSlip, OnAFirmFloorNoiseDoesNotMakeASlide) {
  Drive d = on_a_slope(0.0);
  for (int leg = 0; leg < 4; ++leg) {
    leg_and_turn(d, 15.0);
    EXPECT_LT(std::hypot(d.estimator.slide().east_m, d.estimator.slide().north_m), 0.02);
    EXPECT_LT(std::abs(d.estimator.crab()), 0.02);
  }
}

TEST(SideSlip, WhatIsAheadTakesTheSlideAlong) {
  Vehicle v;
  v.yaw_rad = base::kPi / 2.0;  // north
  v.slide = {0.1, 0.0};         // to the east: its right
  EXPECT_NEAR(course_off_rad(v, false), -std::atan(0.1), 1e-9);
  EXPECT_NEAR(course_off_rad(v, true), std::atan(0.1), 1e-9);  // its tail goes south: east is left
  v.slide = {0.0, 0.0};
  v.crab = 0.1;
  EXPECT_NEAR(course_off_rad(v, false), std::atan(0.1), 1e-9);
  EXPECT_NEAR(course_off_rad(v, true), std::atan(0.1), 1e-9);  // right of it is left of its tail
  v.slide = {0.0, 9.0};
  v.crab = 9.0;
  EXPECT_LE(std::abs(course_off_rad(v, false)), 0.5);
}

/// Drives a straight leg of 15 m to the north on a slope. @return the mean offset on its last
/// third, left positive.
double steady_offset_m(double crab, double slide_east, bool reverse) {
  std::vector<Vertex> ends;
  for (const double north_m : {0.0, 15.0}) {
    ends.push_back({{0.0, north_m}, 0.5, reverse, false, mission::Turn::Auto, 0.1});
  }
  PathParams params;
  params.track.delay_s = 0.0;
  const Path path = build_path(ends, params);
  Tracker tracker(params);
  Vehicle v;
  v.yaw_rad = reverse ? -base::kPi / 2.0 : base::kPi / 2.0;
  v.crab = crab;
  v.slide = {slide_east, 0.0};
  tracker.begin(path, 0, 0.0);
  double sum_m = 0.0;
  int n = 0;
  for (int i = 0; i < 4000 && tracker.phase() != TrackPhase::Done; ++i) {
    const base::BodyTwist t = tracker.step(v, 10.0, 0.02).command;
    const double c = std::cos(v.yaw_rad);
    const double s = std::sin(v.yaw_rad);
    const double way_m = t.linear_mps * 0.02;
    v.at.east_m += way_m * (c - crab * s) + std::abs(way_m) * slide_east;
    v.at.north_m += way_m * (s + crab * c);
    v.yaw_rad = base::wrap_rad(v.yaw_rad + t.angular_radps * 0.02);
    v.speed_mps = t.linear_mps;
    v.yaw_rate_radps = t.angular_radps;
    if (v.at.north_m < 10.0) continue;
    sum_m -= v.at.east_m;
    ++n;
  }
  return n > 0 ? sum_m / n : 99.0;
}

TEST(SideSlip, ThePathIsHeldForwardsAndBackwards) {
  for (const bool reverse : {false, true}) {
    EXPECT_NEAR(steady_offset_m(0.0, 0.10, reverse), 0.0, 0.003) << reverse;
    EXPECT_NEAR(steady_offset_m(0.10, 0.0, reverse), 0.0, 0.003) << reverse;
    EXPECT_NEAR(steady_offset_m(-0.05, 0.05, reverse), 0.0, 0.003) << reverse;
  }
}

}  // namespace
}  // namespace roverd::nav
