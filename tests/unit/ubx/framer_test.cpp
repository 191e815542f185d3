#include "ubx/framer.hpp"

#include <string>

#include <gtest/gtest.h>

#include "frames.hpp"

namespace roverd::ubx {
namespace {

struct Cutter {
  void feed(Bytes bytes) {
    framer.feed(
        bytes, [this](const Frame& f) { keys.push_back(f.key); },
        [this](Bytes b) { other.append(b.begin(), b.end()); });
  }
  Framer framer;
  std::vector<Key> keys;
  std::string other;
};

std::vector<std::uint8_t> mixed() {
  auto all = from_hex(kAckAck);
  const std::string line = "$GPHDT,359.97,T*04\r\n";
  all.insert(all.end(), line.begin(), line.end());
  for (const auto hex : {kPvtFixed, kAckDamaged, kAckNak}) {
    const auto frame = from_hex(hex);
    all.insert(all.end(), frame.begin(), frame.end());
  }
  return all;
}

TEST(UbxFramer, CutsFramesOutOfOtherBytesHoweverTheyArrive) {
  for (const std::size_t piece : {1U, 2U, 7U, 1000U}) {
    Cutter c;
    const auto all = mixed();
    for (std::size_t at = 0; at < all.size(); at += piece) {
      c.feed(Bytes(all).subspan(at, std::min(piece, all.size() - at)));
    }
    EXPECT_EQ(c.keys, (std::vector<Key>{{5, 1}, {1, 7}, {5, 0}}));
    EXPECT_EQ(c.other.substr(0, 20), "$GPHDT,359.97,T*04\r\n");
    EXPECT_EQ(c.other.size(), 30U) << "the damaged frame is other bytes";
    EXPECT_EQ(c.framer.counts().bad_checksum, 1U);
    EXPECT_EQ(c.framer.counts().frames, 3U);
  }
}

TEST(UbxFramer, AWrongLengthHidesNoFrameBehindIt) {
  Cutter c;
  auto all = from_hex("b5620107ffff");  // 65535 bytes: too long to be true
  const auto good = from_hex(kAckAck);
  all.insert(all.end(), good.begin(), good.end());
  c.feed(all);
  EXPECT_EQ(c.keys, (std::vector<Key>{{5, 1}}));
  EXPECT_EQ(c.framer.counts().too_long, 1U);
}

TEST(UbxFramer, AFrameThatNeverEndsIsGivenUp) {
  Cutter c;
  auto all = from_hex("b56201070010");  // 4096 bytes announced
  const auto good = from_hex(kAckAck);
  all.insert(all.end(), good.begin(), good.end());
  c.feed(all);
  EXPECT_TRUE(c.keys.empty());
  c.framer.give_up([&](const Frame& f) { c.keys.push_back(f.key); }, [](Bytes) {});
  EXPECT_EQ(c.keys, (std::vector<Key>{{5, 1}}));
}

TEST(UbxFramer, EncodesWhatItReads) {
  EXPECT_EQ(encode({0x0A, 0x04}, {}), from_hex(kMonVerPoll));
  const auto frame = from_hex(kPvtFixed);
  ASSERT_TRUE(is_intact(frame));
  const Frame f = opened(frame);
  EXPECT_EQ(encode(f.key, f.payload), frame);
  EXPECT_FALSE(is_intact(from_hex(kAckDamaged)));
  EXPECT_FALSE(is_intact(Bytes(frame).first(7)));
}

}  // namespace
}  // namespace roverd::ubx
