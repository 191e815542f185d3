// Simplify and densify.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/geo.hpp"
#include "mission/edit/operations.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

constexpr LatLon kField{58.378, 26.729};

/// A waypoint so many metres east and north of the field's corner.
Waypoint point(double east_m, double north_m) {
  Waypoint waypoint;
  waypoint.at = base::LocalFrame(1, kField).to_global({east_m, north_m});
  return waypoint;
}

Plan way(std::vector<Item> items) {
  Plan plan;
  plan.name = "way";
  plan.items = std::move(items);
  return plan;
}

double distance_to_m(const Plan& plan, const Item& item) {
  const base::LocalFrame frame(1, kField);
  const auto p = frame.to_local(std::get<Waypoint>(item).at);
  double least_m = 1e9;
  for (std::size_t i = 0; i + 1 < plan.items.size(); ++i) {
    const auto a = frame.to_local(std::get<Waypoint>(plan.items[i]).at);
    const auto ab = frame.to_local(std::get<Waypoint>(plan.items[i + 1]).at) - a;
    const auto ap = p - a;
    const double square = ab.east_m * ab.east_m + ab.north_m * ab.north_m;
    const double share =
        std::clamp((ap.east_m * ab.east_m + ap.north_m * ab.north_m) / square, 0.0, 1.0);
    least_m = std::min(least_m,
                       std::hypot(ap.east_m - share * ab.east_m, ap.north_m - share * ab.north_m));
  }
  return least_m;
}

TEST(Simplify, TakesOutWhatLiesWithinTheTolerance) {
  //  1 . 2(0.4 m off) . 3(2 m off) . 4
  const Plan plan = way({point(0, 0), point(10, 0.4), point(20, 2), point(30, 0)});
  EXPECT_EQ(perform(plan, Simplify{5.0, {}})->plan.items.size(), 2u);
  const auto done = perform(plan, Simplify{1.0, {}});
  EXPECT_EQ(done->plan.items, (std::vector<Item>{plan.items[0], plan.items[2], plan.items[3]}));
  EXPECT_EQ(done->what, "simplified all items within 1 m: 1 waypoint less");
  EXPECT_EQ(perform(plan, Simplify{0.1, {}})->plan, plan);
  EXPECT_EQ(perform(plan, Simplify{0.0, {}}).error().fields.at(0).pointer, "/tolerance_m");
}

TEST(Simplify, KeepsWhatMatters) {
  Waypoint holds = point(10, 0);
  holds.hold_s = 3.0;
  Waypoint slow = point(30, 0);
  slow.speed_mps = 0.2;
  // hold, speed change before 4, a speed item, and a jump's target stay
  const Plan plan = way({point(0, 0), holds, point(20, 0), slow, Speed{0.5}, point(40, 0),
                         point(50, 0), point(60, 0), point(70, 0), Jump{7, 1}});
  const auto done = perform(plan, Simplify{1.0, {}});
  ASSERT_TRUE(done);
  std::vector<Item> left = plan.items;
  left.erase(left.begin() + 7);  // (60, 0) alone is of no use
  EXPECT_EQ(done->plan.items, left);
}

TEST(Simplify, OfRandomWaysStaysWithinTheTolerance) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> step(0.0, 1.0);
    Plan plan = way({});
    double east_m = 0.0;
    double north_m = 0.0;
    for (int i = 0; i < 300; ++i) {
      plan.items.emplace_back(point(east_m += 1.0 + step(random), north_m += step(random)));
    }
    const auto done = perform(plan, Simplify{0.8, {}});
    ASSERT_TRUE(done);
    EXPECT_LT(done->plan.items.size(), plan.items.size());
    for (const Item& item : plan.items) EXPECT_LE(distance_to_m(done->plan, item), 0.8 + 1e-6);
  }
}

TEST(Densify, PutsPointsEvenlyOnTheLegs) {
  Plan plan = way({point(0, 0), Speed{0.5}, point(10, 0), point(10, 2), Jump{3, 1}});
  plan.items[2] = [] {
    Waypoint fast = point(10, 0);
    fast.speed_mps = 0.7;
    fast.hold_s = 2.0;
    return fast;
  }();
  const auto done = perform(plan, Densify{2.5, {}});
  ASSERT_TRUE(done);
  EXPECT_EQ(done->what, "densified all items to 2.5 m: 3 waypoints more");
  ASSERT_EQ(done->plan.items.size(), 8u);
  for (std::size_t i = 2; i < 5; ++i) {
    const auto& between = std::get<Waypoint>(done->plan.items[i]);
    const double east_m = 2.5 * static_cast<double>(i - 1);
    EXPECT_LT(base::distance_bearing(between.at, point(east_m, 0).at).distance_m, 1e-5);
    EXPECT_EQ(between.speed_mps, 0.7);
    EXPECT_FALSE(between.hold_s);
  }
  EXPECT_EQ(done->plan.items[7], Item(Jump{6, 1}));
}

TEST(Densify, OfRandomWaysLeavesNoLongLegAndIsUndoneBySimplify) {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-2000.0, 2000.0);
    Plan plan = way({});
    for (int i = 0; i < 10; ++i) plan.items.emplace_back(point(place(random), place(random)));
    auto done = perform(plan, Densify{7.0, {}});
    ASSERT_TRUE(done) << done.error().detail;
    for (std::size_t i = 0; i + 1 < done->plan.items.size(); ++i) {
      EXPECT_LE(base::distance_bearing(std::get<Waypoint>(done->plan.items[i]).at,
                                       std::get<Waypoint>(done->plan.items[i + 1]).at)
                    .distance_m,
                7.001);
    }
    EXPECT_NEAR(length_m(done->plan), length_m(plan), 0.001);
    EXPECT_EQ(perform(std::move(done->plan), Simplify{0.01, {}})->plan, plan) << seed;
  }
}

TEST(Densify, RefusesMoreItemsThanAMissionMayHave) {
  const Plan plan = way({point(0, 0), point(9000, 0)});
  EXPECT_EQ(perform(plan, Densify{0.01, {}}).error().fields.at(0).pointer, "/at_most_m");
  EXPECT_EQ(perform(plan, Densify{0.0, {}}).error().fields.at(0).pointer, "/at_most_m");
}

}  // namespace
}  // namespace roverd::mission
