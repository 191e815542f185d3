// Hundreds of random worlds: every answer is judged, and the share of the solvable that are solved.
#include <gtest/gtest.h>

#include "cars.hpp"
#include "worlds.hpp"

namespace roverd::nav::around {
namespace {

using tests::along_x;
using tests::objection;
using tests::Scene;

constexpr std::uint64_t kWorlds = 400;
constexpr std::array<double, 5> kHalves{1.5, 2.0, 3.0, 5.0, 10.0};
constexpr std::array<int, 5> kThings{1, 3, 8, 16, 30};

TEST(AroundRandomTest, WhatCanBePassedIsPassedByNearlyTheShortestWay) {
  Planner planner;
  Answer a;
  tests::Reference reference(Question{}.body, 0.3);
  int solvable = 0;
  int solved = 0;
  int near = 0;
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    Scene s;
    const double half = kHalves[seed % 5];
    tests::strew(s, seed, kThings[(seed / 5) % 5], half);
    Question q = along_x(half);
    q.rejoin_within_m = 8.0;
    ASSERT_TRUE(planner.plan(s.patch, q, a));
    EXPECT_EQ(objection(s.patch, q, a), "") << "seed " << seed;
    const double shortest = reference.shortest_m(s, half);
    if (!std::isfinite(shortest) || a.found == Found::Clear) continue;
    ++solvable;
    if (a.found != Found::Way) continue;
    ++solved;
    const double ratio = (a.length_m + tests::kGoal_m + 2.0 - a.rejoin_m) / shortest;
    worst = std::max(worst, ratio);
    if (ratio <= 1.25) ++near;
  }
  std::printf("%d solvable, %d solved, %d within 1.25, worst %.3f\n", solvable, solved, near,
              worst);
  EXPECT_GE(solvable, 200);
  EXPECT_GE(solved, 0.98 * solvable);
  EXPECT_EQ(near, solved);
}

//   A car seldom joins its route within such a window: to drive on to the window's end counts.
TEST(AroundRandomTest, ACarPassesWhatACarCanPassByNearlyTheShortestWay) {
  Planner planner;
  Answer a;
  tests::CarReference reference(tests::car_along_x().body, 4.0, 0.3);
  int solvable = 0;
  int solved = 0;
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    Scene s;
    const double half = kHalves[seed % 5] + 1.0;
    tests::strew(s, seed, kThings[(seed / 5) % 5], half);
    const Question q = tests::car_along_x(half);
    if (tests::clearance_of(s.patch, q.body, q.pose) < 0.05) continue;  // it stands in something
    ASSERT_TRUE(planner.plan(s.patch, q, a));
    // About the start it may be as near as it stands.
    EXPECT_EQ(objection(s.patch, q, a, 1.5), "") << "seed " << seed;
    if (a.found == Found::Clear) continue;
    const double shortest = reference.shortest_m(s, half);
    if (!std::isfinite(shortest)) continue;
    ++solvable;
    if (a.found == Found::None) continue;
    ++solved;
    const bool joins = a.found == Found::Way;
    const double rest = joins ? tests::CarReference::kGoal_m - (a.rejoin_m - q.here_m) : 0.0;
    worst = std::max(worst, (a.length_m + std::max(0.0, rest)) / shortest);
  }
  std::printf("cars: %d solvable, %d solved, longest %.3f\n", solvable, solved, worst);
  EXPECT_GE(solvable, 5);
  EXPECT_GE(solved, 0.98 * solvable);
  EXPECT_LE(worst, 1.25);
}

}  // namespace
}  // namespace roverd::nav::around
