// Operations on the list: add, remove, clear, reverse, join, split, renumber.

#include "mission/edit/operations.hpp"

#include <gtest/gtest.h>

#include "mission/json/json.hpp"
#include "plans.hpp"

namespace roverd::mission {
namespace {

/// Waypoints 1 … n at latitudes 1, 2 …, so that an item tells where it came from.
Plan numbered(int items) {
  Plan plan;
  plan.name = "numbered";
  plan.home = Home{{58.0, 26.0}, std::nullopt};
  for (int i = 1; i <= items; ++i) plan.items.emplace_back(waypoint_at(i, 0.0));
  return plan;
}

/// "1 2 j1 4": waypoints by their latitude, jumps by their target.
std::string drawn(const Plan& plan) {
  std::string out;
  for (const Item& item : plan.items) {
    if (!out.empty()) out += ' ';
    if (const auto* jump = std::get_if<Jump>(&item)) {
      out += 'j' + std::to_string(jump->item);
    } else {
      out += std::to_string(static_cast<int>(std::get<Waypoint>(item).at.lat));
    }
  }
  return out;
}

std::string after(Plan plan, const Operation& operation) {
  const auto done = perform(std::move(plan), operation);
  return done ? drawn(done->plan) : done.error().detail;
}

Plan with_jump(int items, int place, int to) {
  Plan plan = numbered(items);
  plan.items.insert(plan.items.begin() + place - 1, Jump{to, 1});
  return plan;
}

TEST(ListOperations, OtherItemsAreNotWhatWasDrawnAndTheSameOnesAre) {
  Plan plan = numbered(3);
  plan.drawing = {{"kind", "survey"}};
  EXPECT_EQ(perform(plan, SetHome{{{59.0, 26.0}, std::nullopt}})->plan.drawing, plan.drawing);
  EXPECT_TRUE(perform(plan, Reverse{})->plan.drawing.is_null());
  EXPECT_TRUE(perform(plan, AddWaypoint{waypoint_at(9, 0), std::nullopt})->plan.drawing.is_null());
  const auto parts = split(plan, 1);
  ASSERT_TRUE(parts);
  EXPECT_TRUE(parts->first.drawing.is_null());
  EXPECT_TRUE(parts->rest.drawing.is_null());
}

TEST(ListOperations, AWaypointIsAddedAtTheEndOrAfterAnItem) {
  EXPECT_EQ(after(numbered(2), AddWaypoint{waypoint_at(9, 0), std::nullopt}), "1 2 9");
  EXPECT_EQ(after(numbered(2), AddWaypoint{waypoint_at(9, 0), 0}), "9 1 2");
  EXPECT_EQ(after(numbered(2), AddWaypoint{waypoint_at(9, 0), 1}), "1 9 2");
  EXPECT_EQ(after(Plan{"empty", {}, {}, {}}, AddWaypoint{waypoint_at(9, 0), std::nullopt}), "9");
  EXPECT_EQ(after(numbered(2), AddWaypoint{waypoint_at(9, 0), 3}),
            "after must be from 0 to 2, is 3");
  EXPECT_EQ(after(numbered(2), AddWaypoint{waypoint_at(91, 0), 1}),
            "this would make the mission impossible: the mission has 1 wrong value: /items/1/lat "
            "must be from -90 to 90, is 91");
  // A jump goes on leading to the same item.
  EXPECT_EQ(after(with_jump(3, 4, 2), AddWaypoint{waypoint_at(9, 0), 1}), "1 9 2 3 j3");
}

TEST(ListOperations, ItemsAreRemovedAndJumpsFollow) {
  EXPECT_EQ(after(numbered(3), RemoveItems{std::nullopt}), "1 2");
  EXPECT_EQ(after(numbered(5), RemoveItems{Numbers{2, 4}}), "1 5");
  EXPECT_EQ(after(with_jump(3, 4, 3), RemoveItems{Numbers{1, 1}}), "2 3 j2");
  EXPECT_EQ(after(with_jump(3, 4, 2), RemoveItems{Numbers{2, 2}}), "1 3 j2");
  // One that would lead to itself goes, too.
  const auto done = perform(with_jump(1, 2, 1), RemoveItems{Numbers{1, 1}});
  ASSERT_TRUE(done);
  EXPECT_TRUE(done->plan.items.empty());
  EXPECT_EQ(done->what, "removed item 1 and 1 jump to it");
  EXPECT_EQ(after(numbered(3), RemoveItems{Numbers{4, 4}}), "item must be from 1 to 3, is 4");
  EXPECT_EQ(after(numbered(3), RemoveItems{Numbers{3, 2}}), "last must not be less than first");
  EXPECT_EQ(after(numbered(0), RemoveItems{std::nullopt}),
            "item cannot be: the mission has no items");
}

TEST(ListOperations, ClearingKeepsHomeUnlessItIsGiven) {
  const auto kept = perform(numbered(3), Clear{});
  EXPECT_TRUE(kept->plan.items.empty());
  EXPECT_EQ(kept->plan.home, numbered(3).home);
  EXPECT_EQ(kept->what, "cleared: 3 items");
  const Home here{{1.0, 2.0}, std::nullopt};
  EXPECT_EQ(perform(numbered(3), Clear{here})->plan.home, here);
}

TEST(ListOperations, ReversingTwiceIsTheStart) {
  EXPECT_EQ(after(with_jump(3, 4, 1), Reverse{}), "j4 3 2 1");
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const Plan plan = RandomPlans(seed).next(40);
    auto there = perform(plan, Reverse{});
    ASSERT_TRUE(there) << seed << there.error().detail;
    EXPECT_EQ(perform(std::move(there->plan), Reverse{})->plan, plan) << seed;
  }
}

TEST(ListOperations, ItemsChangeTheirNumbers) {
  EXPECT_EQ(after(numbered(5), Renumber{{2, 2}, 4}), "1 3 4 2 5");
  EXPECT_EQ(after(numbered(5), Renumber{{4, 5}, 1}), "4 5 1 2 3");
  EXPECT_EQ(after(numbered(5), Renumber{{1, 2}, 4}), "3 4 5 1 2");
  EXPECT_EQ(after(with_jump(3, 4, 1), Renumber{{1, 1}, 3}), "2 3 1 j3");
  EXPECT_EQ(after(numbered(5), Renumber{{4, 5}, 5}), "to must be from 1 to 4, is 5");
}

TEST(ListOperations, WhatIsSplitCanBeJoinedAgain) {
  Plan plan = with_jump(6, 7, 5);
  const auto parts = split(plan, 3);
  ASSERT_TRUE(parts);
  EXPECT_EQ(drawn(parts->first), "1 2 3");
  EXPECT_EQ(drawn(parts->rest), "4 5 6 j2");
  EXPECT_EQ(parts->rest.name, "numbered (2)");
  EXPECT_EQ(parts->rest.home, plan.home);
  EXPECT_EQ(perform(parts->first, Join{parts->rest})->plan, plan);
  EXPECT_EQ(drawn(split(plan, 3, true)->rest), "3 4 5 6 j3");
  EXPECT_EQ(split(plan, 5).error().detail,
            "after cannot be: the jump that is item 7 leads to item 5, across the cut");
  EXPECT_EQ(split(plan, 7).error().fields.at(0).pointer, "/after");
  plan.name = std::string(199, 'x') + "\xC3\xB5";
  EXPECT_EQ(split(plan, 3)->rest.name, std::string(196, 'x') + " (2)");
}

Plan in_map(const char* map) {
  Plan plan = numbered(1);
  plan.frame = MissionMap{map};
  plan.items.emplace_back(MapPoint{.x_m = 3.0, .y_m = 4.0});
  return plan;
}

TEST(ListOperations, WhatIsSplitGoesOnCountingFromItsMap) {
  const auto parts = split(in_map("shed"), 1);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->first.frame, MissionMap{"shed"});
  EXPECT_EQ(parts->rest.frame, MissionMap{"shed"});
  EXPECT_EQ(perform(parts->first, Join{parts->rest})->plan, in_map("shed"));
}

TEST(ListOperations, OnlyMissionsOfTheSameMapAreJoined) {
  // Given a mission that counts from a map, when it is joined to one that counts from another,
  const auto refused = perform(in_map("shed"), Join{in_map("barn")});
  // then that is refused: the same metres would be other places.
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fields.at(0).pointer, "/mission_id");
  EXPECT_EQ(refused.error().detail,
            "mission_id counts from the map \"barn\", this mission from \"shed\"");
  // One that counts from none takes the other's map.
  const auto joined = perform(numbered(2), Join{in_map("barn")});
  ASSERT_TRUE(joined) << joined.error().detail;
  EXPECT_EQ(joined->plan.frame, MissionMap{"barn"});
  // Without places of it a map does not matter.
  Plan bare = numbered(2);
  bare.frame = MissionMap{"barn"};
  const auto kept = perform(in_map("shed"), Join{bare});
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->plan.frame, MissionMap{"shed"});
}

}  // namespace
}  // namespace roverd::mission
