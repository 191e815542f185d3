// What a SocketCAN link tells about its bus, filters, confirmations and bringing it up, on a real
// kernel with vcan (tests/can).

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/capability.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "link/can_control.hpp"
#include "vcan.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

constexpr const char* kReportBus = "vcan8";

class Bus : public testing::Test {
 protected:
  void SetUp() override { ip(std::string("add dev ") + kReportBus + " type vcan"); }
  void TearDown() override { ip(std::string("delete ") + kReportBus); }
  void up() { ip(std::string("set ") + kReportBus + " up"); }
  /// Reports are a second apart, so that each one reads the kernel.
  BusReport report(Node& node) {
    now += 2s;
    return node.link.report(now);
  }
  asio::io_context io;
  Time now = base::steady_now();
};

TEST_F(Bus, TheInterfacesStateIsToldWhetherTheLinkIsOpenOrNot) {
  Node node(io, kReportBus);
  EXPECT_EQ(report(node).facts.at("can_interface"), "down");
  up();
  const auto facts = report(node).facts;
  EXPECT_EQ(facts.at("can_interface"), "up");
  EXPECT_EQ(facts.at("can_kind"), "vcan");
  EXPECT_FALSE(facts.contains("can_state"));  // there is no controller
  Node nowhere(io, "vcan99");
  EXPECT_EQ(report(nowhere).facts.at("can_interface"), "missing");
}

TEST_F(Bus, TheStateIsReadOnceASecondAndNotAtEveryReport) {
  Node node(io, kReportBus);
  EXPECT_EQ(node.link.report(now).facts.at("can_interface"), "down");
  up();
  EXPECT_EQ(node.link.report(now + 900ms).facts.at("can_interface"), "down");
  EXPECT_EQ(node.link.report(now + 1s).facts.at("can_interface"), "up");
}

TEST_F(Bus, OwnFramesComeBackAsConfirmationsAndAreNotHeard) {
  up();
  Node a(io, kReportBus);
  Node b(io, kReportBus);
  ASSERT_TRUE(a.link.open());
  ASSERT_TRUE(b.link.open());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(a.link.send(make_frame(0x111, {1})), SendResult::Sent);
  EXPECT_TRUE(a.link.confirmations().oldest_waiting(base::steady_now()));
  ASSERT_TRUE(run_until(io, [&] { return a.link.confirmations().confirmed_count() == 5; }));
  EXPECT_FALSE(a.link.confirmations().oldest_waiting(base::steady_now()));
  EXPECT_EQ(report(a).facts.at("can_confirmed"), "5 of 5");
  EXPECT_TRUE(a.heard.empty());
  // The same id from another program is no confirmation: somebody else sends what we send.
  b.link.send(make_frame(0x111, {2}));
  ASSERT_TRUE(run_until(io, [&] { return a.heard.size() == 1; }));
  EXPECT_EQ(a.link.confirmations().confirmed_count(), 5u);
}

TEST_F(Bus, ErrorFramesAreCountedByTheirWords) {
  up();
  Node a(io, kReportBus);
  Node b(io, kReportBus);
  ASSERT_TRUE(a.link.open());
  ASSERT_TRUE(b.link.open());
  auto error = make_frame(0x20, {0, 0, 0, 0, 0, 0, 0, 0});
  error.error = true;
  a.link.send(error);
  error.id = 0x40;
  a.link.send(error);
  ASSERT_TRUE(run_until(io, [&] { return b.heard.size() == 2; }));
  const auto told = report(b);
  EXPECT_EQ(told.counts.at("CAN error: no acknowledgement"), 1u);
  EXPECT_EQ(told.counts.at("CAN error: bus off"), 1u);
  EXPECT_EQ(told.facts.at("can_last_error"), "bus off");
}

TEST_F(Bus, CanFdFramesAreCountedAndNothingElse) {
  ip(std::string("set ") + kReportBus + " mtu 72");
  up();
  Node a(io, kReportBus);
  ASSERT_TRUE(a.link.open());
  const int fd = ::socket(PF_CAN, SOCK_RAW, CAN_RAW);
  const int on = 1;
  ::setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(kReportBus));
  ASSERT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  canfd_frame frame{};
  frame.can_id = 0x211;
  frame.len = 8;  // as long as a classic one, and still another kind
  ASSERT_EQ(::write(fd, &frame, sizeof frame), static_cast<ssize_t>(sizeof frame));
  ::close(fd);
  Node b(io, kReportBus);
  ASSERT_TRUE(b.link.open());
  b.link.send(make_frame(1, {}));
  ASSERT_TRUE(run_until(io, [&] { return !a.heard.empty(); }));
  EXPECT_EQ(a.heard, std::vector<CanFrame>{make_frame(1, {})});
  EXPECT_EQ(report(a).counts.at("CAN FD frame"), 1u);
}

TEST_F(Bus, AFilterLetsItsIdsThroughAndNoOthers) {
  up();
  Node a(io, kReportBus);
  Node b(io, kReportBus, {.only = {{0x211}, {0x18FF0001, true}}});
  ASSERT_TRUE(a.link.open());
  ASSERT_TRUE(b.link.open());
  auto wide = make_frame(0x18FF0001, {});
  wide.extended = true;
  auto same_number = make_frame(0x211, {});
  same_number.extended = true;
  for (const auto& f : {make_frame(0x210, {}), same_number, make_frame(0x211, {}), wide}) {
    a.link.send(f);
  }
  b.link.send(make_frame(0x211, {9}));
  ASSERT_TRUE(run_until(io, [&] { return b.heard.size() == 2 && a.heard.size() == 1; }));
  EXPECT_EQ(b.heard, (std::vector<CanFrame>{make_frame(0x211, {}), wide}));
  EXPECT_FALSE(report(b).facts.contains("can_confirmed"));
}

TEST_F(Bus, SeveralBusesAreHeardAtOnceAndApart) {
  up();
  ip("add dev vcan9 type vcan");
  ip("set vcan9 up");
  {
    Node left(io, kReportBus);
    Node right(io, "vcan9");
    Node far_left(io, kReportBus);
    Node far_right(io, "vcan9");
    for (Node* node : {&left, &right, &far_left, &far_right}) ASSERT_TRUE(node->link.open());
    far_left.link.send(make_frame(1, {}));
    far_right.link.send(make_frame(2, {}));
    ASSERT_TRUE(run_until(io, [&] { return !left.heard.empty() && !right.heard.empty(); }));
    EXPECT_EQ(left.heard, std::vector<CanFrame>{make_frame(1, {})});
    EXPECT_EQ(right.heard, std::vector<CanFrame>{make_frame(2, {})});
  }
  ip("delete vcan9");
}

TEST_F(Bus, AnInterfaceThatIsOursToSetUpIsBroughtUpByOpening) {
  Node node(io, kReportBus, {.bitrate = 500'000});  // a virtual bus has no bit rate: only up
  ASSERT_TRUE(node.link.open());
  EXPECT_TRUE(read_can_state(kReportBus)->up);
  ip(std::string("set ") + kReportBus + " down");
  ASSERT_TRUE(run_until(io, [&] { return !node.closed.empty(); }));
  ASSERT_TRUE(node.link.open());
  EXPECT_TRUE(read_can_state(kReportBus)->up);
}

TEST_F(Bus, WithoutTheRightToSetItUpTheErrorSaysSo) {
  // In a child: a right given away does not come back.
  const pid_t child = ::fork();
  if (child == 0) {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct none[2]{};
    if (::syscall(SYS_capset, &header, none) != 0) ::_exit(2);
    const auto brought = bring_up(kReportBus, {.up = true});
    const std::string expected = std::string("CAN interface ") + kReportBus +
                                 ": cannot be set up: not allowed (it needs CAP_NET_ADMIN)";
    ::_exit(!brought && brought.error().detail == expected ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_FALSE(read_can_state(kReportBus)->up);
}

}  // namespace
}  // namespace roverd::link
