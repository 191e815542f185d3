#include "gate/command_box.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace roverd::gate {
namespace {

using base::Time;
using std::chrono::milliseconds;

TEST(CommandBox, OldDisabledOrNotFiniteIsAStop) {
  CommandBox box;
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{0.5, -0.25}, true}, Time{});
  EXPECT_EQ(box.take(Time{milliseconds(250)}, 0.25), (base::BodyTwist{0.5, -0.25}));
  EXPECT_FALSE(box.take(Time{milliseconds(251)}, 0.25));
  box.put({{0.5, 0.0}, false}, Time{});
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{std::nan(""), 0.0}, true}, Time{});
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{0.5, std::nan("")}, true}, Time{});
  EXPECT_FALSE(box.take(Time{}, 0.25));
  box.put({{0.5, 0.0}, true}, Time{});
  box.clear();
  EXPECT_FALSE(box.take(Time{}, 0.25));
}

TEST(Eased, GrowsByAStepAndSlowsDownAtOnce) {
  EXPECT_DOUBLE_EQ(eased(0.0, 1.0, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(eased(0.5, 1.0, 0.25), 0.75);
  EXPECT_DOUBLE_EQ(eased(-0.5, -1.0, 0.25), -0.75);
  EXPECT_DOUBLE_EQ(eased(0.9, 1.0, 0.25), 1.0);
  EXPECT_DOUBLE_EQ(eased(0.04, 0.05, 0.005), 0.045);
  EXPECT_DOUBLE_EQ(eased(1.0, 0.1, 0.25), 0.1);
  // A reversal begins at zero.
  EXPECT_DOUBLE_EQ(eased(1.0, -1.0, 0.25), -0.25);
}

}  // namespace
}  // namespace roverd::gate
