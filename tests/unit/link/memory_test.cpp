#include "link/memory.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

struct Heard {
  CanFrame frame;
  Time at;
  friend bool operator==(const Heard&, const Heard&) = default;
};

class MemoryWire : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wire.a->open());
    ASSERT_TRUE(wire.b->open());
    wire.b->on_frame = [this](const CanFrame& f, Time t) { heard.push_back({f, t}); };
  }
  MemoryFramePair wire = memory_frame_pair(4);
  std::vector<Heard> heard;
  const CanFrame one = make_frame(1, {1});
  const CanFrame two = make_frame(2, {2});
};

TEST_F(MemoryWire, FramesArriveInOrderWhenTheTestSaysSo) {
  wire.a->send(one);
  wire.a->send(two);
  EXPECT_TRUE(heard.empty());
  EXPECT_EQ(wire.b->waiting(), 2u);
  EXPECT_EQ(wire.b->deliver(Time(3s)), 2u);
  EXPECT_EQ(heard, (std::vector<Heard>{{one, Time(3s)}, {two, Time(3s)}}));
  EXPECT_EQ(wire.b->deliver(Time(4s)), 0u);
}

TEST_F(MemoryWire, AnAnswerGivenInACallbackArrivesAtTheNextDelivery) {
  std::vector<Time> answers;
  wire.b->on_frame = [&](const CanFrame&, Time) { wire.b->send(two); };
  wire.a->on_frame = [&](const CanFrame&, Time t) {
    answers.push_back(t);
    wire.a->send(one);
  };
  wire.a->send(one);
  EXPECT_EQ(wire.b->deliver(Time(1s)), 1u);
  EXPECT_EQ(wire.a->deliver(Time(2s)), 1u);
  EXPECT_EQ(answers, std::vector<Time>{Time(2s)});
  EXPECT_EQ(wire.b->waiting(), 1u);
}

TEST_F(MemoryWire, WithAClockFramesArriveAtOnce) {
  wire.a->set_immediate([] { return Time(7s); });
  wire.a->send(one);
  EXPECT_EQ(heard, (std::vector<Heard>{{one, Time(7s)}}));
}

TEST_F(MemoryWire, LosesWhatTheTestWantsLost) {
  wire.a->set_loss([](const CanFrame& f) { return f.id == 1; });
  EXPECT_EQ(wire.a->send(one), SendResult::Sent);
  EXPECT_EQ(wire.a->send(two), SendResult::Sent);
  wire.b->deliver(Time(1s));
  EXPECT_EQ(heard, (std::vector<Heard>{{two, Time(1s)}}));
}

TEST_F(MemoryWire, AFullWireIsBusyAndCounts) {
  for (int i = 0; i < 4; ++i) EXPECT_EQ(wire.a->send(one), SendResult::Sent);
  EXPECT_EQ(wire.a->send(two), SendResult::Busy);
  EXPECT_EQ(wire.a->dropped(), 1u);
}

TEST_F(MemoryWire, IsClosedUnlessBothEndsAreOpen) {
  wire.a->send(one);
  wire.b->close();
  EXPECT_EQ(wire.a->send(one), SendResult::Closed);
  EXPECT_EQ(wire.b->deliver(Time(1s)), 0u);
  ASSERT_TRUE(wire.b->open());
  EXPECT_EQ(wire.a->send(one), SendResult::Sent);
  wire.b.reset();
  EXPECT_EQ(wire.a->send(one), SendResult::Closed);
}

TEST_F(MemoryWire, BreaksAndIsRefusedWhenTheTestSaysSo) {
  std::string why;
  wire.b->on_closed = [&](const std::string& reason) { why = reason; };
  wire.b->fail("bus off");
  EXPECT_EQ(why, "bus off");
  EXPECT_FALSE(wire.b->is_open());
  wire.b->refuse_open("no such interface");
  EXPECT_EQ(wire.b->open().error().detail, "no such interface");
  wire.b->refuse_open("");
  EXPECT_TRUE(wire.b->open());
}

TEST_F(MemoryWire, AReceiverMayCloseInTheMiddle) {
  int calls = 0;
  wire.b->on_frame = [&](const CanFrame&, Time) {
    ++calls;
    wire.b->close();
  };
  wire.a->send(one);
  wire.a->send(two);
  EXPECT_EQ(wire.b->deliver(Time(1s)), 1u);
  EXPECT_EQ(calls, 1);
}

TEST(MemoryBytes, ChunksArriveAsTheyWereWritten) {
  auto wire = memory_byte_pair();
  ASSERT_TRUE(wire.a->open());
  ASSERT_TRUE(wire.b->open());
  std::vector<std::string> heard;
  wire.b->on_bytes = [&](Bytes b, Time) { heard.push_back(text_of(b)); };
  EXPECT_EQ(wire.a->write(bytes_of("$GNG")), SendResult::Sent);
  EXPECT_EQ(wire.a->write({}), SendResult::Sent);
  EXPECT_EQ(wire.a->write(bytes_of("GA,\r\n")), SendResult::Sent);
  EXPECT_EQ(wire.b->deliver(Time(1s)), 2u);
  EXPECT_EQ(heard, (std::vector<std::string>{"$GNG", "GA,\r\n"}));
}

}  // namespace
}  // namespace roverd::link
