// A mission and what stands on its way: what lies ahead, and how it goes on behind.

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

/// Eastwards: item 1 after 4 m, item 2 after 12 m; it stands 2 m after its start.
Ride on_the_way(const std::string& unreachable = "stop") {
  Ride r;
  r.behave.unreachable = unreachable;
  r.executor = Executor{r.path, r.behave};
  r.load(plan({at(0, 0), at(4, 0), at(12, 0)}));
  r.start();
  while (r.vehicle.at.east_m < 2.0) r.tick();
  r.executor.interrupt();
  return r;
}

TEST(Bypass, TheWayAheadEndsAtTheNextItemThatMustBeComeTo) {
  Ride r = on_the_way();
  const auto ahead = r.executor.ahead(r.vehicle.at, 10.0);
  ASSERT_TRUE(ahead);
  EXPECT_TRUE(ahead->at_end);
  EXPECT_EQ(ahead->item, 2);
  EXPECT_NEAR(ahead->from_m, 2.0, 0.1);
  EXPECT_NEAR(ahead->way.front().east_m, 2.0, 0.1);
  EXPECT_NEAR(ahead->way.back().east_m, 4.0, 0.01);
  for (std::size_t i = 1; i < ahead->way.size(); ++i) {
    EXPECT_LE(base::distance_m(ahead->way[i - 1], ahead->way[i]), WayAhead::kStep_m + 1e-9);
  }
  // No farther than asked for.
  const auto near = r.executor.ahead(r.vehicle.at, 1.0);
  ASSERT_TRUE(near);
  EXPECT_FALSE(near->at_end);
  EXPECT_EQ(near->item, 0);
  EXPECT_NEAR(near->way.back().east_m, near->way.front().east_m + 1.0, 1e-6);
}

TEST(Bypass, ItemsThatMayBeLeftOutDoNotEndIt) {
  Ride r = on_the_way("skip");
  const auto ahead = r.executor.ahead(r.vehicle.at, 20.0);
  ASSERT_TRUE(ahead);
  EXPECT_TRUE(ahead->at_end);  // the mission's end: it stops there
  EXPECT_NEAR(ahead->way.back().east_m, 12.0, 0.01);
}

TEST(Bypass, WhatWasDrivenAroundIsToldAsLeftOutAndTheRestIsDriven) {
  Ride r = on_the_way("skip");
  // When it has driven around what stood from 3 to 6 m, and stands on its way again,
  r.vehicle.at = {6.0, 0.05};
  r.executor.bypass(3.0, 6.0, r.vehicle.at);
  EXPECT_TRUE(r.executor.running());
  ASSERT_TRUE(r.run(40.0));
  // then the item in between is missed, and not reached, and the last one is driven to.
  EXPECT_EQ(r.missed, std::vector<int>{2});
  EXPECT_EQ(r.reached, (std::vector<int>{1, 3}));
  EXPECT_EQ(r.executor.state(), base::ExecutionState::Finished);
  EXPECT_NEAR(r.vehicle.at.east_m, 12.0, 0.1);
}

TEST(Bypass, NothingLiesAheadOfAMissionThatDoesNotRun) {
  Ride r = on_the_way();
  r.executor.pause("somebody said so");
  EXPECT_FALSE(r.executor.ahead(r.vehicle.at, 10.0));
  r.executor.bypass(3.0, 6.0, r.vehicle.at);
  EXPECT_EQ(r.executor.state(), base::ExecutionState::Paused);
}

TEST(Bypass, AWayBackwardsIsNotGoneAround) {
  Ride r;
  auto back = at(-8, 0);
  back.reverse = true;
  r.load(plan({at(0, 0), back}));
  r.start();
  while (r.vehicle.at.east_m > -2.0) r.tick();
  EXPECT_FALSE(r.executor.ahead(r.vehicle.at, 10.0));
}

}  // namespace
}  // namespace roverd::nav
