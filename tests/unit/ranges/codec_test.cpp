// What modules write, and what is not believed.

#include "ranges/codec.hpp"

#include <string>

#include <gtest/gtest.h>

namespace roverd::ranges {
namespace {

/// "1.200 - ?": a range, nothing seen, refused; or the fault.
std::string said(std::string_view line, double unit_m = 1.0) {
  const Line parsed = parse(line, unit_m);
  if (parsed.fault != nullptr) return parsed.fault;
  std::string out;
  for (const Reading& r : parsed.readings) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", r.range_m);
    out += out.empty() ? "" : " ";
    out += r.outcome == Outcome::Range ? text : r.outcome == Outcome::Nothing ? "-" : "?";
  }
  return out;
}

TEST(RangesCodec, ModulesWriteInManyWays) {
  EXPECT_EQ(said("1.234"), "1.234");
  EXPECT_EQ(said("R1234", 0.001), "1.234");
  EXPECT_EQ(said("R 1.20 0.85 - 2.00*6D"), "1.200 0.850 - 2.000");
  EXPECT_EQ(said("$SONAR,120,85,oor,200*3F", 0.01), "1.200 0.850 - 2.000");
  EXPECT_EQ(said("Distance: 123 cm"), "1.230");
  EXPECT_EQ(said("Distance: 123 cm", 0.001), "1.230") << "what the line says itself counts";
  EXPECT_EQ(said("d=1.20;e=500mm | 40in"), "1.200 0.500 1.016");
  EXPECT_EQ(said("S1:1.20 S2:0.30"), "1.200 0.300");
  EXPECT_EQ(said("[1, 2,\t3]"), "1.000 2.000 3.000");
  EXPECT_EQ(said("+.5 5e-1"), "0.500 0.500");
  EXPECT_EQ(said("<0.02"), "0.020");
}

TEST(RangesCodec, NothingSeenHasManyNames) {
  EXPECT_EQ(said("- -- OOR none far MAX timeout >4.00"), "- - - - - - - -");
  EXPECT_EQ(said("Out of range"), "-");
  EXPECT_EQ(said("No echo"), "-");
  EXPECT_EQ(said(">4 m 1.5"), "- 1.500");
}

TEST(RangesCodec, ValuesThatAreNoRangesAreRefusedOneByOne) {
  EXPECT_EQ(said("0 -0.5 nan inf -inf ERR ? 1e400 1.0"), "? ? ? ? ? ? ? ? 1.000");
  EXPECT_EQ(said("0.0 cm"), "?");
}

TEST(RangesCodec, LinesThatMakeNoSenseAreRefusedAsAWhole) {
  EXPECT_EQ(said("hello world"), "no range in it");
  EXPECT_EQ(said(" , "), "no range in it");
  EXPECT_EQ(said("1.2.3"), "a word that makes no sense");
  EXPECT_EQ(said("1.2 0x10"), "a word that makes no sense");
  EXPECT_EQ(said("1.2 \x80\xFF"), "a word that makes no sense");
  EXPECT_EQ(said("1.2 5km"), "a word that makes no sense");
  EXPECT_EQ(said("R 1.20 0.85 - 2.00*6C"), "a wrong checksum");
  EXPECT_EQ(said("R 1.20*6"), "a checksum that is none");
  EXPECT_EQ(said("R 1.20*GG"), "a checksum that is none");
  EXPECT_EQ(said("1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17"), "a word that makes no sense");
}

TEST(RangesCodec, WhatIsWrittenIsReadBack) {
  EXPECT_EQ(encode({1.2, std::nullopt, 0.85}), "R 1.200 - 0.850*51\r\n");
  EXPECT_EQ(said("R 1.200 - 0.850*51"), "1.200 - 0.850");
}

TEST(RangesCodec, LinesAreCutOutOfBytesWithAnyLineEnd) {
  const std::string text = "R12\rR13\r\n\r\nR14\n" + std::string(300, '7') + "\nR15\nR1";
  for (const std::size_t piece : {1U, 3U, 400U}) {
    Lines lines;
    std::string all;
    int too_long = 0;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      const std::string part = text.substr(at, piece);
      lines.feed(
          {reinterpret_cast<const std::uint8_t*>(part.data()), part.size()},
          [&](std::string_view line) { all += std::string(line) + " "; }, [&] { ++too_long; });
    }
    EXPECT_EQ(all, "R12 R13 R14 R15 ");
    EXPECT_EQ(too_long, 1);
  }
}

}  // namespace
}  // namespace roverd::ranges
