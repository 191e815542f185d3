// Where the ground gave way: kept, merged, bounded.

#include <future>

#include <gtest/gtest.h>

#include "folder.hpp"
#include "store/database.hpp"
#include "store/migrations.hpp"

namespace roverd::store {
namespace {

constexpr base::LatLon kField{58.378, 26.729};

base::WallTime at_s(int seconds) {
  return base::WallTime(std::chrono::seconds(1'780'000'000 + seconds));
}

Slip slip(double north_m, int seconds, SlipKind kind = SlipKind::Slip, double percent = 30.0) {
  return {0, base::destination(kField, 0.0, north_m), at_s(seconds), kind, percent, 1};
}

void note(Store& store, const Slip& s) {
  std::promise<bool> done;
  store.note_slip(s, [&done](base::Result<void> r) { done.set_value(r.has_value()); });
  ASSERT_TRUE(done.get_future().get());
}

base::Result<Page<Slip>> slips(Store& store, const SlipFilter& filter = {}, int limit = 100,
                               const std::string& cursor = {}) {
  std::promise<base::Result<Page<Slip>>> page;
  store.list_slips(filter, limit, cursor, [&page](auto r) { page.set_value(std::move(r)); });
  return page.get_future().get();
}

TEST(Slips, WhatIsWithinTwoMetresOfAKnownPlaceIsThatPlaceAgain) {
  Folder folder;
  {
    auto store = open_store(folder.file());
    note(*store, slip(0.0, 1, SlipKind::Slip, 30.0));
    note(*store, slip(1.9, 2, SlipKind::Slip, 45.0));
    note(*store, slip(2.2, 3, SlipKind::Slip, 20.0));
    note(*store, slip(0.5, 4, SlipKind::Dug, 100.0));
  }
  // They outlive the program.
  auto store = open_store(folder.file());
  const auto page = slips(*store);
  ASSERT_TRUE(page);
  ASSERT_EQ(page->items.size(), 3u);
  EXPECT_EQ(page->items[0].kind, SlipKind::Dug);
  EXPECT_EQ(page->items[1].time, at_s(3));
  EXPECT_EQ(page->items[2].time, at_s(2));
  EXPECT_EQ(page->items[2].times, 2);
  EXPECT_DOUBLE_EQ(page->items[2].percent, 45.0);
  EXPECT_NEAR(base::distance_bearing(page->items[2].at, kField).distance_m, 0.0, 1e-6);
}

TEST(Slips, TheNewestThousandStay) {
  Folder folder;
  auto store = open_store(folder.file());
  for (int i = 0; i < 1010; ++i) note(*store, slip(5.0 * i, i));
  int count = 0;
  std::string cursor;
  base::WallTime last = at_s(100'000);
  for (bool more = true; more;) {
    const auto page = slips(*store, {}, 300, cursor);
    ASSERT_TRUE(page);
    for (const Slip& s : page->items) {
      EXPECT_LT(s.time, last);
      last = s.time;
      ++count;
    }
    more = page->next_cursor.has_value();
    cursor = page->next_cursor.value_or("");
  }
  EXPECT_EQ(count, 1000);
  EXPECT_EQ(last, at_s(10));
  std::promise<bool> gone;
  store->clear_slips([&gone](base::Result<void> r) { gone.set_value(r.has_value()); });
  ASSERT_TRUE(gone.get_future().get());
  EXPECT_TRUE(slips(*store)->items.empty());
}

TEST(Slips, AreChosenByTimeAndPlace) {
  Folder folder;
  auto store = open_store(folder.file());
  note(*store, slip(0.0, 1));
  note(*store, slip(50.0, 2));
  Slip fiji = slip(0.0, 3);
  fiji.at = {-17.0, 179.9};
  note(*store, fiji);
  EXPECT_EQ(slips(*store, {.since = at_s(1), .box = {}})->items.size(), 2u);
  const Box here{26.7, 58.3779, 26.8, 58.3781};
  ASSERT_EQ(slips(*store, {.since = {}, .box = here})->items.size(), 1u);
  EXPECT_EQ(slips(*store, {.since = {}, .box = here})->items[0].time, at_s(1));
  const Box across{179.0, -20.0, -179.0, 0.0};
  EXPECT_EQ(slips(*store, {.since = {}, .box = across})->items.size(), 1u);
  EXPECT_EQ(slips(*store, {}, 10, "nonsense").error().code, base::Code::Malformed);
  EXPECT_EQ(slips(*store, {}, 10, "12.").error().code, base::Code::Malformed);
}

TEST(Slips, ADatabaseOfAnOlderProgramLearnsToKeepThem) {
  Folder folder;
  ASSERT_TRUE(open_database(folder.file(), migrations().first(13), 1'000'000'000));
  auto store = open_store(folder.file());
  note(*store, slip(0.0, 1));
  EXPECT_EQ(slips(*store)->items.size(), 1u);
}

}  // namespace
}  // namespace roverd::store
