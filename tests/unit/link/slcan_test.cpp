#include "link/slcan.hpp"

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

using Kind = SlcanLine::Kind;

TEST(Slcan, EveryKindOfFrameIsWrittenAndReadBack) {
  auto extended = make_frame(0x211, {0x2A, 0xA5});
  extended.extended = true;
  auto remote = make_frame(0x211, {});
  remote.remote = true;
  auto wide_remote = make_frame(0x1FFFFFFF, {});
  wide_remote.remote = wide_remote.extended = true;
  wide_remote.len = 8;
  const std::pair<base::CanFrame, const char*> cases[] = {
      {make_frame(0x111, {0, 0x96, 0, 0, 0, 0, 0, 0}), "t11180096000000000000"},
      {make_frame(0x421, {1, 0, 0, 0, 0, 0, 0, 0}), "t42180100000000000000"},
      {make_frame(0, {}), "t0000"},
      {extended, "T0000021122AA5"},
      {remote, "r2110"},
      {wide_remote, "R1FFFFFFF8"},
  };
  for (const auto& [frame, line] : cases) {
    EXPECT_EQ(to_slcan_line(frame), std::string(line) + '\r');
    const auto read = parse_slcan_line(line);
    ASSERT_TRUE(read) << line << ": " << read.error().detail;
    EXPECT_EQ(read->kind, Kind::Frame);
    EXPECT_EQ(read->frame, frame) << line;
  }
}

TEST(Slcan, SmallHexDigitsAndARemoteFrameWithoutItsLengthAreUnderstood) {
  const auto small = parse_slcan_line("t2418aa00000000000061");
  ASSERT_TRUE(small);
  EXPECT_EQ(small->frame, make_frame(0x241, {0xAA, 0, 0, 0, 0, 0, 0, 0x61}));
  const auto remote = parse_slcan_line("r211");
  ASSERT_TRUE(remote);
  EXPECT_TRUE(remote->frame.remote);
  EXPECT_EQ(remote->frame.len, 0);
}

TEST(Slcan, ADamagedLineIsRefusedWithTheReason) {
  const std::pair<const char*, const char*> cases[] = {
      {"t2418AA000000000000", "number of digits"},
      {"t2418AA0000000000006", "number of digits"},
      {"t2418AA0000000000006104D2", "number of digits"},  // a time stamp, though switched off
      {"t2119000000000000000000", "length is not 0 to 8"},
      {"t211", "length is not 0 to 8"},
      {"t21G80000000000000000", "id is not hex"},
      {"t2118000000000000000g", "data is not hex"},
      {"t2118 0000000000000 0", "data is not hex"},
      {"t8000", "id is too large"},
      {"T200000000", "id is too large"},
      {"t21", "id is too short"},
      {"r21111", "number of digits"},
      {"x", "no adapter says"},
      {"s", "not a state"},
      {"sq000000", "not a state"},
      {"sa0000", "not a state"},
      {"sa00x000", "counters are not digits"},
      {"F8", "not two hex digits"},
      {"e2a", "not a list"},
  };
  for (const auto& [line, reason] : cases) {
    const auto read = parse_slcan_line(line);
    ASSERT_FALSE(read) << line;
    EXPECT_NE(read.error().detail.find(reason), std::string::npos) << read.error().detail;
  }
}

TEST(Slcan, AnswersAndStatesAreRead) {
  for (const char* done : {"", "z", "Z"}) EXPECT_EQ(parse_slcan_line(done)->kind, Kind::Done);
  const auto flags = parse_slcan_line("FA4");
  ASSERT_EQ(flags->kind, Kind::Flags);
  EXPECT_EQ(slcan_flag_words(flags->flags), "error warning, error passive, bus error");
  const auto state = parse_slcan_line("sp012136");
  ASSERT_EQ(state->kind, Kind::State);
  EXPECT_EQ(state->controller, CanController::ErrorPassive);
  EXPECT_EQ(state->rx_errors, 12);
  EXPECT_EQ(state->tx_errors, 136);
  EXPECT_EQ(parse_slcan_line("sb000000")->controller, CanController::BusOff);
  EXPECT_EQ(parse_slcan_line("e2as")->text, "as");
  EXPECT_EQ(parse_slcan_line("V1013")->kind, Kind::Other);
}

TEST(Slcan, OnlyTheNineSpeedsHaveADigit) {
  EXPECT_EQ(slcan_speed(10'000), '0');
  EXPECT_EQ(slcan_speed(500'000), '6');
  EXPECT_EQ(slcan_speed(1'000'000), '8');
  EXPECT_FALSE(slcan_speed(115'200));
}

TEST(SlcanFramer, LinesAreTheSameHoweverTheStreamIsCut) {
  const std::string stream = "t1110\r\n\r\az\rt2110\a";
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    SlcanFramer framer;
    std::vector<SlcanFramer::Piece> out;
    framer.feed(bytes_of(stream.substr(0, cut)), out);
    framer.feed(bytes_of(stream.substr(cut)), out);
    ASSERT_EQ(out.size(), 5u) << cut;
    EXPECT_EQ(out[0].line, "t1110");
    EXPECT_EQ(out[1].line, "");
    EXPECT_FALSE(out[1].refused);
    EXPECT_TRUE(out[2].refused);
    EXPECT_EQ(out[3].line, "z");
    EXPECT_TRUE(out[4].refused);
  }
}

TEST(SlcanFramer, ALineWithoutAnEndIsDroppedUpToTheNextEnd) {
  SlcanFramer framer;
  std::vector<SlcanFramer::Piece> out;
  framer.feed(bytes_of(std::string(100'000, 't') + "\rt1110\r"), out);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_TRUE(out[0].too_long);
  EXPECT_EQ(out[1].line, "t1110");
  EXPECT_FALSE(out[1].too_long);
}

}  // namespace
}  // namespace roverd::link
