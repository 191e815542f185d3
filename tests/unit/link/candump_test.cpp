#include "link/candump.hpp"

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

CanRecord parsed(std::string_view line) {
  const auto record = parse_candump_line(line);
  if (!record || !*record) {
    ADD_FAILURE() << line << ": " << (record ? "no frame" : record.error().detail);
    return {};
  }
  return **record;
}

TEST(Candump, ALogLineIsRead) {
  const CanRecord r = parsed("(1700000000.123456) can0 241#A60000B00000007E");
  EXPECT_EQ(r.stamp, base::Duration(1'700'000'000s + 123'456us));
  EXPECT_EQ(r.bus, "can0");
  EXPECT_EQ(r.frame, make_frame(0x241, {0xA6, 0, 0, 0xB0, 0, 0, 0, 0x7E}));
  EXPECT_FALSE(r.sent);
}

TEST(Candump, AConsoleLineIsRead) {
  const CanRecord r = parsed("  vcan0  241   [8]  A6 00 00 B0 00 00 00 7E");
  EXPECT_EQ(r.stamp, std::nullopt);
  EXPECT_EQ(r.bus, "vcan0");
  EXPECT_EQ(r.frame, make_frame(0x241, {0xA6, 0, 0, 0xB0, 0, 0, 0, 0x7E}));
  EXPECT_EQ(parsed("  can0  221   [0] ").frame, make_frame(0x221, {}));
}

TEST(Candump, ExtendedRemoteAndErrorFramesAreToldApart) {
  const CanRecord extended = parsed("(1.0) can0 0000021A#01");
  EXPECT_TRUE(extended.frame.extended);
  EXPECT_EQ(extended.frame.id, 0x21Au);
  EXPECT_EQ(parsed("  can0  0000021A   [1]  01").frame, extended.frame);

  const CanRecord remote = parsed("(1.0) can0 211#R4");
  EXPECT_TRUE(remote.frame.remote);
  EXPECT_EQ(remote.frame.len, 4);
  EXPECT_EQ(parsed("(1.0) can0 211#R").frame.len, 0);
  EXPECT_EQ(parsed("  can0  211   [4]  remote request").frame, remote.frame);

  const CanRecord error = parsed("(1.0) can0 20000040#0004000000000000");
  EXPECT_TRUE(error.frame.error);
  EXPECT_FALSE(error.frame.extended);
  EXPECT_EQ(error.frame.id, 0x40u);
  EXPECT_EQ(parsed("  can0  20000040   [8]  00 04 00 00 00 00 00 00   ERRORFRAME").frame,
            error.frame);
}

TEST(Candump, TheOptionsOfTheConsoleAreUnderstood) {
  EXPECT_EQ(parsed(" (1700000000.5)  can0  211   [1]  01").stamp,
            base::Duration(1'700'000'000s + 500ms));
  EXPECT_EQ(parsed(" (000.000123)  can0  211   [1]  01").stamp, base::Duration(123us));
  EXPECT_EQ(parsed(" (2023-11-14 22:13:20.250000)  can0  211   [1]  01").stamp,
            base::Duration(1'700'000'000s + 250ms));
  EXPECT_FALSE(parsed(" can0  RX - -  211   [1]  01").sent);
  EXPECT_TRUE(parsed(" can0  TX - -  211   [1]  01").sent);
  EXPECT_EQ(parsed(" can0  211   [2]  41 5B   'A['").frame, make_frame(0x211, {0x41, 0x5B}));
  EXPECT_TRUE(parsed("(1.0) can0 211#01 T").sent);
  EXPECT_FALSE(parsed("(1.0) can0 211#01 R\r").sent);
  EXPECT_EQ(parsed("(1.0) can0 211#11.22.33").frame.len, 3);
  EXPECT_EQ(parsed("(1.0) can0 211#0102030405060708_C").frame.len, 8);
}

TEST(Candump, LinesWithoutAFrameAreNoErrors) {
  for (const char* line : {"", "   ", "\r", "# recorded on a field", "\tcontroller-problem{}"}) {
    const auto record = parse_candump_line(line);
    ASSERT_TRUE(record) << line;
    EXPECT_FALSE(*record) << line;
  }
}

TEST(Candump, WrongLinesSayWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"(1700000000.1 can0 241#00", "the time stamp has no closing bracket"},
      {"(x) can0 241#00", "the time stamp is not a number of seconds"},
      {"(1.1234567890) can0 241#00", "the time stamp is not a number of seconds"},
      {"(2023-13-14 22:13:20.25) can0 241#00", "the time stamp is not a number of seconds"},
      {"(1.0)", "the name of the bus is missing"},
      {"(1.0) an-endless-bus-name 241#00", "the name of the bus is missing"},
      {"(1.0) can0", "the frame is missing"},
      {"(1.0) can0 24#00", "the id is not 3 or 8 hex digits"},
      {"(1.0) can0 24G#00", "the id is not 3 or 8 hex digits"},
      {"(1.0) can0 800#00", "a standard id is at most 7FF"},
      {"(1.0) can0 40000000#00", "an extended id is at most 1FFFFFFF"},
      {"(1.0) can0 241#0", "the data is not pairs of hex digits"},
      {"(1.0) can0 241#0x", "the data is not pairs of hex digits"},
      {"(1.0) can0 241#010203040506070809", "more than 8 data bytes"},
      {"(1.0) can0 241##1AABB", "CAN FD frames are not supported"},
      {"(1.0) can0 241#R9", "unexpected text behind the data"},
      {"(1.0) can0 241#01_C", "unexpected text behind the data"},
      {"(1.0) can0 241#01 X", "unexpected text behind the data"},
      {"  can0  241   [08]  00 00 00 00 00 00 00 00", "CAN FD frames are not supported"},
      {"  can0  241   [9]  00", "the length is not [0] to [8]"},
      {"  can0  241   [2]  00",
       "fewer data bytes than the length says, or not two hex digits each"},
      {"  can0  241   [1]  00 11", "unexpected text behind the data"},
  };
  for (const auto& [line, problem] : cases) {
    const auto record = parse_candump_line(line);
    ASSERT_FALSE(record) << line;
    EXPECT_EQ(record.error().detail, problem) << line;
  }
}

TEST(Candump, AWrittenLineIsWhatCandumpWouldWrite) {
  CanRecord r{1'700'000'000s + 5'042us, "can0", make_frame(0x11, {0xA6, 0x0B}), false};
  EXPECT_EQ(to_candump_line(r), "(1700000000.005042) can0 011#A60B R\n");
  r.sent = true;
  r.frame.extended = true;
  EXPECT_EQ(to_candump_line(r), "(1700000000.005042) can0 00000011#A60B T\n");
  r.stamp = 5ms;
  r.frame = make_frame(0x40, {0});
  r.frame.error = true;
  EXPECT_EQ(to_candump_line(r), "(0000000000.005000) can0 20000040#00 T\n");
}

TEST(Candump, EveryKindOfFrameComesBackAsItWasWritten) {
  base::CanFrame extended = make_frame(0x1FFFFFFF, {1, 2, 3, 4, 5, 6, 7, 8});
  extended.extended = true;
  base::CanFrame remote = make_frame(0x7FF, {});
  remote.remote = true;
  remote.len = 8;
  base::CanFrame error = make_frame(0x1FFFFFFF, {0, 0, 0, 0, 0, 0, 0, 0});
  error.error = true;
  for (const auto& frame : {make_frame(0, {}), extended, remote, error}) {
    for (const bool sent : {false, true}) {
      const CanRecord record{base::Duration(1'700'000'000s + 999'999us), "vcan0", frame, sent};
      EXPECT_EQ(parsed(to_candump_line(record)), record);
    }
  }
}

}  // namespace
}  // namespace roverd::link
