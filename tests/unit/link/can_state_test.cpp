#include "link/can_state.hpp"

#include <cerrno>
#include <cstring>

#include <gtest/gtest.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include "link/can_control.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

/// Attributes as the kernel writes them, from plain numbers.
std::string u16(unsigned v) {
  return {static_cast<char>(v & 0xFF), static_cast<char>(v >> 8)};
}
std::string u32(unsigned v) {
  return u16(v & 0xFFFF) + u16(v >> 16);
}
std::string attribute(unsigned type, const std::string& value) {
  std::string out = u16(static_cast<unsigned>(value.size()) + 4) + u16(type) + value;
  out.resize((out.size() + 3) / 4 * 4);
  return out;
}
std::string link_message(unsigned flags, const std::string& attributes) {
  const std::string payload = u16(0) + u16(280) + u32(7) + u32(flags) + u32(0) + attributes;
  return u32(static_cast<unsigned>(payload.size()) + 16) + u16(RTM_NEWLINK) + u16(0) + u32(1) +
         u32(0) + payload;
}
/// IFLA_LINKINFO { kind, data }
std::string link_info(const std::string& kind, const std::string& data) {
  return attribute(18, attribute(1, kind + '\0') + (data.empty() ? "" : attribute(2, data)));
}

TEST(CanStateAnswer, AHardwareInterfaceTellsStateCountersAndBitRate) {
  const std::string can = attribute(1, u32(500'000) + std::string(28, '\0')) +
                          attribute(4, u32(2)) + attribute(6, u32(100)) +
                          attribute(8, u16(136) + u16(17));
  const auto answer =
      parse_answer(bytes_of(link_message(IFF_UP, attribute(4, u32(16)) + link_info("can", can))));
  ASSERT_TRUE(answer) << answer.error().detail;
  ASSERT_TRUE(answer->state);
  const CanState& s = *answer->state;
  EXPECT_TRUE(s.exists);
  EXPECT_TRUE(s.up);
  EXPECT_EQ(s.index, 7);
  EXPECT_EQ(s.kind, "can");
  EXPECT_EQ(s.controller, CanController::ErrorPassive);
  EXPECT_EQ(s.tx_errors, 136);
  EXPECT_EQ(s.rx_errors, 17);
  EXPECT_EQ(s.bitrate, 500'000u);
  EXPECT_EQ(s.restart_ms, 100u);
  EXPECT_EQ(s.mtu, 16u);
}

TEST(CanStateAnswer, AVirtualInterfaceHasNoControllerAndNoBitRate) {
  const auto answer = parse_answer(bytes_of(link_message(0, link_info("vcan", ""))));
  ASSERT_TRUE(answer && answer->state);
  EXPECT_FALSE(answer->state->up);
  EXPECT_EQ(answer->state->kind, "vcan");
  EXPECT_FALSE(answer->state->controller);
  EXPECT_FALSE(answer->state->bitrate);
}

TEST(CanStateAnswer, ABitRateThatTheKernelDoesNotKnowIsAbsent) {
  for (const unsigned rate : {0u, 0xFFFF'FFFFu}) {
    const auto can = attribute(1, u32(rate) + std::string(28, '\0'));
    const auto answer = parse_answer(bytes_of(link_message(IFF_UP, link_info("can", can))));
    ASSERT_TRUE(answer && answer->state);
    EXPECT_FALSE(answer->state->bitrate);
  }
}

TEST(CanStateAnswer, ARefusalCarriesItsNumberAndTheKernelsWords) {
  const std::string request = u32(16) + u16(16) + u16(5) + u32(1) + u32(0);
  const std::string payload = u32(static_cast<unsigned>(-EPERM)) + request;
  const std::string words = attribute(1, std::string("no way") + '\0');
  const auto message = [&](unsigned flags, const std::string& tail) {
    return u32(static_cast<unsigned>(16 + payload.size() + tail.size())) + u16(NLMSG_ERROR) +
           u16(flags) + u32(1) + u32(0) + payload + tail;
  };
  const auto plain = parse_answer(bytes_of(message(0, "")));
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->error, EPERM);
  EXPECT_EQ(plain->reason, "");
  const auto spoken = parse_answer(bytes_of(message(NLM_F_CAPPED | NLM_F_ACK_TLVS, words)));
  ASSERT_TRUE(spoken);
  EXPECT_EQ(spoken->error, EPERM);
  EXPECT_EQ(spoken->reason, "no way");
}

TEST(CanStateAnswer, EveryCutOffMessageIsRefusedAndNoneReadBeyondItsEnd) {
  const std::string whole =
      link_message(IFF_UP, link_info("can", attribute(4, u32(1)) + attribute(8, u32(0))));
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_FALSE(parse_answer(bytes_of(whole.substr(0, n)))) << n;
  }
  std::string lying = whole;
  lying[32] = 2;  // an attribute shorter than its own head
  EXPECT_FALSE(parse_answer(bytes_of(lying)));
  lying = whole;
  lying[4] = 99;
  EXPECT_FALSE(parse_answer(bytes_of(lying)));
}

TEST(CanRequests, LengthsFitAndNamesEndInZero) {
  for (const auto& message : {ask_link("can0", 1), set_link_up(3, true, 2),
                              set_can(3, {.bitrate = 500'000, .restart_ms = 100}, 3)}) {
    std::uint32_t length = 0;
    std::memcpy(&length, message.data(), sizeof length);
    EXPECT_EQ(length, message.size());
    EXPECT_EQ(length % 4, 0u);
  }
  const auto ask = ask_link("a-name-of-15-le", 1);
  EXPECT_EQ(ask.at(32), 20u);  // 4 of head, 15 of name, 1 zero
  EXPECT_EQ(ask.back(), 0);
}

TEST(CanControl, AMissingInterfaceIsAStateWhenAskedForAndAnErrorWhenWanted) {
  const auto state = read_can_state("can77");
  ASSERT_TRUE(state) << state.error().detail;
  EXPECT_FALSE(state->exists);
  const auto brought = bring_up("can77", {.up = true});
  ASSERT_FALSE(brought);
  EXPECT_EQ(brought.error().detail, "CAN interface can77 does not exist");
}

TEST(CanControl, AnyInterfaceCanBeAskedForWithoutRights) {
  const auto state = read_can_state("lo");
  ASSERT_TRUE(state) << state.error().detail;
  EXPECT_TRUE(state->exists);
  EXPECT_FALSE(state->controller);
}

}  // namespace
}  // namespace roverd::link
