// What a receiver's fix is worth: its class, its own sigmas, its geometry.

#include "nav/estimate/gnss_quality.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

using base::Refusal;

constexpr base::LatLon kSomewhere{58.378, 26.729};

base::GnssFix fix_of(base::FixType type) {
  base::GnssFix fix;
  fix.fix = type;
  fix.position = kSomewhere;
  return fix;
}

TEST(GnssQuality, TakesTheFloorOfTheClassUnlessTheReceiverClaimsLess) {
  base::GnssFix fix = fix_of(base::FixType::RtkFixed);
  fix.sigma_east_m = 0.001;
  fix.sigma_north_m = 0.08;
  const auto q = gnss_quality(fix, true, {});
  ASSERT_TRUE(q);
  EXPECT_DOUBLE_EQ(q->sigma_east_m, 1.5 * 0.015);
  EXPECT_DOUBLE_EQ(q->sigma_north_m, 1.5 * 0.08);
  EXPECT_DOUBLE_EQ(q->drift.sigma_m, 0.0);
  EXPECT_GT(gnss_quality(fix, false, {})->sigma_east_m, 0.05);
}

TEST(GnssQuality, MostOfTheErrorOfAReceiverWithoutRtkIsSlow) {
  base::GnssFix fix = fix_of(base::FixType::Single);
  fix.sigma_east_m = fix.sigma_north_m = 0.8;
  const auto q = gnss_quality(fix, true, {});
  EXPECT_NEAR(q->drift.sigma_m, 0.8, 0.03);
  EXPECT_DOUBLE_EQ(q->sigma_east_m, 0.2);
  fix.sigma_east_m = fix.sigma_north_m = 0.01;  // no single fix is so good
  EXPECT_DOUBLE_EQ(gnss_quality(fix, true, {})->drift.sigma_m, 0.5 * 0.968);
}

TEST(GnssQuality, ScalesByHdopWhereTheReceiverTellsNoMore) {
  base::GnssFix fix = fix_of(base::FixType::Single);
  fix.hdop = 2.0;
  EXPECT_DOUBLE_EQ(gnss_quality(fix, true, {})->drift.sigma_m, 2.4 * 0.968);
  fix.sigma_east_m = fix.sigma_north_m = 0.8;
  EXPECT_DOUBLE_EQ(gnss_quality(fix, true, {})->drift.sigma_m, 0.8 * 0.968);
}

TEST(GnssQuality, WhatIsNoFixIsNotUsedAndNotCounted) {
  for (const auto type : {base::FixType::None, base::FixType::Unknown, base::FixType::Estimated}) {
    const auto q = gnss_quality(fix_of(type), true, {});
    ASSERT_FALSE(q);
    EXPECT_FALSE(q.error());
  }
  base::GnssFix fix = fix_of(base::FixType::Single);
  fix.position.reset();
  EXPECT_FALSE(gnss_quality(fix, true, {}));
}

TEST(GnssQuality, NamesWhyAFixIsRefused) {
  const auto why = [](auto change) {
    base::GnssFix fix = fix_of(base::FixType::RtkFixed);
    change(fix);
    const auto q = gnss_quality(fix, true, {});
    return q ? std::nullopt : q.error();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(why([](auto&) {}), std::nullopt);
  EXPECT_EQ(why([](auto& f) { f.satellites = 6; }), std::nullopt);
  EXPECT_EQ(why([](auto& f) { f.satellites = 5; }), Refusal::Satellites);
  EXPECT_EQ(why([](auto& f) { f.hdop = 2.6; }), Refusal::Dilution);
  EXPECT_EQ(why([&](auto& f) { f.hdop = nan; }), Refusal::Dilution);
  EXPECT_EQ(why([](auto& f) { f.sigma_north_m = 3.1; }), Refusal::Accuracy);
  EXPECT_EQ(why([](auto& f) { f.position = base::LatLon{0.0, 0.0}; }), Refusal::Zero);
  EXPECT_EQ(why([](auto& f) { f.position = base::LatLon{91.0, 0.0}; }), Refusal::Impossible);
  EXPECT_EQ(why([&](auto& f) { f.position = base::LatLon{nan, 0.0}; }), Refusal::NotFinite);
}

}  // namespace
}  // namespace roverd::nav
