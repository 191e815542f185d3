#include "link/can_error.hpp"

#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "link/confirmations.hpp"
#include "tools.hpp"

namespace roverd::link {
namespace {

using namespace std::chrono_literals;

base::CanFrame error_frame(std::uint32_t id, const std::vector<std::uint8_t>& data) {
  auto frame = make_frame(id, {});
  for (const auto byte : data) frame.data[frame.len++] = byte;
  frame.error = true;
  return frame;
}

TEST(CanFaults, EveryClassOfErrorFrameHasItsWord) {
  const std::tuple<std::uint32_t, std::vector<std::uint8_t>, CanFaults> cases[] = {
      {0x001, {}, fault_bit("transmit time-out")},
      {0x002, {5}, fault_bit("arbitration lost")},
      {0x004, {0, 0x01}, fault_bit("receive buffer overflow")},
      {0x004, {0, 0x08}, fault_bit("error warning (transmitting)")},
      {0x004,
       {0, 0x30},
       fault_bit("error passive (receiving)") | fault_bit("error passive (transmitting)")},
      {0x004, {0, 0x40}, fault_bit("error active again")},
      {0x004, {0, 0x00}, fault_bit("controller fault")},
      {0x008, {0, 0, 0x02}, fault_bit("protocol error: form")},
      {0x008, {0, 0, 0x84}, fault_bit("protocol error: stuff")},
      {0x008, {0, 0, 0x00}, fault_bit("protocol error")},
      {0x010, {0, 0, 0, 0, 0x04}, fault_bit("transceiver fault")},
      {0x020, {}, fault_bit("no acknowledgement")},
      {0x040, {}, fault_bit("bus off")},
      {0x0A8,
       {0, 0, 0x01},
       fault_bit("bus error") | fault_bit("no acknowledgement") | fault_bit("protocol error: bit")},
      {0x100, {}, fault_bit("restarted")},
      {0x200, {0, 0, 0, 0, 0, 0, 3, 4}, 0},  // error counters only
      {0x000, {}, fault_bit("unknown error frame")},
      {0x10000, {}, fault_bit("unknown error frame")},
  };
  for (const auto& [id, data, faults] : cases) {
    EXPECT_EQ(faults_of(error_frame(id, data)), faults) << std::hex << id;
  }
}

TEST(Confirmations, TheOldestFrameThatWaitsIsTheOneAfterTheLastConfirmed) {
  Confirmations c;
  EXPECT_FALSE(c.oldest_waiting(base::Time(1s)));
  c.sending(base::Time(1s));
  c.sending(base::Time(2s));
  EXPECT_EQ(c.oldest_waiting(base::Time(5s)), base::Duration(4s));
  c.confirmed();
  EXPECT_EQ(c.oldest_waiting(base::Time(5s)), base::Duration(3s));
  c.confirmed();
  EXPECT_FALSE(c.oldest_waiting(base::Time(5s)));
  EXPECT_EQ(c.sent_count(), 2u);
  EXPECT_EQ(c.confirmed_count(), 2u);
}

TEST(Confirmations, AFrameThatDidNotGoOutIsNotWaitedFor) {
  Confirmations c;
  c.sending(base::Time(1s));
  c.not_sent();
  EXPECT_FALSE(c.oldest_waiting(base::Time(5s)));
}

TEST(Confirmations, WhatWasOnItsWayWhenTheBusWentIsLost) {
  Confirmations c;
  for (int i = 0; i < 3; ++i) c.sending(base::Time(1s));
  c.confirmed();
  c.forget();
  EXPECT_FALSE(c.oldest_waiting(base::Time(5s)));
  EXPECT_EQ(c.lost_count(), 2u);
  c.sending(base::Time(4s));
  EXPECT_EQ(c.oldest_waiting(base::Time(5s)), base::Duration(1s));
}

TEST(Confirmations, OfVeryManyThatWaitTheOldestRememberedCounts) {
  Confirmations c;
  for (int i = 0; i < 1000; ++i) c.sending(base::Time(std::chrono::milliseconds(i)));
  EXPECT_EQ(c.oldest_waiting(base::Time(1s)), base::Duration(256ms));
}

}  // namespace
}  // namespace roverd::link
