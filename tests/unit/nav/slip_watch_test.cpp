#include "nav/estimate/slip_watch.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

void feed(SlipWatch& w, double along, double aside, int fixes) {
  for (int i = 0; i < fixes; ++i) w.take(along, aside, 0.2);
}

TEST(SlipWatch, AFirmFloorStaysAtItsLowestLevel) {
  SlipWatch w;
  feed(w, 0.35, 0.35, 100);
  EXPECT_DOUBLE_EQ(w.along(), 1.0);
  EXPECT_DOUBLE_EQ(w.aside(), 1.0);
}

TEST(SlipWatch, RisesWithinSomeFixesOnTheAxisThatGaveWay) {
  SlipWatch w;
  feed(w, 6.0, 0.35, 5);
  EXPECT_GT(w.along(), 10.0);
  EXPECT_DOUBLE_EQ(w.aside(), 1.0);
}

TEST(SlipWatch, FallsWithinAMinuteOnceTheGroundHolds) {
  SlipWatch w;
  w.burst();
  const double loose = w.along();
  feed(w, 0.2, 0.2, 75);
  EXPECT_LT(w.along(), 0.2 * loose);
  feed(w, 0.2, 0.2, 225);
  EXPECT_DOUBLE_EQ(w.along(), 1.0);
}

TEST(SlipWatch, OneOutlierAndNonsenseDoNotRunAway) {
  SlipWatch w;
  w.take(1e9, std::numeric_limits<double>::quiet_NaN(), 0.2);
  EXPECT_LT(w.along(), 4.0);
  EXPECT_DOUBLE_EQ(w.aside(), 1.0);
  feed(w, 1e9, 1e9, 1000);
  EXPECT_DOUBLE_EQ(w.along(), SlipWatch::kMostAlong);
  EXPECT_DOUBLE_EQ(w.aside(), SlipWatch::kMostAside);
}

}  // namespace
}  // namespace roverd::nav
