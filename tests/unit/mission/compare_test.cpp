// What changed between two plans.

#include "mission/edit/compare.hpp"

#include <gtest/gtest.h>

#include "mission/edit/operations.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

Plan plan_of(std::vector<Item> items) {
  Plan plan;
  plan.name = "compared";
  plan.items = std::move(items);
  return plan;
}

/// "+2 -1 3~4": added as 2, removed 1, 3 became 4.
std::string signs(const Differences& differences) {
  std::string out;
  for (const ItemDifference& d : differences.items) {
    if (!out.empty()) out += ' ';
    switch (d.change) {
      case ItemChange::Added:
        out += '+' + std::to_string(*d.now);
        break;
      case ItemChange::Removed:
        out += '-' + std::to_string(*d.before);
        break;
      case ItemChange::Changed:
        out += std::to_string(*d.before) + '~' + std::to_string(*d.now);
        break;
    }
  }
  return out;
}

TEST(Compare, NamesWhatWasAddedRemovedAndChanged) {
  const Item a = waypoint_at(1, 0), b = waypoint_at(2, 0), c = waypoint_at(3, 0), d = Wait{1};
  EXPECT_EQ(signs(compare(plan_of({a, b, c}), plan_of({a, b, c}))), "");
  EXPECT_EQ(signs(compare(plan_of({a, b, c}), plan_of({a, d, b, c}))), "+2");
  EXPECT_EQ(signs(compare(plan_of({a, b, c, d}), plan_of({b, d}))), "-1 -3");
  EXPECT_EQ(signs(compare(plan_of({a, b, c}), plan_of({a, d, c}))), "2~2");
  EXPECT_EQ(signs(compare(plan_of({}), plan_of({a, b}))), "+1 +2");
  const auto moved = compare(plan_of({a, b}), plan_of({a, waypoint_at(2.00001, 0)}));
  ASSERT_EQ(moved.items.size(), 1u);
  EXPECT_NEAR(*moved.items[0].moved_m, 1.106, 0.001);
  EXPECT_EQ(moved.changed, 1u);
  EXPECT_EQ(moved.unchanged, 1u);
}

TEST(Compare, NamesNameHomeAndSettings) {
  Plan before = plan_of({});
  Plan now = before;
  now.name = "other";
  now.home = Home{{1, 2}, std::nullopt};
  EXPECT_TRUE(compare(before, now).name);
  EXPECT_TRUE(compare(before, now).home);
  now.frame = MissionMap{"shed"};
  EXPECT_TRUE(compare(before, now).frame);
  EXPECT_FALSE(compare(before, now).settings);
}

TEST(Compare, CountsEveryItemOnce) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    RandomPlans plans(seed);
    const Plan before = plans.next_simple(60);
    Plan now = before;
    now.items.erase(now.items.begin() + 10, now.items.begin() + 14);
    now.items.insert(now.items.begin() + 30, waypoint_at(1, 2));
    const auto d = compare(before, now);
    EXPECT_EQ(d.unchanged + d.removed + d.changed, before.items.size());
    EXPECT_EQ(d.unchanged + d.added + d.changed, now.items.size());
    EXPECT_LE(d.items.size(), 5u);
  }
}

TEST(Compare, OfLargePlansThatDifferEverywhereIsBounded) {
  std::vector<Item> a, b;
  for (int i = 0; i < 20'000; ++i) {
    a.emplace_back(waypoint_at(i * 1e-5, 0));
    b.emplace_back(waypoint_at(i * 1e-5, 1));
  }
  const auto d = compare(plan_of(std::move(a)), plan_of(std::move(b)));
  EXPECT_EQ(d.changed, 20'000u);
  EXPECT_EQ(d.items.size(), kMaxDifferences);
}

}  // namespace
}  // namespace roverd::mission
