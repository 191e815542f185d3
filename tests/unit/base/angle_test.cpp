#include "base/angle.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace roverd::base {
namespace {

//   N   heading 0, yaw +π/2
//   └─ E  heading 90, yaw 0
TEST(Angle, HeadingsOfTheCompassPointsBecomeYaw) {
  EXPECT_DOUBLE_EQ(yaw_from_heading(0), kPi / 2);
  EXPECT_DOUBLE_EQ(yaw_from_heading(90), 0);
  EXPECT_DOUBLE_EQ(yaw_from_heading(180), -kPi / 2);
  EXPECT_DOUBLE_EQ(yaw_from_heading(270), kPi);
}

TEST(Angle, YawBecomesAHeadingBelow360) {
  EXPECT_DOUBLE_EQ(heading_from_yaw(kPi / 2), 0);
  EXPECT_DOUBLE_EQ(heading_from_yaw(0), 90);
  EXPECT_DOUBLE_EQ(heading_from_yaw(kPi), 270);
  EXPECT_LT(heading_from_yaw(std::nextafter(kPi / 2, 4.0)), 360.0);
  EXPECT_GE(heading_from_yaw(kPi / 2 + 1e-17), 0.0);
}

TEST(Angle, RoundTripKeepsEveryDegree) {
  for (int deg = 0; deg < 360; ++deg) {
    EXPECT_NEAR(heading_from_yaw(yaw_from_heading(deg)), deg, 1e-12) << deg;
  }
}

TEST(Angle, AHalfTurnIsPlusPiFromBothSides) {
  EXPECT_DOUBLE_EQ(wrap_rad(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_rad(-kPi), kPi);
  EXPECT_DOUBLE_EQ(angle_diff_rad(0.0, kPi), kPi);
  EXPECT_DOUBLE_EQ(angle_diff_rad(kPi, 0.0), kPi);
}

TEST(Angle, DifferencesTakeTheShortWayAcrossTheSeam) {
  EXPECT_NEAR(angle_diff_rad(yaw_from_heading(350), yaw_from_heading(10)), -rad_from_deg(20),
              1e-12);
  EXPECT_NEAR(angle_diff_rad(3.1, -3.1), 2 * kPi - 6.2, 1e-12);
}

TEST(Angle, NanStaysNan) {
  EXPECT_TRUE(std::isnan(wrap_rad(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(wrap_rad(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace roverd::base
