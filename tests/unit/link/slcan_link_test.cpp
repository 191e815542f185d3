// Our own slcan on a pseudo-terminal, with a small adapter at the other end.

#include "link/slcan_link.hpp"

#include <gtest/gtest.h>

#include "terminal.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

class SlcanPort : public testing::Test {
 protected:
  void SetUp() override {
    link.on_frame = [this](const CanFrame& f, Time) { heard.push_back(f); };
    link.on_closed = [this](const std::string& why) { closed = why; };
    ASSERT_TRUE(link.open());
  }
  /// One turn: the adapter reads and answers.
  void serve() {
    said += terminal.hear();
    for (auto end = said.find('\r'); end != std::string::npos; end = said.find('\r')) {
      const std::string line = said.substr(0, end);
      said.erase(0, end + 1);
      commands.push_back(line);
      if (!line.empty() && line.front() == silent_to) continue;
      const bool refuses = !line.empty() && line.front() == refused;
      terminal.say(refuses ? "\a" : line == "F" ? flags : line.front() == 't' ? "z\r" : "\r");
    }
  }
  template <class Done>
  bool until(Done done) {
    return run_until(io, [&] {
      serve();
      return done();
    });
  }
  bool open_channel() {
    return until([&] { return link.phase() == SlcanLink::Phase::Open; });
  }

  asio::io_context io;
  Terminal terminal;
  SlcanLink link{io, terminal.path, 115'200};
  std::vector<CanFrame> heard;
  std::string closed;
  std::string said;
  std::vector<std::string> commands;
  std::string flags = "F00\r";
  char refused = '\0';
  char silent_to = '\0';
};

TEST_F(SlcanPort, TheChannelIsClosedSetAndOpenedBeforeAnythingIsSent) {
  EXPECT_EQ(link.send(make_frame(1, {})), SendResult::Closed);
  ASSERT_TRUE(open_channel());
  EXPECT_EQ(commands, (std::vector<std::string>{"C", "Z0", "S6", "O"}));
  EXPECT_EQ(link.describe(), "slcan:" + terminal.path + ":115200");
}

TEST_F(SlcanPort, FramesPassInBothDirectionsAndAreConfirmed) {
  ASSERT_TRUE(open_channel());
  terminal.say("t21180100010000800000\rT000002112AA55\rr2110\r");
  ASSERT_TRUE(until([&] { return heard.size() == 3; }));
  EXPECT_EQ(heard[0], make_frame(0x211, {1, 0, 1, 0, 0, 0x80, 0, 0}));
  EXPECT_TRUE(heard[1].extended);
  EXPECT_TRUE(heard[2].remote);
  EXPECT_EQ(link.send(make_frame(0x111, {0, 0x96})), SendResult::Sent);
  ASSERT_TRUE(until([&] { return link.report({}).facts.contains("can_confirmed"); }));
  EXPECT_EQ(commands.back(), "t11120096");
  EXPECT_EQ(link.report({}).facts.at("can_confirmed"), "1 of 1");
}

TEST_F(SlcanPort, DamagedLinesAreCountedAndTheRestIsHeard) {
  ASSERT_TRUE(open_channel());
  terminal.say("t2118AA\rrubbish\r" + std::string(50, '1') + "\rt1110\r");
  ASSERT_TRUE(until([&] { return !heard.empty(); }));
  EXPECT_EQ(heard, std::vector<CanFrame>{make_frame(0x111, {})});
  EXPECT_EQ(link.report({}).counts.at("adapter's line not understood"), 3u);
}

TEST_F(SlcanPort, AFrameThatTheAdapterRefusesIsCounted) {
  ASSERT_TRUE(open_channel());
  refused = 't';
  link.send(make_frame(1, {}));
  ASSERT_TRUE(until([&] { return !link.report({}).counts.empty(); }));
  EXPECT_EQ(link.report({}).counts.at("adapter refused a command"), 1u);
}

TEST_F(SlcanPort, WhatTheLineStillHeldWhenItWasOpenedIsNoAnswer) {
  terminal.say("z\rz\rt1110\r\a\a\r");
  ASSERT_TRUE(open_channel());
  EXPECT_TRUE(heard.empty());
  EXPECT_EQ(commands, (std::vector<std::string>{"C", "Z0", "S6", "O"}));
}

TEST_F(SlcanPort, TheAdaptersStatusBecomesWords) {
  ASSERT_TRUE(open_channel());
  flags = "F84\r";
  ASSERT_TRUE(until([&] { return link.report({}).facts.contains("can_last_error"); }));
  EXPECT_EQ(link.report({}).facts.at("can_last_error"), "error warning, bus error");
  terminal.say("sb000255\r");
  ASSERT_TRUE(until([&] { return link.report({}).facts.contains("can_state"); }));
  EXPECT_EQ(link.report({}).facts.at("can_state"), "bus off");
  EXPECT_EQ(link.report({}).facts.at("can_tx_errors"), "255");
}

TEST_F(SlcanPort, ABitRateThatTheAdapterRefusesClosesTheLink) {
  refused = 'S';
  ASSERT_TRUE(until([&] { return !closed.empty(); }));
  EXPECT_EQ(closed, "CAN adapter at " + terminal.path + " refuses S6");
  EXPECT_EQ(link.phase(), SlcanLink::Phase::Closed);
}

TEST_F(SlcanPort, AnAdapterThatDoesNotAnswerClosesTheLink) {
  silent_to = 'O';
  ASSERT_TRUE(until([&] { return !closed.empty(); }));
  EXPECT_EQ(closed, "CAN adapter at " + terminal.path + " does not answer to O");
}

TEST_F(SlcanPort, AnUnpluggedAdapterClosesTheLink) {
  ASSERT_TRUE(open_channel());
  terminal.hang_up();
  ASSERT_TRUE(run_until(io, [&] { return !closed.empty(); }));
  EXPECT_EQ(closed, "serial port " + terminal.path + " was unplugged");
  EXPECT_EQ(link.send(make_frame(1, {})), SendResult::Closed);
}

TEST_F(SlcanPort, ClosingSaysSoToTheAdapterAndItOpensAgain) {
  ASSERT_TRUE(open_channel());
  link.close();
  run_ready(io);
  serve();
  EXPECT_EQ(commands.back(), "C");
  EXPECT_EQ(closed, "");
  commands.clear();
  ASSERT_TRUE(link.open());
  ASSERT_TRUE(open_channel());
}

TEST(SlcanErrors, AMissingDeviceIsNamed) {
  asio::io_context io;
  EXPECT_EQ(SlcanLink(io, "/dev/no-such-port", 115'200).open().error().detail,
            "serial port /dev/no-such-port does not exist");
}

}  // namespace
}  // namespace roverd::link
