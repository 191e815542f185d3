#include "nav/estimate/shift_watch.hpp"

#include <gtest/gtest.h>

namespace roverd::nav {
namespace {

/// Positions five times a second that lie so far off, on a robot that drives 1 m/s.
void feed(ShiftWatch& w, double east_m, double from_s, double seconds, double grows_mps = 0.0) {
  for (double t = 0.0; t < seconds; t += 0.2) {
    const base::Time stamp{base::from_seconds(from_s + t)};
    w.take({east_m + grows_mps * t, 0.0}, true, from_s + t, stamp);
  }
}

TEST(ShiftWatch, TellsOfOneThatStaysAndOfItsSize) {
  ShiftWatch w;
  feed(w, 3.0, 100.0, 6.0);
  EXPECT_FALSE(w.shift());
  feed(w, 3.0, 106.0, 1.0);
  ASSERT_TRUE(w.shift());
  EXPECT_NEAR(w.shift()->east_m, 3.0, 1e-9);
  EXPECT_EQ(w.since(), base::Time{base::from_seconds(100.0)});
}

TEST(ShiftWatch, OneThatRunsAwayOrGoesBackIsNone) {
  ShiftWatch runs;
  feed(runs, 1.0, 100.0, 20.0, 2.0);
  EXPECT_FALSE(runs.shift());
  ShiftWatch back;
  feed(back, 3.0, 100.0, 7.0);
  back.take({0.01, 0.0}, false, 8.0, base::Time{base::from_seconds(108.0)});
  EXPECT_FALSE(back.shift());
  EXPECT_TRUE(back.agrees());
}

TEST(ShiftWatch, SmallOnesAreTheFiltersMatter) {
  ShiftWatch w;
  feed(w, 0.2, 100.0, 20.0);
  EXPECT_FALSE(w.shift());
}

}  // namespace
}  // namespace roverd::nav
