#include "rtcm/framer.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../ntrip/bytes.hpp"
#include "rtcm/crc24q.hpp"

namespace roverd::rtcm {
namespace {

using ntrip::bytes_from;
using ntrip::from_hex;

class RtcmFramerTest : public ::testing::Test {
 protected:
  void hear(const std::string& text, std::size_t piece = 1000) {
    const auto all = bytes_from(text);
    for (std::size_t at = 0; at < all.size(); at += piece) {
      framer.feed(Bytes(all).subspan(at, std::min(piece, all.size() - at)), sink);
    }
  }
  std::vector<int> numbers;
  std::vector<std::string> frames;
  std::function<void(const Frame&)> sink = [this](const Frame& f) {
    numbers.push_back(f.number);
    frames.emplace_back(f.bytes.begin(), f.bytes.end());
  };
  Framer framer;
};

TEST(Crc24q, GivesTheCheckValue) {
  EXPECT_EQ(crc24q(bytes_from("123456789")), 0xCDE703u);
}

TEST_F(RtcmFramerTest, FramesComeOutUnchangedHoweverTheyAreCut) {
  for (const std::size_t piece : {1u, 7u, 1000u}) {
    numbers.clear();
    frames.clear();
    hear(ntrip::k1005 + from_hex("d3000047ea4b") + ntrip::k1006, piece);
    EXPECT_EQ(numbers, (std::vector<int>{1005, 0, 1006})) << piece;
    EXPECT_EQ(frames.at(0), ntrip::k1005);
    EXPECT_EQ(frames.at(2), ntrip::k1006);
  }
  EXPECT_EQ(framer.counts().bad_crc, 0u);
}

TEST_F(RtcmFramerTest, AWrongChecksumIsNoFrame) {
  std::string damaged = ntrip::k1005;
  damaged.back() = '\x50';
  hear(damaged + ntrip::k1006);
  framer.give_up(sink);  // inside it a D3 stands like the beginning of a long frame
  EXPECT_EQ(numbers, (std::vector<int>{1006}));
  EXPECT_EQ(framer.counts().bad_crc, 1u);
}

TEST_F(RtcmFramerTest, AFalseBeginningIsPassed) {
  hear("\xD3\xFF" + ntrip::k1005);
  EXPECT_EQ(numbers, (std::vector<int>{1005}));
  EXPECT_EQ(framer.counts().other_bytes, 2u);
}

TEST_F(RtcmFramerTest, AFalseLengthHoldsFramesBackUntilItIsGivenUp) {
  hear(std::string("\xD3\x03\xFF", 3) + ntrip::k1005);
  EXPECT_TRUE(numbers.empty());
  EXPECT_TRUE(framer.waiting());
  framer.give_up(sink);
  EXPECT_EQ(numbers, (std::vector<int>{1005}));
  EXPECT_FALSE(framer.waiting());
}

}  // namespace
}  // namespace roverd::rtcm
