// What is said to a u-blox receiver, and what becomes of its answers.

#include "gnss/ubx_setup.hpp"

#include <gtest/gtest.h>

#include "../ubx/frames.hpp"

namespace roverd::gnss {
namespace {

using namespace std::chrono_literals;

class UbxSetupTest : public ::testing::Test {
 protected:
  std::vector<std::uint8_t> due(bool heard = true) { return setup.due(heard, now); }
  void answer(std::string_view hex) {
    const auto frame = ubx::from_hex(hex);
    setup.add(ubx::decode(ubx::opened(frame)).message);
  }
  std::string fact(const std::string& name) const {
    const auto at = setup.facts().find(name);
    return at == setup.facts().end() ? "" : at->second;
  }
  static ubx::ValSet request_in(const std::vector<std::uint8_t>& bytes) {
    if (!ubx::is_intact(bytes)) return {};
    const auto decoded = ubx::decode(ubx::opened(bytes));
    const auto* set = std::get_if<ubx::ValSet>(&decoded.message);
    return set != nullptr ? *set : ubx::ValSet{};
  }

  base::Time now = base::Time{} + 100s;
  UbxSetup setup{{}};
};

TEST_F(UbxSetupTest, AReceiverThatSpeaksUbxIsAskedWhoItIsAndNothingMore) {
  EXPECT_TRUE(due(false).empty()) << "not before it has spoken UBX";
  EXPECT_EQ(due(), ubx::from_hex(ubx::kMonVerPoll));
  EXPECT_TRUE(due().empty()) << "waits for the answer";
  answer(ubx::kMonVerAnswer);
  EXPECT_EQ(fact("receiver"), "ZED-F9P");
  EXPECT_EQ(fact("firmware"), "HPG 1.32");
  EXPECT_EQ(fact("protocol"), "27.31");
  EXPECT_EQ(fact("hardware"), "00190000");
  EXPECT_EQ(fact("configuration"), "");
  now += 10s;
  EXPECT_TRUE(due().empty());
}

TEST_F(UbxSetupTest, IsConfiguredRequestByRequest) {
  setup = UbxSetup{{.configure = true, .keep = true, .port = UbxPort::Uart1, .rate_hz = 10.0}};
  EXPECT_EQ(due(false), ubx::from_hex(ubx::kMonVerPoll)) << "also one that speaks NMEA only";
  answer(ubx::kMonVerAnswer);
  const ubx::ValSet position = request_in(due());
  EXPECT_EQ(position.layers, 7);
  EXPECT_EQ(position.items,
            (std::vector<ubx::ValSet::Item>{{0x20910007, 1}, {0x30210001, 100}, {0x30210002, 1}}));
  answer(ubx::kAckAck);
  EXPECT_EQ(request_in(due()).items, (std::vector<ubx::ValSet::Item>{{0x20910034, 1}}));
  EXPECT_EQ(fact("configuration"), "asking for precise position");
  for (int i = 0; i < 5; ++i) {
    answer(ubx::kAckAck);
    due();
  }
  answer(ubx::kAckAck);
  EXPECT_TRUE(due().empty());
  EXPECT_EQ(fact("configuration"), "accepted");
}

TEST_F(UbxSetupTest, WhatItRefusesOrDoesNotAnswerIsNamedAndTheRestGoesOn) {
  setup = UbxSetup{{.configure = true}};
  due();
  answer(ubx::kMonVerAnswer);
  due();
  answer(ubx::kAckAck);  // position
  due();
  answer(ubx::kAckAck);  // precise position
  due();
  answer(ubx::kAckAck);  // covariance
  due();
  answer(ubx::kAckNak);  // heading
  due();
  answer(ubx::kAckAck);  // satellites
  const auto corrections = due();
  EXPECT_EQ(request_in(corrections).items, (std::vector<ubx::ValSet::Item>{{0x10770004, 1}}));
  for (int i = 0; i < 2; ++i) {
    now += 999ms;
    EXPECT_TRUE(due().empty());
    now += 1ms;
    EXPECT_EQ(due(), corrections) << "again";
  }
  now += 1s;
  EXPECT_EQ(request_in(due()).items, (std::vector<ubx::ValSet::Item>{{0x20110021, 4}}));
  answer(ubx::kAckAck);
  EXPECT_EQ(fact("configuration"), "heading refused, corrections without answer");
}

TEST_F(UbxSetupTest, AnAnswerThatNobodyWaitsForChangesNothing) {
  setup = UbxSetup{{.configure = true}};
  answer(ubx::kAckNak);
  due();
  answer(ubx::kAckNak);
  EXPECT_EQ(fact("configuration"), "") << "it is still asked who it is";
  answer(ubx::kMonVerAnswer);
  EXPECT_EQ(fact("configuration"), "asking for position");
}

TEST_F(UbxSetupTest, AReopenedPortIsToldAnew) {
  due();
  answer(ubx::kMonVerAnswer);
  setup.begin();
  EXPECT_TRUE(setup.facts().empty());
  EXPECT_EQ(due(), ubx::from_hex(ubx::kMonVerPoll));
}

}  // namespace
}  // namespace roverd::gnss
