#include "ackermann/codec.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "ackermann/zero.hpp"

namespace roverd::ackermann {
namespace {

TEST(AckermannCodec, TheExampleOfTheFactSheetIsMetByteForByte) {
  const auto bytes = encode({1.23F, 0.2571F, DriveMode::Autonomous});
  const std::array<std::uint8_t, 12> expected{0x10, 0x3F, 0x9D, 0x70, 0xA4, 0x20,
                                              0x3E, 0x83, 0xA2, 0x9C, 0x30, 0x02};
  EXPECT_EQ(bytes, expected);
  const Decoded back = decode(expected);
  EXPECT_EQ(back.fault, Fault::None);
  EXPECT_EQ(back.message, (Message{1.23F, 0.2571F, DriveMode::Autonomous}));
}

TEST(AckermannCodec, WrongLengthMarkModeAndNumberAreRefused) {
  const auto good = encode({1.0F, 0.1F, DriveMode::Park});
  EXPECT_EQ(decode(base::Bytes(good).first(11)).fault, Fault::WrongLength);
  EXPECT_EQ(decode(std::vector<std::uint8_t>(13)).fault, Fault::WrongLength);
  EXPECT_EQ(decode({}).fault, Fault::WrongLength);
  for (const std::size_t at : {0U, 5U, 10U}) {
    auto bad = good;
    bad[at] ^= 1U;
    EXPECT_EQ(decode(bad).fault, Fault::WrongMark);
  }
  for (const int mode : {0, 4, 255}) {
    auto bad = good;
    bad[11] = static_cast<std::uint8_t>(mode);
    EXPECT_EQ(decode(bad).fault, Fault::WrongMode);
  }
  EXPECT_EQ(decode(encode({std::numeric_limits<float>::quiet_NaN(), 0.0F, DriveMode::Park})).fault,
            Fault::NotFinite);
  EXPECT_EQ(decode(encode({0.0F, std::numeric_limits<float>::infinity(), DriveMode::Park})).fault,
            Fault::NotFinite);
}

TEST(AckermannCodec, TwistAndWheelAngleAreEachOthersInverse) {
  const base::BodyTwist left{1.0, 0.4};
  const double wheel_rad = wheel_from_twist(left, 1.3).value();
  EXPECT_NEAR(wheel_rad, std::atan(0.52), 1e-12);
  EXPECT_NEAR(twist_from_wheel(1.0, wheel_rad, 1.3).angular_radps, 0.4, 1e-12);
  // Backwards the same turn rate wants the wheel on the other side.
  EXPECT_NEAR(wheel_from_twist({-1.0, 0.4}, 1.3).value(), -std::atan(0.52), 1e-12);
  EXPECT_FALSE(wheel_from_twist({0.0, 0.4}, 1.3));
}

TEST(SteeringZero, IsLearnedWhileDrivingStraightAndOnlyThen) {
  SteeringZero zero(0.1);
  for (int i = 0; i < 500; ++i) zero.add(0.1, 0.0, -0.03, 0.02);  // too slow
  EXPECT_EQ(zero.zero_rad(), 0.0);
  for (int i = 0; i < 500; ++i) zero.add(1.0, 0.3, 0.27, 0.02);  // in a bend
  EXPECT_EQ(zero.zero_rad(), 0.0);
  // The wheel stands 0.03 rad right of what it is told.
  for (int i = 0; i < 1500; ++i) zero.add(1.0, 0.0, zero.zero_rad() - 0.03, 0.02);
  EXPECT_NEAR(zero.zero_rad(), 0.03, 1e-3);
}

/// A motor that stands 0.02 rad right of what it is told, and 0.01 more in a left bend.
double stands_rad(double sent_rad) {
  return sent_rad - 0.02 - (sent_rad > 0.2 ? 0.01 : 0.0);
}

void drives(SteeringZero& zero, double wheel_rad, double seconds) {
  for (double t = 0.0; t < seconds; t += 0.02) {
    zero.add(1.0, wheel_rad, stands_rad(wheel_rad + zero.at_rad(wheel_rad)), 0.02);
  }
}

TEST(SteeringZero, InABendTheWheelIsBroughtToWhereItShallStandAndTheStraightIsLeftAlone) {
  SteeringZero zero(0.1);
  drives(zero, 0.4, 10.0);
  EXPECT_NEAR(stands_rad(0.4 + zero.at_rad(0.4)), 0.4, 1e-3);
  EXPECT_EQ(zero.at_rad(0.0), 0.0);
  EXPECT_EQ(zero.at_rad(-0.4), 0.0);  // the other side may be another
  drives(zero, -0.3, 10.0);
  drives(zero, 0.0, 20.0);
  EXPECT_NEAR(zero.zero_rad(), 0.02, 1e-3);
  drives(zero, 0.4, 10.0);
  drives(zero, -0.3, 10.0);
  EXPECT_NEAR(stands_rad(0.4 + zero.at_rad(0.4)), 0.4, 1e-3);
  EXPECT_NEAR(stands_rad(-0.3 + zero.at_rad(-0.3)), -0.3, 1e-3);
  EXPECT_NEAR(zero.at_rad(0.0), 0.02, 1e-3);
  EXPECT_LE(std::abs(zero.at_rad(0.4)), 0.1);
}

TEST(SteeringZero, OfABendAndOfTheStraightTogetherAreNoMoreThanAllowed) {
  SteeringZero zero(0.05);
  for (int i = 0; i < 2000; ++i) zero.add(1.0, 0.4, 0.0, 0.02);  // a left bend, far behind
  EXPECT_DOUBLE_EQ(zero.at_rad(0.4), 0.05);
  for (int i = 0; i < 5000; ++i) zero.add(1.0, 0.0, -0.5, 0.02);
  EXPECT_DOUBLE_EQ(zero.zero_rad(), 0.05);
  EXPECT_DOUBLE_EQ(zero.at_rad(0.4), 0.05);
}

TEST(SteeringZero, IsLearnedThoughTheCommandTremblesWithEveryPosition) {
  SteeringZero zero(0.1);
  double wheel_rad = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double told_rad = (i / 10 % 2 == 0 ? 0.01 : -0.01);  // another one five times a second
    wheel_rad += (told_rad + zero.zero_rad() - 0.02 - wheel_rad) * 0.02 / 0.2;
    zero.add(2.0, told_rad, wheel_rad, 0.02);
  }
  EXPECT_NEAR(zero.zero_rad(), 0.02, 2e-3);
}

TEST(SteeringZero, IsNeverLargerThanAllowed) {
  SteeringZero zero(0.05);
  for (int i = 0; i < 5000; ++i) zero.add(1.0, 0.0, -0.5, 0.02);
  EXPECT_DOUBLE_EQ(zero.zero_rad(), 0.05);
}

}  // namespace
}  // namespace roverd::ackermann
