#pragma once
// A gate, and the frames that tests show it.

#include <cstdint>
#include <initializer_list>

#include <gtest/gtest.h>

#include "gate/gate.hpp"

namespace roverd::gate {

using namespace std::chrono_literals;

inline CanFrame frame(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame f;
  f.id = id;
  for (const int b : bytes) f.data[f.len++] = static_cast<std::uint8_t>(b);
  return f;
}

class GateTest : public ::testing::Test {
 protected:
  std::uint64_t refused(Refusal why) const {
    return gate.counts().refused[static_cast<std::size_t>(why)];
  }
  void expect_refused(const CanFrame& f, Refusal why) {
    const auto before = refused(why);
    EXPECT_FALSE(gate.allows(f, now)) << std::hex << f.id;
    EXPECT_EQ(refused(why), before + 1) << "reason " << static_cast<int>(why);
  }

  Gate gate{bunker({})};
  Time now = Time{} + 100s;
};

}  // namespace roverd::gate
