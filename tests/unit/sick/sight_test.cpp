// From a scan to what was seen: angles, ranges, times, codes.
//
//        x (90° of an LMS)
//        |
//   y ───o

#include "sick/sight.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "unit/sick/words.hpp"

namespace roverd::sick {
namespace {

using base::Echo;

Scan scan_of(std::vector<std::uint16_t> values, std::int32_t start_e4deg = 900'000,
             std::uint16_t step_e4deg = 5000) {
  Scan s = lms111(1, 0);
  s.channels = {{"DIST1", 16, 1.0F, 0.0F, start_e4deg, step_e4deg, std::move(values)}};
  return s;
}
base::Sight see(const Scan& s, const SightRules& rules = {}) {
  auto sight = to_sight(s, rules);
  EXPECT_TRUE(sight) << (sight ? "" : sight.error().detail);
  return sight ? *sight : base::Sight{};
}
std::string sight_refusal(const Scan& s) {
  const auto sight = to_sight(s, {});
  return sight ? "believed" : sight.error().detail;
}

TEST(SickSight, NinetyDegreesIsAheadAndAnglesGrowToTheLeft) {
  const auto s = see(scan_of({1000, 1000, 1000}, 0, 45'000));
  ASSERT_EQ(s.points.size(), 3u);
  EXPECT_NEAR(s.points[0].x_m, 0.0, 1e-6);  // 0° of the scanner: to the right
  EXPECT_NEAR(s.points[0].y_m, -1.0, 1e-6);
  EXPECT_NEAR(s.points[1].x_m, std::sin(4.5 * std::acos(-1.0) / 180.0), 1e-6);
  const auto ahead = see(scan_of({3000}, 900'000));
  EXPECT_NEAR(ahead.points[0].x_m, 3.0, 1e-6);
  EXPECT_NEAR(ahead.points[0].y_m, 0.0, 1e-6);
  const auto left = see(scan_of({3000}, 1'800'000));
  EXPECT_NEAR(left.points[0].y_m, 3.0, 1e-6);
  const auto other_zero = see(scan_of({3000}, 0), {.ahead_deg = 0.0});
  EXPECT_NEAR(other_zero.points[0].x_m, 3.0, 1e-6);
}

TEST(SickSight, CodesAreNoRanges) {
  const auto s = see(scan_of({0, 1, 3, 15, 16}), {.clear_to_m = 12.5});
  ASSERT_EQ(s.points.size(), 5u);
  EXPECT_EQ(s.points[0].echo, Echo::Clear);
  EXPECT_NEAR(std::hypot(s.points[0].x_m, s.points[0].y_m), 12.5, 1e-5);
  EXPECT_EQ(s.clear_to_m, 12.5F);
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
    EXPECT_EQ(s.points[i].echo, Echo::Unknown);
    EXPECT_NEAR(std::hypot(s.points[i].x_m, s.points[i].y_m), 1.0, 1e-6);
  }
  EXPECT_EQ(s.points[4].echo, Echo::Hit);
  EXPECT_NEAR(s.points[4].x_m, 0.016, 1e-5);
  EXPECT_NEAR(missing_share(s), 0.8, 1e-9);
}

TEST(SickSight, WithoutARangeToVouchForAMissingEchoIsUnknown) {
  EXPECT_EQ(see(scan_of({0}), {.clear_to_m = 0.0}).points[0].echo, Echo::Unknown);
}

TEST(SickSight, ScaleAndOffsetMakeTheRange) {
  const auto full = see(*decode_a(kFullScan));
  ASSERT_EQ(full.points.size(), 4u);
  EXPECT_NEAR(std::hypot(full.points[3].x_m, full.points[3].y_m), 4.006, 1e-5);
  EXPECT_EQ(full.points[3].intensity, 65535);
  EXPECT_EQ(full.points[0].intensity, 120);
  Scan s = scan_of({5000});
  s.channels[0].scale = 0.1F;
  s.channels[0].offset = 20.0F;
  EXPECT_NEAR(see(s).points[0].x_m, 0.52, 1e-5);
  s.channels[0].offset = -1000.0F;  // before the window: nothing is known
  EXPECT_EQ(see(s).points[0].echo, Echo::Unknown);
}

TEST(SickSight, EachBeamHasItsTime) {
  const auto s = see(lms111(1, 0));
  ASSERT_EQ(s.points.size(), 541u);
  EXPECT_EQ(s.points[0].after_s, 0.0F);
  EXPECT_NEAR(s.points[540].after_s, 0.015, 1e-7);  // 270° of a turn of 20 ms
  EXPECT_NEAR(s.half_step_rad, 0.25 * std::acos(-1.0) / 180.0, 1e-7);
  EXPECT_NEAR(duration_s(*beams_of(lms111(1, 0))), 0.015, 1e-9);
}

TEST(SickSight, FurtherEchoesAreFurtherHits) {
  Scan s = scan_of({1000, 0, 2000, 0, 3});
  Channel second = s.channels[0];
  second.name = "DIST2";
  second.values = {5000, 6000, 2000, 0, 0};
  s.channels.push_back(second);
  const auto seen = see(s);
  ASSERT_EQ(seen.points.size(), 6u);
  EXPECT_NEAR(seen.points[0].x_m, 1.0, 1e-5);
  EXPECT_NEAR(seen.points[1].x_m, 5.0, 1e-5);
  EXPECT_EQ(seen.points[0].after_s, seen.points[1].after_s);
  EXPECT_EQ(seen.points[2].echo, Echo::Hit);  // only the second echo: not clear
  EXPECT_EQ(seen.points[3].echo, Echo::Hit);  // twice the same: one
  EXPECT_EQ(seen.points[4].echo, Echo::Clear);
  EXPECT_EQ(seen.points[5].echo, Echo::Unknown);
}

TEST(SickSight, TheWindowAndTheStateAreTold) {
  Scan s = scan_of({1000});
  EXPECT_EQ(see(s).window, base::Window::Clean);
  s.status = {0, 2};
  EXPECT_EQ(see(s).window, base::Window::Dirty);
  EXPECT_TRUE(see(s).good);
  s.status = {0, 5};
  EXPECT_EQ(see(s).window, base::Window::Blocked);
  s.status = {1, 0};
  EXPECT_FALSE(see(s).good);
}

TEST(SickSight, WhatCannotBeIsRefused) {
  EXPECT_EQ(sight_refusal(scan_of({})), "scan without distances");
  Scan s = scan_of({1, 2});
  s.channels[0].name = "RSSI1";
  EXPECT_EQ(sight_refusal(s), "scan without distances");
  EXPECT_EQ(sight_refusal(scan_of({1, 2}, 0, 0)), "scan without an angle step");
  EXPECT_EQ(sight_refusal(scan_of({1, 2}, 2'000'000'000)), "scan with an impossible start angle");
  EXPECT_EQ(sight_refusal(scan_of(std::vector<std::uint16_t>(722, 1000))),
            "scan over more than a full turn");
  s = scan_of({1000, 1000});
  s.scan_frequency_chz = 0;
  EXPECT_EQ(sight_refusal(s), "scan with an impossible frequency");
}

}  // namespace
}  // namespace roverd::sick
