// What counts as arrived, and what is told of a place that was missed.

#include <gtest/gtest.h>

#include "ride.hpp"

namespace roverd::nav {
namespace {

using base::ExecutionState;

/// Along the path it is there; to the side it is not.
void slide_aside_at_the_end(Ride& r, double aside_m) {
  while (r.executor.running() && r.executor.phase() != TrackPhase::Stop) r.tick();
  ASSERT_TRUE(r.executor.running());
  r.vehicle.at.north_m += aside_m;
}

TEST(Arrival, BesideThePlaceTheMissionIsBlockedAndGoesOnWithTheSameItem) {
  Ride r;
  r.load(plan({at(4, 0), at(8, 0)}));
  r.start({StartAt::From::Item, 2});
  slide_aside_at_the_end(r, 2.3);
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Blocked);
  EXPECT_EQ(r.executor.reason(), "item 2 missed by 2.3 m; at most 0.5 m count");
  EXPECT_TRUE(r.reached.empty());
  EXPECT_EQ(r.executor.progress(r.vehicle.at).current_item, 2);
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_EQ(r.reached, (std::vector<int>{2}));
  EXPECT_LT(base::distance_m(r.vehicle.at, {8, 0}), 0.1);
}

TEST(Arrival, OnTheMissionsOwnPathItIsBlockedLikewiseAndDrivesBackToTheEnd) {
  Ride r;
  r.load(plan({at(0, 0), at(8, 0)}));
  r.start();
  slide_aside_at_the_end(r, -1.5);
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.reason(), "item 2 missed by 1.5 m; at most 0.5 m count");
  EXPECT_EQ(r.reached, (std::vector<int>{1}));
  ASSERT_TRUE(r.executor.resume(r.vehicle.at));
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  EXPECT_EQ(r.reached, (std::vector<int>{1, 2}));
}

TEST(Arrival, WithinTheItemsRadiusItIsReached) {
  Ride r;
  mission::Waypoint wide = at(8, 0);
  wide.radius_m = 3.0;
  r.load(plan({wide}));
  r.start();
  slide_aside_at_the_end(r, 2.3);
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
}

TEST(Arrival, HomeCanBeMissedToo) {
  Ride r;
  r.home = EnuPoint{8, 0};
  r.load(plan({at(0, 0), mission::ReturnHome{}}));
  r.start();
  slide_aside_at_the_end(r, 1.0);
  ASSERT_TRUE(r.run(5.0));
  EXPECT_EQ(r.executor.reason(), "home missed by 1.0 m; at most 0.5 m count");
  EXPECT_EQ(r.reached, (std::vector<int>{1}));
}

TEST(Arrival, APlaceOnTheWayThatWasPassedFarBesideIsToldAsMissed) {
  Ride r;
  r.load(plan({at(0, 0), at(5, 0), at(6, 0), at(16, 0)}));
  r.start();
  while (r.executor.running() && r.vehicle.at.east_m < 4.8) r.tick();
  r.vehicle.at.north_m += 1.5;
  ASSERT_TRUE(r.run(60.0));
  EXPECT_EQ(r.executor.state(), ExecutionState::Finished);
  ASSERT_FALSE(r.missed.empty());
  EXPECT_EQ(r.missed.front(), 2);
  EXPECT_EQ(r.reached.back(), 4);
}

}  // namespace
}  // namespace roverd::nav
