// Fences by revision, one of them active.

#include <gtest/gtest.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

using base::Code;
using base::Result;
using Active = std::optional<StoredFence>;

mission::Fence fence_named(const std::string& name, double radius_m = 50.0) {
  return {name,
          {{mission::AreaKind::Inclusion, mission::FenceCircle{{58.0, 26.0}, radius_m}}},
          {{{58.0, 26.0}, 60.0}}};
}

Result<StoredFence> create(Store& s, mission::Fence fence) {
  return answer_of<StoredFence>([&](auto reply) { s.create_fence(fence, {"anna", ""}, reply); });
}
Result<StoredFence> read_fence(Store& s, const std::string& id) {
  return answer_of<StoredFence>([&](auto reply) { s.read_fence(id, reply); });
}
Result<StoredFence> replace(Store& s, const std::string& id, std::int64_t expected,
                            mission::Fence fence) {
  return answer_of<StoredFence>([&](auto reply) {
    s.replace_fence(id, expected, fence, {"anna", ""}, reply);
  });
}
Result<void> remove_fence(Store& s, const std::string& id, std::int64_t expected) {
  return answer_of<void>([&](auto reply) { s.delete_fence(id, expected, {"anna", ""}, reply); });
}
Result<Active> activate(Store& s, std::optional<std::string> id) {
  return answer_of<Active>([&](auto reply) { s.activate_fence(id, reply); });
}
Result<Active> active(Store& s) {
  return answer_of<Active>([&](auto reply) { s.read_active_fence(reply); });
}

TEST(Fences, EveryChangeIsARevision) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, fence_named("field"));
  ASSERT_TRUE(made) << made.error().detail;

  ASSERT_TRUE(replace(*store, made->id, 1, fence_named("field", 60.0)));
  EXPECT_EQ(replace(*store, made->id, 1, fence_named("x")).error().code, Code::RevisionMismatch);

  EXPECT_EQ(read_fence(*store, made->id)->fence, fence_named("field", 60.0));
  const auto old =
      answer_of<StoredFence>([&](auto reply) { store->read_fence_revision(made->id, 1, reply); });
  EXPECT_EQ(old->fence, fence_named("field"));
  ASSERT_TRUE(remove_fence(*store, made->id, 2));
  EXPECT_EQ(read_fence(*store, made->id).error().code, Code::NotFound);
  const auto back = answer_of<StoredFence>([&](auto reply) {
    store->revert_fence(made->id, 3, 1, {"anna", ""}, reply);
  });
  EXPECT_EQ(back->revision, 4);
  EXPECT_EQ(read_fence(*store, made->id)->fence, fence_named("field"));
  const auto history = answer_of<Page<RevisionSummary>>(
      [&](auto reply) { store->list_fence_revisions(made->id, 10, "", reply); });
  ASSERT_EQ(history->items.size(), 4u);
  EXPECT_EQ(history->items[0].what, "reverted to 1");
  EXPECT_TRUE(history->items[1].deletion);
  EXPECT_EQ(history->items[3].author, "anna");
}

TEST(Fences, AChangeThatSparesTheActiveOneIsRefusedThere) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, fence_named("field"))->id;
  const Change sparing{"anna", "", true};
  const auto replaced = [&](std::int64_t expected) {
    return answer_of<StoredFence>([&](auto reply) {
      store->replace_fence(id, expected, fence_named("field", 60.0), sparing, reply);
    });
  };
  // Given a fence that is not active, it may be changed;
  ASSERT_TRUE(replaced(1));
  // when it is active, neither way is open, and it stays as it was.
  ASSERT_TRUE(activate(*store, id));
  EXPECT_EQ(replaced(2).error().code, Code::Conflict);
  const auto reverted =
      answer_of<StoredFence>([&](auto reply) { store->revert_fence(id, 2, 1, sparing, reply); });
  EXPECT_EQ(reverted.error().code, Code::Conflict);
  EXPECT_EQ(read_fence(*store, id)->revision, 2);
  EXPECT_EQ(read_fence(*store, id)->fence, fence_named("field", 60.0));
}

TEST(Fences, OneIsActiveAlsoAfterARestart) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string one = create(*store, fence_named("one"))->id;
  const std::string two = create(*store, fence_named("two"))->id;
  EXPECT_FALSE(active(*store)->has_value());

  ASSERT_TRUE(activate(*store, one));
  EXPECT_EQ(activate(*store, two).value()->id, two);
  EXPECT_EQ(activate(*store, "nobody").error().code, Code::NotFound);

  store.reset();
  store = open_store(folder.file());
  EXPECT_EQ(active(*store).value()->fence.name, "two");
  EXPECT_EQ(remove_fence(*store, two, 1).error().code, Code::Conflict);
  ASSERT_TRUE(remove_fence(*store, one, 1));
  EXPECT_FALSE(activate(*store, std::nullopt)->has_value());
  EXPECT_TRUE(remove_fence(*store, two, 1));
}

TEST(Fences, WhatCannotBeIsNotStored) {
  Folder folder;
  auto store = open_store(folder.file());

  EXPECT_EQ(create(*store, fence_named("bad", -1.0)).error().fields.at(0).pointer,
            "/areas/0/circle/radius_m");

  const auto page =
      answer_of<Page<FenceSummary>>([&](auto reply) { store->list_fences(10, "", reply); });
  EXPECT_TRUE(page->items.empty());
}

}  // namespace
}  // namespace roverd::store
