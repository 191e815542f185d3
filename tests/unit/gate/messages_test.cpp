// What the gate reads in messages that are no CAN frames: examples from their descriptions, and
// what differs from these in one place.

#include <string_view>
#include <vector>

#include "gate_fixture.hpp"

namespace roverd::gate {
namespace {

using Message = std::vector<std::uint8_t>;

constexpr Limits kWide{.max_speed = 100.0,
                       .max_turn = 100.0,
                       .max_speed_step = 100.0,
                       .max_turn_step = 100.0,
                       .feedback_max_age_s = 1.0};

class MessagesTest : public ::testing::Test {
 protected:
  static Gate& opened(Gate& gate, Time now) {
    gate.permit(true);
    gate.saw(now);
    return gate;
  }
  bool allows(Gate& gate, std::string_view text) {
    const Message bytes{text.begin(), text.end()};
    return opened(gate, now).allows(base::Bytes(bytes), now);
  }
  bool allows(Gate& gate, const Message& bytes) {
    return opened(gate, now).allows(base::Bytes(bytes), now);
  }
  /// With speed or turn limited to this, just below and just above what a message says.
  template <class Make>
  void expect_read(Make make, const Message& message, double speed, double turn) {
    for (const double more : {1e-6, -1e-6}) {
      Limits l = kWide;
      l.max_speed = speed + more;
      l.max_turn = turn + more;
      Gate gate{make(l)};
      EXPECT_EQ(allows(gate, message), more > 0.0) << more;
      l.max_speed = speed + 1e-6;
      Gate turns{make(l)};
      EXPECT_EQ(allows(turns, message), more > 0.0) << more;
    }
  }

  Time now = Time{} + 100s;
};

constexpr std::string_view kLine = "$RVC,7,0.500,-0.250,1*6E\r\n";
const Message kBinary{0xA5, 0x5A, 1, 6, 66, 0xD4, 0xFE, 0xF4, 0x01, 1, 0xE9, 0xA9};
const Message kDatagram{0x10, 0x3F, 0x9D, 0x70, 0xA4, 0x20, 0x3E, 0x83, 0xA2, 0x9C, 0x30, 2};

Message changed(Message m, std::size_t at, int value) {
  m[at] = static_cast<std::uint8_t>(value);
  return m;
}

TEST_F(MessagesTest, ReadsWhatTheDescriptionsSay) {
  expect_read([](const Limits& l) { return twist_text(l); }, Message(kLine.begin(), kLine.end()),
              0.5, 0.25);
  expect_read([](const Limits& l) { return twist_binary(l); }, kBinary, 0.3, 0.5);
  expect_read([](const Limits& l) { return ackermann(l, true); }, kDatagram, 1.23F, 0.2571F);
  const std::string_view line = "0.300 -0.250\n";
  expect_read([](const Limits& l) { return ratio(l); }, Message(line.begin(), line.end()), 0.3,
              0.25);
}

TEST_F(MessagesTest, ATwistLineThatIsNotAsDescribedStaysInside) {
  Gate gate{twist_text(kWide)};
  EXPECT_TRUE(allows(gate, kLine));
  for (const std::string_view line : {
           "$RVC,7,0.500,-0.250,1*6F\r\n",    // the seal of another line
           "$RVC,7,0.500,-0.250,1*7E\r\n",    //
           "$RVC,7,0.500,-0.250,1*6\r\n",     // half a seal
           "$RVC,7,0.500,-0.250,1*06E\r\n",   // one and a half
           "$RVC,7,0.500,-0.250,1*6G\r\n",    // no digit
           "$RVC,7,0.500,-0.250,1*G6\r\n",    //
           "$RVC,7,0.500,-0.250,1\r\n",       // none
           "$RVC,7,0.500,-0.250,1*6E\n",      // another end
           "$RVC,7,0.500,-0.250,1*6E",        // none
           "$RVC,7,0.500,-0.250*73\r\n",      // a number too few
           "$RVC,7,0.500,-0.250,1,0*72\r\n",  // one too many
           "$RVF,7,0.500,-0.250,1*6B\r\n",    // what only the device may say
           "$RVC,7,0.500,nan,1*0B\r\n",       // no numbers
           "$RVC,7,0.000,inf,1*0E\r\n",       //
           "$RVC,7,1e1,0.000,1*0A\r\n",       //
           "$RVC,7,0.5x0,-0.250,1*26\r\n",    //
           "$RVC,7,,0.000,1*6F\r\n",          //
           "$RVC,,,,*47\r\n",                 //
           "$RVC,7,0.500;-0.250,1*79\r\n",    // another separator
           "$RVC,7,0.500,-0.250,2*6D\r\n",    // neither on nor off
           "$RVC,7,0.000,0.000,-1*6C\r\n",    //
           "$RVC,7,0.000,0.000,2*42\r\n",     //
           "$",                               // hardly anything
           "*6E\r\n",                         //
           "$*00\r\n",                        //
           "\r\n",                            //
           "",
       }) {
    EXPECT_FALSE(allows(gate, line)) << line;
  }
  EXPECT_EQ(gate.counts().refused[static_cast<std::size_t>(Refusal::WrongContent)],
            gate.counts().refused_total());
  EXPECT_TRUE(allows(gate, "$RVC,7,0.000,0.000,0*40\r\n"));
}

TEST_F(MessagesTest, ATwistFrameThatIsNotAsDescribedStaysInside) {
  Gate gate{twist_binary(kWide)};
  EXPECT_TRUE(allows(gate, kBinary));
  for (std::size_t at = 0; at < kBinary.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      const Message broken = changed(kBinary, at, kBinary[at] ^ (1 << bit));
      EXPECT_FALSE(allows(gate, broken)) << "byte " << at << " bit " << bit;
    }
  }
  EXPECT_EQ(gate.counts().refused[static_cast<std::size_t>(Refusal::WrongContent)], 96u);
  Message longer = kBinary;
  longer.push_back(0);
  EXPECT_FALSE(allows(gate, longer));
  EXPECT_FALSE(allows(gate, Message{}));
  EXPECT_EQ(gate.counts().refused[static_cast<std::size_t>(Refusal::WrongLength)], 2u);
}

TEST_F(MessagesTest, AFrameOfTheDeviceItselfStaysInsideAlthoughItsChecksumIsRight) {
  // 66, −0.3 m/s, 0.5 rad/s, enabled: once as described, once each with another head.
  Gate gate{twist_binary(kWide)};
  EXPECT_FALSE(allows(
      gate, Message{0xA5, 0x5A, 0x02, 0x06, 0x42, 0xD4, 0xFE, 0xF4, 0x01, 0x01, 0x9C, 0x61}));
  EXPECT_FALSE(allows(
      gate, Message{0xA5, 0x5A, 0x01, 0x07, 0x42, 0xD4, 0xFE, 0xF4, 0x01, 0x01, 0x88, 0x11}));
  EXPECT_FALSE(allows(
      gate, Message{0xA5, 0x5A, 0x01, 0x06, 0x42, 0xD4, 0xFE, 0xF4, 0x01, 0x02, 0x8A, 0x99}));
}

TEST_F(MessagesTest, TheSwitchOfATwistFrameIsOnOrOff) {
  Gate gate{twist_binary(kWide)};
  EXPECT_TRUE(
      allows(gate, Message{0xA5, 0x5A, 0x01, 0x06, 0x42, 0x00, 0x00, 0x00, 0x00, 0x01, 0xB9, 0x26}))
      << "on";
  EXPECT_TRUE(
      allows(gate, Message{0xA5, 0x5A, 0x01, 0x06, 0x42, 0x00, 0x00, 0x00, 0x00, 0x00, 0x98, 0x36}))
      << "off";
  EXPECT_FALSE(
      allows(gate, Message{0xA5, 0x5A, 0x01, 0x06, 0x42, 0x00, 0x00, 0x00, 0x00, 0x02, 0xDA, 0x16}))
      << "neither";
}

TEST_F(MessagesTest, ALineIsNotItsOwnSeal) {
  // The exclusive or of "31" without its first character is 31.
  Table table = ratio(kWide)[0];
  table.motion.text = Text{"", ',', 1, Check::Xor, ""};
  table.motion.values[1].field = table.motion.values[0].field;
  Gate gate{{table}};
  EXPECT_FALSE(allows(gate, "31"));
  EXPECT_FALSE(allows(gate, "*00"));
  EXPECT_FALSE(allows(gate, ""));
  EXPECT_TRUE(allows(gate, "31*31"));
}

TEST_F(MessagesTest, ADatagramThatIsNotAsDescribedStaysInside) {
  Gate gate{ackermann(kWide, true)};
  EXPECT_TRUE(allows(gate, kDatagram));
  for (const std::size_t mark : {0u, 5u, 10u}) {
    for (const int step : {-1, 1}) {
      EXPECT_FALSE(allows(gate, changed(kDatagram, mark, kDatagram[mark] + step))) << mark;
    }
  }
  const Message park{0x10, 0, 0, 0, 0, 0x20, 0x3E, 0x83, 0xA2, 0x9C, 0x30, 1};
  EXPECT_TRUE(allows(gate, park));
  EXPECT_TRUE(allows(gate, changed(park, 11, 3))) << "driven from the radio";
  EXPECT_FALSE(allows(gate, changed(park, 11, 0)));
  EXPECT_FALSE(allows(gate, changed(park, 11, 4)));
  // not a number, infinity: 7FC00000, FF800000
  for (const std::size_t at : {1u, 6u}) {
    EXPECT_FALSE(allows(gate, changed(changed(kDatagram, at, 0x7F), at + 1, 0xC0)));
    EXPECT_FALSE(allows(gate, changed(changed(kDatagram, at, 0xFF), at + 1, 0x80)));
  }
  EXPECT_EQ(gate.counts().refused[static_cast<std::size_t>(Refusal::WrongContent)], 12u);
  Message longer = kDatagram;
  longer.push_back(0);
  EXPECT_FALSE(allows(gate, longer));
  EXPECT_FALSE(allows(gate, changed(kDatagram, 11, 3)));
}

TEST_F(MessagesTest, ALineOfSpeedAndRatioThatIsNotAsDescribedStaysInside) {
  Gate gate{ratio(kWide)};
  EXPECT_TRUE(allows(gate, "0.300 -0.250\n"));
  for (const std::string_view line :
       {"0.300 -0.250", "0.300 -0.250\r\n", "0.300\n", "0.300 -0.250 1\n", "0.300,-0.250\n",
        "0.300 \n", " 0.300 0.1\n", "0.300 1 1 1 1 1\n", "x 0.1\n", "0.3 nan\n", "0.3 1e0\n", "\n",
        ""}) {
    EXPECT_FALSE(allows(gate, line)) << line;
  }
  EXPECT_TRUE(allows(gate, "0.000 0.000\n"));
}

TEST_F(MessagesTest, ACarThatNeedNotAnswerDrivesUntilItHasSpokenOnceAndAgainAfterANewStart) {
  Gate gate{ackermann(kWide, false)};
  gate.permit(true);
  EXPECT_TRUE(gate.allows(base::Bytes(kDatagram), now)) << "it never spoke";
  gate.saw(now);
  now += 1001ms;
  EXPECT_FALSE(gate.allows(base::Bytes(kDatagram), now)) << "it fell silent";
  gate.permit(false);
  gate.permit(true);
  EXPECT_FALSE(gate.allows(base::Bytes(kDatagram), now)) << "another permission is no excuse";
  gate.renew();
  EXPECT_TRUE(gate.allows(base::Bytes(kDatagram), now)) << "a new start is";
}

TEST_F(MessagesTest, TheSmallestStepsCountFromTheLastSpeed) {
  Limits l = kWide;
  l.max_speed_step = 0.02;
  Gate gate{ratio(l)};
  EXPECT_TRUE(allows(gate, "0.015 0.000\n"));
  EXPECT_TRUE(allows(gate, "0.030 0.000\n"));
  EXPECT_FALSE(allows(gate, "0.051 0.000\n"));
}

TEST_F(MessagesTest, ACarThatMustAnswerDoesNotDriveBeforeItHas) {
  Gate gate{ackermann(kWide, true)};
  gate.permit(true);
  EXPECT_FALSE(gate.allows(base::Bytes(kDatagram), now));
  EXPECT_EQ(gate.counts().refused[static_cast<std::size_t>(Refusal::Stale)], 1u);
}

TEST_F(MessagesTest, AMessageWithoutAnIdIsNoBusinessOfABusAndAFrameNoneOfALine) {
  Gate bus{bunker({})};
  EXPECT_FALSE(allows(bus, "0.000 0.000\n"));
  EXPECT_EQ(bus.counts().refused[static_cast<std::size_t>(Refusal::NotListed)], 1u);
  EXPECT_FALSE(bus.lists(0));
  EXPECT_TRUE(bus.lists(0x111) && bus.lists(0x130) && bus.lists(0x421) && bus.lists(0x140));
  EXPECT_FALSE(bus.lists(0x221) || bus.lists(0x112));
  Gate line{ratio(kWide)};
  EXPECT_FALSE(line.allows(frame(0x111, {0, 0, 0, 0, 0, 0, 0, 0}), now));
}

}  // namespace
}  // namespace roverd::gate
