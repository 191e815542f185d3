#include <gtest/gtest.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

using base::Severity;

base::Event event(int number, Severity level = Severity::Info) {
  return {base::WallTime(std::chrono::nanoseconds(1'700'000'000'000'000'000 + number)), level,
          "item_reached", "item " + std::to_string(number) + " was reached"};
}

TEST(Events, AreListedInTheOrderTheyCame) {
  Folder folder;
  auto store = open_store(folder.file());
  for (int i = 1; i <= 5; ++i) store->add_event(event(i));
  const auto page = events(*store, 0, Severity::Info, 10);
  ASSERT_TRUE(page);
  ASSERT_EQ(page->items.size(), 5u);
  EXPECT_FALSE(page->next_cursor);
  for (int i = 1; i <= 5; ++i) {
    const StoredEvent& e = page->items[static_cast<std::size_t>(i - 1)];
    EXPECT_EQ(e.id, i);
    EXPECT_EQ(e.event.wall, event(i).wall);
    EXPECT_EQ(e.event.kind, "item_reached");
    EXPECT_EQ(e.event.detail, event(i).detail);
  }
}

TEST(Events, AreReadOnFromTheLastSeen) {
  Folder folder;
  auto store = open_store(folder.file());
  for (int i = 1; i <= 7; ++i) store->add_event(event(i));
  const auto first = events(*store, 0, Severity::Info, 3);
  ASSERT_EQ(first->next_cursor, "3");
  const auto second = events(*store, 3, Severity::Info, 4);
  EXPECT_EQ(second->items.front().id, 4);
  EXPECT_EQ(second->items.back().id, 7);
  EXPECT_FALSE(second->next_cursor);
  EXPECT_TRUE(events(*store, 7, Severity::Info, 4)->items.empty());
}

TEST(Events, AreChosenByLeastLevel) {
  Folder folder;
  auto store = open_store(folder.file());
  store->add_event(event(1));
  store->add_event(event(2, Severity::Warning));
  store->add_event(event(3, Severity::Error));
  EXPECT_EQ(events(*store, 0, Severity::Info, 10)->items.size(), 3u);
  EXPECT_EQ(events(*store, 0, Severity::Warning, 10)->items.size(), 2u);
  const auto errors = events(*store, 0, Severity::Error, 10);
  ASSERT_EQ(errors->items.size(), 1u);
  EXPECT_EQ(errors->items[0].event.level, Severity::Error);
}

TEST(Events, BeyondTheirNumberTheOldestGoAndIdsAreNeverUsedAgain) {
  Folder folder;
  Options options;
  options.max_events = 10;
  {
    auto store = open_store(folder.file(), options);
    for (int i = 1; i <= 25; ++i) store->add_event(event(i));
    const auto page = events(*store, 0, Severity::Info, 100);
    ASSERT_EQ(page->items.size(), 10u);
    EXPECT_EQ(page->items.front().id, 16);
    EXPECT_EQ(page->items.back().id, 25);
  }
  auto store = open_store(folder.file(), options);
  store->add_event(event(26));
  EXPECT_EQ(events(*store, 25, Severity::Info, 1)->items.at(0).id, 26);
}

}  // namespace
}  // namespace roverd::store
