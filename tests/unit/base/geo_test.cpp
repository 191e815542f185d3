#include "base/geo.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace roverd::base {
namespace {

TEST(LocalFrame, AgreesWithTheMeridianAndPrimeVerticalRadiiNearTheDatum) {
  // Oracle: north = (M+h) dlat, east = (N+h) dlon cos(lat0), M = 6366814.02, N = 6388648.38.
  const LocalFrame frame(1, {44.4928351, 11.3300422}, 113.227);
  const EnuPoint p = frame.to_local({44.4926007, 11.3301258});
  EXPECT_NEAR(p.north_m, -26.047, 0.001);
  EXPECT_NEAR(p.east_m, 6.650, 0.001);
}

TEST(LocalFrame, TheOriginIsZero) {
  const LocalFrame frame(1, {58.3, 26.7});
  EXPECT_NEAR(frame.to_local({58.3, 26.7}).east_m, 0.0, 1e-9);
  EXPECT_NEAR(frame.to_local({58.3, 26.7}).north_m, 0.0, 1e-9);
}

class RoundTrip : public testing::TestWithParam<LatLon> {};

TEST_P(RoundTrip, OfTenKilometresStaysBelowAMillimetre) {
  const LocalFrame frame(1, GetParam(), 200.0);
  for (double bearing_deg = 0; bearing_deg < 360; bearing_deg += 45) {
    const LatLon far = destination(GetParam(), bearing_deg, 10'000);
    const LatLon back = frame.to_global(frame.to_local(far));
    EXPECT_LT(distance_bearing(far, back).distance_m, 0.001) << bearing_deg;
  }
}

INSTANTIATE_TEST_SUITE_P(Earth, RoundTrip,
                         testing::Values(LatLon{0, 0}, LatLon{58.4, 26.7}, LatLon{-35.4, 149.2},
                                         LatLon{10, 180}, LatLon{10, -179.9999}, LatLon{89.9, 5},
                                         LatLon{-89.9, -120}));

TEST(DistanceBearing, CrossesTheDateLineTheShortWay) {
  const auto d = distance_bearing({0, 179.9999}, {0, -179.9999});
  EXPECT_NEAR(d.distance_m, 22.264, 0.001);
  EXPECT_NEAR(d.bearing_deg, 90.0, 1e-9);
}

TEST(DistanceBearing, OfEqualPointsIsZeroAndNorth) {
  const auto d = distance_bearing({50, 10}, {50, 10});
  EXPECT_EQ(d.distance_m, 0.0);
  EXPECT_EQ(d.bearing_deg, 0.0);
}

TEST(LatLonValidity, RefusesNanAndOutOfRange) {
  EXPECT_TRUE(is_valid({90, -180}));
  EXPECT_FALSE(is_valid({90.0000001, 0}));
  EXPECT_FALSE(is_valid({0, 180.1}));
  EXPECT_FALSE(is_valid({std::nan(""), 0}));
  EXPECT_FALSE(is_valid({0, INFINITY}));
}

}  // namespace
}  // namespace roverd::base
