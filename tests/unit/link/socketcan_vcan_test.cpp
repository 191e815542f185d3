// SocketCAN on a real kernel with vcan. A program of its own, socketcan_test, that tests/can runs
// where the interfaces can be made (as root there); ctest does not know it.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "link/socketcan.hpp"
#include "tools.hpp"
#include "vcan.hpp"

namespace roverd::link {
namespace {

constexpr const char* kInterface = "vcan7";

class Vcan : public testing::Test {
 protected:
  void SetUp() override {
    ip(std::string("add dev ") + kInterface + " type vcan");
    exists = true;
    ip(std::string("set ") + kInterface + " up");
    ASSERT_TRUE(a.link.open());
    ASSERT_TRUE(b.link.open());
  }
  void TearDown() override {
    if (exists) ip(std::string("delete ") + kInterface);
  }
  bool exists = false;
  asio::io_context io;
  Node a{io, kInterface};
  Node b{io, kInterface};
};

TEST_F(Vcan, FramesOfEveryKindReachTheOthersAndNotTheSender) {
  CanFrame extended = make_frame(0x18FF1234, {1, 2, 3, 4, 5, 6, 7, 8});
  extended.extended = true;
  CanFrame remote = make_frame(0x211, {});
  remote.remote = true;
  remote.len = 4;
  const std::vector<CanFrame> frames{make_frame(0x111, {0, 150}), make_frame(0, {}), extended,
                                     remote};
  for (const auto& frame : frames) EXPECT_EQ(a.link.send(frame), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return b.heard.size() == frames.size(); }));
  EXPECT_EQ(b.heard, frames);
  run_ready(io);
  EXPECT_TRUE(a.heard.empty());
}

TEST_F(Vcan, FramesAreStampedWhenTheKernelTookThem) {
  const Time before = base::steady_now();
  a.link.send(make_frame(1, {}));
  const Time after = base::steady_now();
  while (base::steady_now() < after + std::chrono::milliseconds(500)) {
  }  // the frame waits unread
  ASSERT_TRUE(run_until(io, [&] { return !b.stamps.empty(); }));
  // A kernel in a kernel is slow and its clocks drift apart a little: wide, but far from the wait.
  EXPECT_GE(b.stamps[0], before - std::chrono::milliseconds(100));
  EXPECT_LE(b.stamps[0], after + std::chrono::milliseconds(250));
}

TEST_F(Vcan, ErrorFramesAreHeardAsSuch) {
  CanFrame error = make_frame(0x40, {0, 0, 0, 0, 0, 0, 0, 0});  // bus off
  error.error = true;
  ASSERT_EQ(a.link.send(error), SendResult::Sent);
  ASSERT_TRUE(run_until(io, [&] { return !b.heard.empty(); }));
  EXPECT_EQ(b.heard.at(0), error);
}

TEST_F(Vcan, AnInterfaceThatGoesDownClosesTheLinkAndIsNamedUntilItIsUp) {
  const std::string name = std::string("CAN interface ") + kInterface;
  ip(std::string("set ") + kInterface + " down");
  ASSERT_TRUE(run_until(io, [&] { return !a.closed.empty() && !b.closed.empty(); }));
  EXPECT_EQ(a.closed, name + " went down");
  EXPECT_EQ(a.link.send(make_frame(1, {})), SendResult::Closed);
  const auto refused = a.link.open();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail.rfind(name + " is down", 0), 0u) << refused.error().detail;
  ip(std::string("set ") + kInterface + " up");
  ASSERT_TRUE(a.link.open());
  ASSERT_TRUE(b.link.open());
  EXPECT_EQ(a.link.send(make_frame(1, {})), SendResult::Sent);
  EXPECT_TRUE(run_until(io, [&] { return b.heard.size() == 1; }));
}

TEST_F(Vcan, AnInterfaceThatIsRemovedClosesTheLink) {
  const std::string name = std::string("CAN interface ") + kInterface;
  ip(std::string("delete ") + kInterface);
  exists = false;
  ASSERT_TRUE(run_until(io, [&] { return !a.closed.empty(); }));
  EXPECT_EQ(a.closed, name + " was removed");
  EXPECT_EQ(a.link.open().error().detail, name + " does not exist");
}

TEST_F(Vcan, NothingIsHeardAfterClose) {
  a.link.send(make_frame(1, {}));
  b.link.close();
  run_ready(io);
  EXPECT_TRUE(b.heard.empty());
  EXPECT_EQ(b.closed, "");
}

/// a attends 0x221 and its own 0x111; b is somebody else on the bus.
class Attending : public Vcan {
 protected:
  void SetUp() override {
    a.link.attend({0x221, 0x111});
    Vcan::SetUp();
  }
  std::size_t count(std::uint32_t id) const {
    return static_cast<std::size_t>(std::count_if(a.heard.begin(), a.heard.end(),
                                                  [id](const CanFrame& f) { return f.id == id; }));
  }
};

TEST_F(Attending, AFloodThatFillsEveryBufferLosesAndDelaysNothingAttended) {
  constexpr int kFlood = 20'000;
  for (int i = 0; i < kFlood; ++i) {
    if (i % 1000 == 0) {
      ASSERT_EQ(b.link.send(make_frame(0x221, {std::uint8_t(i / 1000)})), SendResult::Sent);
    }
    ASSERT_EQ(b.link.send(make_frame(0x5F0, {1, 2, 3, 4, 5, 6, 7, 8})), SendResult::Sent);
  }
  io.poll();
  std::size_t foreign = 0;
  std::size_t attended = 0;
  for (const CanFrame& f : a.heard) {
    if (f.id != 0x221) {
      if (attended < 20) ++foreign;
      continue;
    }
    EXPECT_EQ(f.data[0], attended++);
  }
  EXPECT_EQ(attended, 20u);
  EXPECT_LE(foreign, 64u);  // one turn of the second socket's may come first
  EXPECT_EQ(a.link.overrun(), 0u);
}

TEST_F(Attending, TheOthersAreHeardAfterThemAndWhatTheKernelDroppedIsCounted) {
  for (int i = 0; i < 5'000; ++i) b.link.send(make_frame(0x5F0, {1}));
  ASSERT_TRUE(run_until(io, [&] { return count(0x5F0) >= 64; }));
  for (std::size_t before = 0; before < count(0x5F0);) {
    before = count(0x5F0);
    run_until(io, [&] { return count(0x5F0) > before; });
  }
  EXPECT_LT(count(0x5F0), 5'000u);
  b.link.send(make_frame(0x5F1, {}));  // a drop is told with the next frame that has room
  ASSERT_TRUE(run_until(io, [&] { return count(0x5F1) == 1; }));
  EXPECT_EQ(a.link.report(base::steady_now()).counts.at("foreign frame not read: the bus is full"),
            5'000u - count(0x5F0));
}

TEST_F(Attending, EveryKindOfForeignFrameStillComes) {
  CanFrame extended = make_frame(0x221, {1});
  extended.extended = true;
  CanFrame remote = make_frame(0x123, {});
  remote.remote = true;
  CanFrame error = make_frame(0x40, {0, 0, 0, 0, 0, 0, 0, 0});
  error.error = true;
  for (const CanFrame& f : {extended, remote, error, make_frame(0x7FF, {})}) {
    ASSERT_EQ(b.link.send(f), SendResult::Sent);
    ASSERT_TRUE(run_until(
        io, [&] { return std::find(a.heard.begin(), a.heard.end(), f) != a.heard.end(); }))
        << std::hex << f.id;
  }
  EXPECT_EQ(a.heard.size(), 4u);  // none of them twice
}

TEST_F(Attending, OwnFramesAreConfirmedAndNotHeardAndSomebodyElsesOfTheSameIdIs) {
  a.link.send(make_frame(0x111, {1}));
  ASSERT_TRUE(run_until(io, [&] { return a.link.confirmations().confirmed_count() == 1; }));
  EXPECT_TRUE(a.heard.empty());
  b.link.send(make_frame(0x111, {2}));
  ASSERT_TRUE(run_until(io, [&] { return a.heard.size() == 1; }));
  EXPECT_EQ(a.heard[0].data[0], 2);
}

TEST_F(Attending, StampsNeverGoBackBetweenTheTwoSockets) {
  for (int i = 0; i < 200; ++i) {
    b.link.send(make_frame(i % 3 == 0 ? 0x221 : 0x5F0, {std::uint8_t(i)}));
    if (i % 10 == 0) run_until(io, [&] { return count(0x5F0) > std::size_t(i) / 2; });
  }
  ASSERT_TRUE(run_until(io, [&] { return a.heard.size() == 200; }));
  EXPECT_TRUE(std::is_sorted(a.stamps.begin(), a.stamps.end()));
}

TEST(VcanErrors, AnInterfaceThatIsNotCanIsRefused) {
  asio::io_context io;
  EXPECT_EQ(SocketCanLink(io, "lo").open().error().detail,
            "CAN interface lo is not a CAN interface");
}

}  // namespace
}  // namespace roverd::link
