// Missions that change while they are driven.

#include <algorithm>

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;
using mission::AtEnd;

// 1 ──▶ 2 ─ ─▶ 3: the third is added while the robot drives to the second.
TEST(Executor, AddedItemsAreDrivenAfterTheOthersWithoutAStop) {
  for (const double after_s : {1.0, 4.0, 9.0}) {
    SCOPED_TRACE(after_s);
    Ride r;
    r.load(plan({at(0, 0), at(3, 0), at(8, 0)}));
    r.start();
    r.run(after_s);
    ASSERT_TRUE(r.executor.running());
    const double speed_mps = r.vehicle.speed_mps;
    ASSERT_GT(speed_mps, 0.1);
    const double before_m = r.executor.progress(r.vehicle.at).distance_left_m.value();
    r.extend(plan({at(0, 0), at(3, 0), at(8, 0), at(8, 4)}));
    EXPECT_NEAR(r.executor.progress(r.vehicle.at).distance_left_m.value(), before_m + 4.0, 0.3);
    double slowest_mps = speed_mps;
    for (int i = 0; i < 25; ++i) {
      r.tick();
      slowest_mps = std::min(slowest_mps, r.vehicle.speed_mps);
    }
    EXPECT_GT(slowest_mps, 0.8 * speed_mps);
    ASSERT_TRUE(r.run(60.0));
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
    EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3, 4}));
    EXPECT_LT(base::distance_m(r.vehicle.at, {8, 4}), 0.1);
  }
}

TEST(Executor, AddedItemsKeepThePlaceOfAPausedAndOfAnInterruptedDrive) {
  for (const bool pauses : {true, false}) {
    Ride r;
    r.load(plan({at(0, 0), at(10, 0)}));
    r.start();
    ASSERT_FALSE(r.run(8.0));
    const EnuPoint place = r.vehicle.at;
    if (pauses) r.executor.pause("test");
    if (!pauses) r.executor.interrupt();
    r.extend(plan({at(0, 0), at(10, 0), at(10, 5)}));
    r.vehicle.at = {place.east_m + 1.0, 3.0};  // led away meanwhile
    if (pauses) {
      ASSERT_TRUE(r.executor.resume(r.vehicle.at));
    } else {
      r.executor.go_on(r.vehicle.at);
    }
    double nearest_m = 1e9;
    for (int i = 0; i < 5000 && r.executor.running(); ++i) {
      r.tick();
      nearest_m = std::min(nearest_m, base::distance_m(r.vehicle.at, place));
    }
    EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
    EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3}));
    EXPECT_LT(nearest_m, 0.3);
  }
}

TEST(Executor, ItemsAddedOnTheWayBackShiftIt) {
  Ride r;
  r.load(plan({at(0, 0), at(4, 0), at(4, 4)}, AtEnd::BackAndForth));
  r.start();
  ASSERT_FALSE(r.run(22.0));
  ASSERT_EQ(r.laps, 1);
  r.reached.clear();
  const int next = r.executor.progress(r.vehicle.at).current_item.value();
  r.extend(plan({at(0, 0), at(4, 0), at(4, 4), at(8, 4)}, AtEnd::BackAndForth));
  EXPECT_EQ(r.executor.progress(r.vehicle.at).current_item, next);
  ASSERT_FALSE(r.run(60.0));
  ASSERT_GT(r.reached.size(), 4u);
  EXPECT_EQ(r.reached[0], next);
  EXPECT_NE(std::find(r.reached.begin(), r.reached.end(), 4), r.reached.end());
}

TEST(Executor, AnItemThatIsDroppedIsNotDrivenToAndTheNextOneIs) {
  Ride r;
  r.load(plan({at(0, 0), at(5, 0), at(5, 5), at(0, 5)}));
  r.start();
  ASSERT_FALSE(r.run(4.0));
  ASSERT_EQ(r.executor.progress(r.vehicle.at).current_item, 2);
  r.drop(plan({at(0, 0), at(5, 5), at(0, 5)}), 2);
  EXPECT_TRUE(r.executor.running());
  EXPECT_EQ(r.executor.progress(r.vehicle.at).current_item, 2);
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2, 3}));
  EXPECT_LT(base::distance_m(r.vehicle.at, {0, 5}), 0.1);
}

TEST(Executor, WithoutItsLastItemTheMissionIsFinished) {
  Ride r;
  r.load(plan({at(0, 0), at(9, 0)}));
  r.start();
  ASSERT_FALSE(r.run(4.0));
  r.drop(plan({at(0, 0)}), 2);
  ASSERT_TRUE(r.run(1.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
}

}  // namespace
}  // namespace roverd::nav
