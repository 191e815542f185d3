// What a receiver's fix is worth: its class, its own sigmas, its geometry.

#include "nav/estimate/gnss_quality.hpp"

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

constexpr base::LatLon kSomewhere{58.378, 26.729};

TEST(GnssQuality, TakesTheFloorOfTheClassUnlessTheReceiverClaimsLess) {
  base::GnssFix fix;
  fix.fix = base::FixType::RtkFixed;
  fix.position = kSomewhere;
  fix.sigma_east_m = 0.001;
  fix.sigma_north_m = 0.08;
  const auto q = gnss_quality(fix, true, 1.0);
  ASSERT_TRUE(q);
  EXPECT_DOUBLE_EQ(q->sigma_east_m, 0.015);
  EXPECT_DOUBLE_EQ(q->sigma_north_m, 0.08);
  EXPECT_DOUBLE_EQ(q->drift.sigma_m, 0.0);
  EXPECT_GT(gnss_quality(fix, false, 1.0)->sigma_east_m, 0.05);
}

TEST(GnssQuality, ScalesByHdopAndRefusesWhatIsNoFix) {
  base::GnssFix fix;
  fix.fix = base::FixType::Single;
  fix.position = kSomewhere;
  fix.hdop = 3.0;
  EXPECT_DOUBLE_EQ(gnss_quality(fix, true, 1.0)->sigma_east_m, 3.0);
  EXPECT_GT(gnss_quality(fix, true, 1.0)->drift.sigma_m, 0.5);
  fix.fix = base::FixType::Estimated;
  EXPECT_FALSE(gnss_quality(fix, true, 1.0));
  fix.fix = base::FixType::Single;
  fix.position.reset();
  EXPECT_FALSE(gnss_quality(fix, true, 1.0));
}

}  // namespace
}  // namespace roverd::nav
