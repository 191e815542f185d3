// Many missions: found by name and tag, put into the archive, copied.

#include <set>

#include <gtest/gtest.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

std::vector<std::string> names(const base::Result<Page<MissionSummary>>& page) {
  std::vector<std::string> out;
  for (const auto& mission : page.value().items) out.push_back(mission.name);
  return out;
}

using Names = std::vector<std::string>;

TEST(Order, MissionsAreFoundByAPartOfTheirNameInAnyCase) {
  Folder folder;
  auto store = open_store(folder.file());
  for (const char* name : {"North field", "Õunaaed", "northern 100% edge", "yard"}) {
    ASSERT_TRUE(create(*store, plan_named(name)));
  }

  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "NORTH"})),
            (Names{"northern 100% edge", "North field"}));
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "õuna"})), Names{"Õunaaed"});
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "0%"})), Names{"northern 100% edge"});
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "no such"})), Names{});
}

TEST(Order, TagsAreARevisionLikeAnyOther) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, plan_named("field"));
  ASSERT_TRUE(create(*store, plan_named("other")));

  const auto tagged = describe(*store, made->id, {{}, Names{"mow", "farm/north", "mow"}, {}}, 1);

  ASSERT_TRUE(tagged) << tagged.error().detail;
  EXPECT_EQ(tagged->revision, 2);
  EXPECT_EQ(tagged->tags, (Names{"farm/north", "mow"}));
  EXPECT_EQ(tagged->plan, made->plan);
  EXPECT_EQ(revisions(*store, made->id, 1)->items.at(0).what, "tagged farm/north mow");
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "", "mow"})), Names{"field"});
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "FIE", "mow"})), Names{"field"});
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "x", "mow"})), Names{});
  // They stay with the mission, whatever else changes, and go with it.
  ASSERT_TRUE(replace(*store, made->id, 2, plan_named("renamed")));
  EXPECT_EQ(read(*store, made->id)->tags, (Names{"farm/north", "mow"}));
  EXPECT_EQ(list(*store, 10)->items.at(0).tags, (Names{"farm/north", "mow"}));
  ASSERT_TRUE(remove(*store, made->id, 3));
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "", "mow"})), Names{});
  ASSERT_TRUE(restore(*store, made->id, 4));
  EXPECT_EQ(names(list(*store, 10, "", {Which::Present, "", "mow"})), Names{"renamed"});
}

TEST(Order, TagsAreListedWithTheirNumbers) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto tags = [&](int limit, const std::string& cursor = "") {
    return answer_of<Page<TagCount>>([&](auto reply) { store->list_tags(limit, cursor, reply); });
  };
  EXPECT_TRUE(tags(10)->items.empty());
  const auto tagged = [&](const char* name, Names with) {
    const std::string id = create(*store, plan_named(name))->id;
    EXPECT_TRUE(describe(*store, id, {{}, std::move(with), {}}));
    return id;
  };
  tagged("one", {"mow", "north"});
  const std::string two = tagged("two", {"mow", "ämber"});
  const std::string three = tagged("three", {"gone"});
  ASSERT_TRUE(describe(*store, two, {{}, {}, true}));
  ASSERT_TRUE(remove(*store, three, kAnyRevision));

  const auto first = tags(2);
  ASSERT_TRUE(first) << first.error().detail;
  ASSERT_EQ(first->items.size(), 2u);
  EXPECT_EQ(first->items[0].tag, "mow");
  EXPECT_EQ(first->items[0].missions, 1);
  EXPECT_EQ(first->items[0].archived, 1);
  EXPECT_EQ(first->items[1].tag, "north");
  ASSERT_TRUE(first->next_cursor);
  const auto rest = tags(2, *first->next_cursor);
  ASSERT_EQ(rest->items.size(), 1u);
  EXPECT_EQ(rest->items[0].tag, "ämber");
  EXPECT_EQ(rest->items[0].missions, 0);
  EXPECT_EQ(rest->items[0].archived, 1);
  EXPECT_FALSE(rest->next_cursor);
  EXPECT_EQ(tags(0).error().code, base::Code::Invalid);
  // It comes back with its mission.
  ASSERT_TRUE(restore(*store, three));
  EXPECT_EQ(tags(10)->items[0].tag, "gone");
}

TEST(Order, TheArchiveHidesWhatIsNotNeeded) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, plan_named("old"));
  ASSERT_TRUE(create(*store, plan_named("new")));

  ASSERT_TRUE(describe(*store, made->id, {{}, {}, true}));

  EXPECT_EQ(names(list(*store, 10)), Names{"new"});
  EXPECT_EQ(names(list(*store, 10, "", {Which::Archived})), Names{"old"});
  EXPECT_TRUE(read(*store, made->id)->archived);
  EXPECT_EQ(describe(*store, made->id, {{}, {}, true})->revision, 2);  // it is so already
  ASSERT_TRUE(describe(*store, made->id, {"fresh", {}, false}));
  EXPECT_EQ(names(list(*store, 10)), (Names{"fresh", "new"}));
  EXPECT_EQ(revisions(*store, made->id, 1)->items.at(0).what,
            "renamed to fresh, taken out of the archive");
}

TEST(Order, WhatCannotBeATagIsRefused) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, plan_named("field"))->id;
  const auto pointer = [&](Description d) {
    return describe(*store, id, std::move(d)).error().fields.at(0).pointer;
  };

  EXPECT_EQ(pointer({{}, Names{"good", " "}, {}}), "/tags/1");
  EXPECT_EQ(pointer({{}, Names{std::string(61, 'x')}, {}}), "/tags/0");
  EXPECT_EQ(pointer({{}, Names(21, "x"), {}}), "/tags");
  EXPECT_EQ(pointer({"", {}, {}}), "/name");
  EXPECT_EQ(describe(*store, id, {"x", {}, {}}, 7).error().code, base::Code::RevisionMismatch);
  EXPECT_EQ(read(*store, id)->revision, 1);
}

TEST(Order, ACopyIsAMissionOfItsOwn) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, plan_named("field"));
  ASSERT_TRUE(describe(*store, made->id, {{}, Names{"mow"}, {}}));

  const auto one = copy(*store, made->id);
  const auto other = copy(*store, made->id, "south");

  EXPECT_EQ(one->plan.name, "field (copy)");
  EXPECT_EQ(one->plan.items, made->plan.items);
  EXPECT_EQ(one->tags, Names{"mow"});
  EXPECT_EQ(one->revision, 1);
  EXPECT_EQ(other->plan.name, "south");
  EXPECT_NE(one->id, other->id);
  EXPECT_EQ(copy(*store, "none").error().code, base::Code::NotFound);
}

TEST(Order, ChangesToAnotherStateAreRefused) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, plan_named("field"));
  ASSERT_TRUE(replace(*store, made->id, 1, plan_named("two")));

  EXPECT_EQ(revert(*store, made->id, 1, 1).error().code, base::Code::RevisionMismatch);
  ASSERT_TRUE(revert(*store, made->id, 1, 2));
  ASSERT_TRUE(remove(*store, made->id, 3));
  EXPECT_EQ(restore(*store, made->id, 3).error().code, base::Code::RevisionMismatch);
  EXPECT_EQ(restore(*store, made->id, 4)->revision, 5);
}

}  // namespace
}  // namespace roverd::store
