// Packed or plain: the same bytes come out, however they are cut.

#include "atlas/unpack.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

using namespace roverd;

// printf 'roverd\n' | gzip -n9
const std::vector<std::uint8_t> kPacked = {0x1f, 0x8b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02,
                                           0x03, 0x2b, 0xca, 0x2f, 0x4b, 0x2d, 0x4a, 0xe1, 0x02,
                                           0x00, 0x2e, 0x4a, 0x62, 0xd3, 0x07, 0x00, 0x00, 0x00};

std::string unpacked(const std::vector<std::uint8_t>& file, std::size_t piece, bool& whole) {
  std::string out;
  atlas::Unpacker unpacker([&](base::Bytes b) { out.append(b.begin(), b.end()); });
  whole = true;
  for (std::size_t at = 0; at < file.size() && whole; at += piece) {
    const std::size_t size = std::min(piece, file.size() - at);
    whole = unpacker.feed(base::Bytes(file).subspan(at, size)).has_value();
  }
  whole = unpacker.finish().has_value() && whole;
  return out;
}

TEST(Unpacker, TakesPackedAndPlainBytes) {
  bool whole = false;
  for (const std::size_t piece : {1U, 5U, 100U}) {
    EXPECT_EQ(unpacked(kPacked, piece, whole), "roverd\n");
    EXPECT_TRUE(whole);
    EXPECT_EQ(unpacked({'p', 'l', 'a', 'i', 'n'}, piece, whole), "plain");
    EXPECT_TRUE(whole);
  }
  EXPECT_EQ(unpacked({'p'}, 1, whole), "p");
  auto twice = kPacked;
  twice.insert(twice.end(), kPacked.begin(), kPacked.end());
  EXPECT_EQ(unpacked(twice, 10, whole), "roverd\nroverd\n") << "members follow each other";
  EXPECT_TRUE(whole);
}

TEST(Unpacker, SaysWhereThePackingBreaks) {
  bool whole = true;
  auto cut = kPacked;
  cut.resize(20);
  unpacked(cut, 100, whole);
  EXPECT_FALSE(whole);
  auto broken = kPacked;
  broken[20] ^= 0x55U;  // the check sum
  unpacked(broken, 100, whole);
  EXPECT_FALSE(whole);
  auto junk = kPacked;
  junk.insert(junk.end(), {'j', 'u', 'n', 'k'});
  unpacked(junk, 100, whole);
  EXPECT_FALSE(whole);
}

}  // namespace
