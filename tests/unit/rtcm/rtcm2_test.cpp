// RTCM 2 is told from everything else that a caster may send.

#include "rtcm/rtcm2.hpp"

#include <random>

#include <gtest/gtest.h>

#include "unit/rtcm/rtcm2.hpp"

namespace roverd::rtcm {
namespace {

base::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool heard(const std::string& text) {
  Rtcm2Ear ear;
  ear.feed(bytes_of(text));
  return ear.sure();
}

TEST(Rtcm2, AGpsWordOfTheInterfaceSpecificationHasRightParity) {
  // A telemetry word as it is sent: preamble 8B, message 0, after a word that ended in 0 0.
  // D25..D30 of data 0x8B0000, by hand: d1 d5 d7 d8 are set.
  //   D25 d1^d5 = 0   D26 d7 = 1   D27 d1^d5^d7^d8 = 0   D28 d5^d8 = 0   D29 d1^d5^d7 = 1   D30
  //   d5^d8 = 0
  const std::uint32_t word = 0x8B0000U << 6U | 0b010010U;
  EXPECT_TRUE(rtcm2_parity_is_right(word));
  for (int bit = 0; bit < 32; ++bit) {
    EXPECT_FALSE(rtcm2_parity_is_right(word ^ 1U << bit)) << bit;  // each bit counts
  }
}

TEST(Rtcm2, AStationsMessagesAreHeardFromAnyBitOn) {
  Rtcm2Writer station;
  for (int i = 0; i < 3; ++i) {
    station.message(1, 723, {0x123456, 0xFFFFFF, 0x000000, 0xABCDEF, 0x800001});
    station.message(3, 723, {0x111111, 0x222222, 0x333333, 0x444444});
  }
  for (std::size_t begin = 0; begin < 60; ++begin)
    EXPECT_TRUE(heard(station.bytes(begin))) << begin;
}

TEST(Rtcm2, LineEndsAndOtherBytesBetweenAreNoPartOfIt) {
  Rtcm2Writer station;
  station.message(1, 1, {1, 2, 3, 4, 5, 6});
  std::string text;
  for (const char c : station.bytes()) {
    text += c;
    text += "\r\n";
  }
  EXPECT_TRUE(heard(text));
}

TEST(Rtcm2, ItIsSureOnlyAfterSixWords) {
  Rtcm2Writer five;
  five.message(1, 1, {1, 2, 3});
  EXPECT_FALSE(heard(five.bytes()));
  Rtcm2Writer six;
  six.message(1, 1, {1, 2, 3, 4});
  EXPECT_TRUE(heard(six.bytes()));
  // and one wrong bit in the fourth begins anew
  std::string damaged = six.bytes();
  damaged[17] = static_cast<char>(damaged[17] ^ 4);
  EXPECT_FALSE(heard(damaged));
}

TEST(Rtcm2, NothingElseIsTakenForIt) {
  std::mt19937 random(7);
  std::string noise(4'000'000, 0);
  for (char& c : noise) c = static_cast<char>(random());
  EXPECT_FALSE(heard(noise));
  std::string text;
  while (text.size() < 100'000)
    text += "STR;TEST0;Tartu;RTCM 2.3;1(1),3(10);fffffffffffffffffff\r\n";
  EXPECT_FALSE(heard(text));
  EXPECT_FALSE(heard(std::string(100'000, '\x40')));
  EXPECT_FALSE(heard(std::string(100'000, '\x7F')));
  EXPECT_FALSE(heard(""));
}

}  // namespace
}  // namespace roverd::rtcm
