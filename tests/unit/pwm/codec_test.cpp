#include "pwm/codec.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace roverd::pwm {
namespace {

constexpr Factors kFactors{1.5, 0.4};

TEST(Pwm, CentreStandsAndEndsAreFullSpeed) {
  EXPECT_EQ(to_twist({1500, 1500}, kFactors), (base::BodyTwist{0.0, 0.0}));
  EXPECT_EQ(to_twist({2100, 2100}, kFactors), (base::BodyTwist{1.5, 0.0}));
  EXPECT_EQ(to_twist({900, 900}, kFactors), (base::BodyTwist{-1.5, 0.0}));
  EXPECT_EQ(to_twist({900, 2100}, kFactors), (base::BodyTwist{0.0, 0.8}));  // counter-clockwise
}

TEST(Pwm, EveryPairOfPulsesComesBack) {
  for (int left = 900; left <= 2100; left += 7) {
    for (int right = 900; right <= 2100; right += 13) {
      const auto twist = to_twist({left, right}, kFactors);
      ASSERT_TRUE(twist);
      ASSERT_EQ(to_pulses(*twist, kFactors), (Pulses{left, right}));
    }
  }
}

TEST(Pwm, PulsesOutsideTheRangeSayNothing) {
  EXPECT_FALSE(to_twist({899, 1500}, kFactors));
  EXPECT_FALSE(to_twist({1500, 2101}, kFactors));
  EXPECT_FALSE(to_twist({0, 0}, kFactors));
}

TEST(Pwm, TooMuchIsShrunkAsAWholeAndNotANumberIsTheCentre) {
  const Pulses p = to_pulses({3.0, 1.6}, kFactors);
  EXPECT_EQ(p.right_us, 2100);
  const auto twist = to_twist(p, kFactors).value();
  EXPECT_NEAR(twist.angular_radps / twist.linear_mps, 1.6 / 3.0, 0.005);
  EXPECT_EQ(to_pulses({std::nan(""), 1.0}, kFactors), Pulses{});
}

}  // namespace
}  // namespace roverd::pwm
