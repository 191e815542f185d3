#include "bunker/odometry.hpp"

#include <gtest/gtest.h>

namespace roverd::bunker {
namespace {

using namespace std::chrono_literals;
using base::Time;

class OdometryTest : public ::testing::Test {
 protected:
  /// The next reading, 20 ms after the one before.
  std::optional<Odometry::Travel> read(std::int32_t left_mm, std::int32_t right_mm) {
    now += 20ms;
    return odometry.add({left_mm, right_mm}, now);
  }
  Odometry odometry{4.0};
  Time now{};
};

TEST_F(OdometryTest, TheFirstReadingIsNoTravel) {
  EXPECT_FALSE(read(5'000'000, -5'000'000));
  EXPECT_EQ(odometry.refused(), 0u);
}

TEST_F(OdometryTest, ReadingsBecomeIncrementsInMetres) {
  read(1000, 2000);
  const auto t = read(1030, 1985);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->left_m, 0.030);
  EXPECT_DOUBLE_EQ(t->right_m, -0.015);
}

TEST_F(OdometryTest, IncrementsGoOverTheWrapAround) {
  EXPECT_EQ(odometer_step_mm(2147483647, -2147483647 - 1), 1);
  EXPECT_EQ(odometer_step_mm(-2147483647 - 1, 2147483647), -1);
  read(2147483640, -2147483640);
  const auto t = read(-2147483646, 2147483646);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->left_m, 0.010);
  EXPECT_DOUBLE_EQ(t->right_m, -0.010);
}

TEST_F(OdometryTest, OneWildReadingIsRefusedAndCostsNoWay) {
  // 1000 ─▶ 1020 ─▶ 900000 ─▶ 1060
  read(1000, 1000);
  read(1020, 1020);
  EXPECT_FALSE(read(900'000, 1040));
  EXPECT_EQ(odometry.refused(), 1u);
  const auto t = read(1060, 1060);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->left_m, 0.040) << "two frames' way";
}

TEST_F(OdometryTest, AfterARestartOfTheBaseCountingGoesOn) {
  // 50 m ─▶ 0 ─▶ 0.02 ─▶ 0.04
  read(50'000, 50'000);
  EXPECT_FALSE(read(0, 0));
  EXPECT_FALSE(read(20, 20)) << "agrees with the far place: from here on";
  const auto t = read(40, 40);
  ASSERT_TRUE(t);
  EXPECT_DOUBLE_EQ(t->left_m, 0.020);
  EXPECT_EQ(odometry.refused(), 2u);
}

TEST_F(OdometryTest, ALongerGapAllowsALongerStep) {
  read(0, 0);
  now += 1s;
  EXPECT_TRUE(read(4000, 4000));
  EXPECT_FALSE(read(8000, 8000));
}

TEST_F(OdometryTest, AfterForgettingTheNextReadingIsAFirstOne) {
  read(0, 0);
  odometry.forget();
  EXPECT_FALSE(read(10, 10));
  EXPECT_TRUE(read(20, 20));
}

}  // namespace
}  // namespace roverd::bunker
