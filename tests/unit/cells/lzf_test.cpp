// LZF: what it says, and what is no LZF.

#include "nav/cells/lzf.hpp"

#include <algorithm>
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

TEST(Lzf, ComesOutInPiecesAsAtOnceAlsoFromTwoThatWerePackedApart) {
  // Given two blocks, of which copies reach far back, one behind the other,
  std::mt19937 random(7);
  Blob plain(60'000);
  for (auto& b : plain) b = static_cast<std::uint8_t>(random() % 3);
  const base::Bytes all(plain);
  Blob packed = pack_lzf(all.first(25'001));
  const Blob second = pack_lzf(all.subspan(25'001));
  packed.insert(packed.end(), second.begin(), second.end());
  // when they are read in pieces of all sizes, one of them passed over,
  LzfStream stream(packed);
  Blob out(plain.size());
  std::size_t at = 0;
  for (std::size_t piece = 1; at < plain.size(); piece = piece * 3 % 20'011) {
    const std::size_t size = std::min(piece, plain.size() - at);
    const bool over = piece == 27;
    ASSERT_TRUE(stream.read(over ? nullptr : out.data() + at, size));
    if (over)
      std::copy_n(plain.begin() + static_cast<long>(at), size, out.begin() + static_cast<long>(at));
    at += size;
  }
  // then it is what was packed, and no more.
  EXPECT_EQ(out, plain);
  EXPECT_TRUE(stream.ended());
  EXPECT_FALSE(stream.read(nullptr, 1));
  EXPECT_EQ(*unpack_lzf(packed, plain.size()), plain);
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
