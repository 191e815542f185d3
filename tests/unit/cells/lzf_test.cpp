// LZF: what it says, and what is no LZF.

#include "nav/cells/lzf.hpp"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace roverd::nav::cells {
namespace {

using Blob = std::vector<std::uint8_t>;

std::string refusal(const Blob& packed, std::size_t size_bytes) {
  const auto out = unpack_lzf(packed, size_bytes);
  return out ? "" : out.error().fields.at(0).pointer + ": " + out.error().fields.at(0).detail;
}

TEST(Lzf, UnpacksLiteralsAndCopiesByHand) {
  // "abc" as literals; then copy 3 + 2 bytes from 3 back, which overlap what they write; then a
  // long copy: 7 + 1 + 2 bytes from 1 back.
  const Blob packed = {2, 'a', 'b', 'c', 3 << 5, 2, 7 << 5, 1, 0};
  const auto out = unpack_lzf(packed, 18);
  ASSERT_TRUE(out) << out.error().detail;
  EXPECT_EQ(std::string(out->begin(), out->end()), "abcabcabbbbbbbbbbb");
}

TEST(Lzf, RefusesWhatIsNone) {
  EXPECT_EQ(refusal({5, 'a'}, 6), "byte 0: ends within literals");
  EXPECT_EQ(refusal({0, 'a', 1 << 5}, 4), "byte 2: ends within a copy");
  EXPECT_EQ(refusal({0, 'a', 7 << 5, 3}, 13), "byte 2: ends within a copy");
  EXPECT_EQ(refusal({0, 'a', 1 << 5, 1}, 4), "byte 2: copies from before the beginning");
  EXPECT_EQ(refusal({0, 'a', 1 << 5, 0}, 3), "byte 2: more comes out than was said");
  EXPECT_EQ(refusal({0, 'a'}, 2), "byte 2: less comes out than was said");
  EXPECT_EQ(refusal({}, 4'000'000'000), "byte 0: 0 bytes cannot hold 4000000000");
  EXPECT_EQ(refusal({}, 0), "");
}

TEST(Lzf, GivesBackWhatItPacked) {
  std::mt19937 random(5);
  for (const unsigned letters : {1U, 3U, 256U}) {
    for (const std::size_t size :
         {std::size_t{1}, std::size_t{2}, std::size_t{300}, std::size_t{70'000}}) {
      Blob plain(size);
      for (auto& b : plain) b = static_cast<std::uint8_t>(random() % letters);
      const Blob packed = pack_lzf(plain);
      EXPECT_LE(packed.size(), plain.size() + plain.size() / 32 + 1);
      const auto again = unpack_lzf(packed, size);
      ASSERT_TRUE(again) << again.error().detail;
      EXPECT_EQ(*again, plain);
    }
  }
  EXPECT_LT(pack_lzf(Blob(70'000)).size(), 900U);  // 264 to 3
  EXPECT_TRUE(pack_lzf({}).empty());
}

}  // namespace
}  // namespace roverd::nav::cells
