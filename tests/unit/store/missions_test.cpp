#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

using base::Code;
using namespace std::chrono_literals;

/// A clock that a test moves, and the store's own thread reads.
struct FakeClock {
  std::atomic<base::WallTime> now{
      base::WallTime{std::chrono::nanoseconds(1'700'000'000'123'456'789)}};
  Options options() {
    Options o;
    o.clock = [this] { return now.load(); };
    return o;
  }
};

TEST(Missions, AreReadBackAsTheyWereSaved) {
  Folder folder;
  auto store = open_store(folder.file());
  const mission::Plan plan = plan_named("Lower field");
  const auto made = create(*store, plan);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->revision, 1);
  EXPECT_EQ(made->plan, plan);
  EXPECT_EQ(made->id.size(), 12u);
  EXPECT_EQ(made->id.find_first_not_of("0123456789abcdefghjkmnpqrstvwxyz"), std::string::npos);
  const auto found = read(*store, made->id);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->plan, plan);
  EXPECT_EQ(found->revision, 1);
  EXPECT_EQ(found->created, made->created);
  EXPECT_EQ(found->updated, made->updated);
}

TEST(Missions, AreThereAfterTheStoreWasClosed) {
  Folder folder;
  const mission::Plan plan = plan_named("Võsu põld 1 — „lõuna“");
  std::string id;
  {
    auto store = open_store(folder.file());
    id = create(*store, plan)->id;
  }
  auto store = open_store(folder.file());
  EXPECT_EQ(read(*store, id)->plan, plan);
}

TEST(Missions, ThatDoNotExistAreNotFound) {
  Folder folder;
  auto store = open_store(folder.file());
  for (const std::string id : {"nosuchmiss10", "", "'; DROP TABLE missions; --", "\xff"}) {
    EXPECT_EQ(read(*store, id).error().code, Code::NotFound);
    EXPECT_EQ(replace(*store, id, 1, plan_named("x")).error().code, Code::NotFound);
    EXPECT_EQ(remove(*store, id, 1).error().code, Code::NotFound);
    EXPECT_EQ(revisions(*store, id, 10).error().code, Code::NotFound);
    EXPECT_EQ(revert(*store, id, 1).error().code, Code::NotFound);
  }
}

TEST(Missions, WithValuesOutOfRangeAreRefusedAndNothingIsSaved) {
  Folder folder;
  auto store = open_store(folder.file());
  mission::Plan plan = plan_named("x");
  std::get<mission::Waypoint>(plan.items[1]).at.lat = 91.0;
  const auto made = create(*store, plan);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Code::Invalid);
  EXPECT_EQ(made.error().fields.at(0).pointer, "/items/1/lat");
  EXPECT_TRUE(list(*store, 10)->items.empty());
}

TEST(Missions, AReplacementNeedsThePresentRevision) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, plan_named("one"));
  const auto second = replace(*store, made->id, 1, plan_named("two", 5));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->revision, 2);
  EXPECT_EQ(second->created, made->created);
  const auto late = replace(*store, made->id, 1, plan_named("late"));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, Code::RevisionMismatch);
  EXPECT_EQ(late.error().detail, "the mission is at revision 2, the change was made to revision 1");
  EXPECT_EQ(read(*store, made->id)->plan.name, "two");
}

TEST(Missions, OfManyWhoReplaceTheSameRevisionOneWins) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, plan_named("start"))->id;
  std::atomic<int> won{0};
  std::atomic<int> refused{0};
  std::vector<std::thread> people;
  for (int i = 0; i < 8; ++i) {
    people.emplace_back([&, i] {
      const auto r = replace(*store, id, 1, plan_named("by " + std::to_string(i)));
      if (r) {
        ++won;
      } else if (r.error().code == Code::RevisionMismatch) {
        ++refused;
      }
    });
  }
  for (auto& person : people) person.join();
  EXPECT_EQ(won, 1);
  EXPECT_EQ(refused, 7);
  EXPECT_EQ(revisions(*store, id, 10)->items.size(), 2u);
}

TEST(Missions, KeepEveryRevisionWithAuthorAndWhat) {
  Folder folder;
  FakeClock clock;
  auto store = open_store(folder.file(), clock.options());
  const auto made = create(*store, plan_named("one", 2), {"anna", "imported from basic.waypoints"});
  clock.now = clock.now.load() + 60s;
  ASSERT_TRUE(replace(*store, made->id, 1, plan_named("two", 4), {"bert", ""}));
  const auto page = revisions(*store, made->id, 10);
  ASSERT_TRUE(page);
  ASSERT_EQ(page->items.size(), 2u);
  EXPECT_FALSE(page->next_cursor);
  const RevisionSummary& newest = page->items[0];
  EXPECT_EQ(newest.revision, 2);
  EXPECT_EQ(newest.author, "bert");
  EXPECT_EQ(newest.what, "replaced");
  EXPECT_EQ(newest.name, "two");
  EXPECT_EQ(newest.items, 4);
  EXPECT_NEAR(newest.length_m, mission::length_m(plan_named("two", 4)), 1e-9);
  EXPECT_EQ(newest.time, made->created + 60s);
  EXPECT_EQ(page->items[1].what, "imported from basic.waypoints");
  EXPECT_EQ(read_at(*store, made->id, 1)->plan, plan_named("one", 2));
  EXPECT_EQ(read_at(*store, made->id, 3).error().code, Code::NotFound);
}

TEST(Missions, ARevertMakesTheOldStateANewRevision) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, plan_named("one"))->id;
  ASSERT_TRUE(replace(*store, id, 1, plan_named("two", 7)));
  const auto back = revert(*store, id, 1);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->revision, 3);
  EXPECT_EQ(back->plan, plan_named("one"));
  EXPECT_EQ(read(*store, id)->plan, plan_named("one"));
  EXPECT_EQ(revisions(*store, id, 1)->items[0].what, "reverted to 1");
  EXPECT_EQ(read_at(*store, id, 2)->plan, plan_named("two", 7));
}

TEST(Missions, ADeletedOneIsHiddenButCanBeBroughtBack) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, plan_named("precious"))->id;
  EXPECT_EQ(remove(*store, id, 2).error().code, Code::RevisionMismatch);
  ASSERT_TRUE(remove(*store, id, 1));
  EXPECT_EQ(read(*store, id).error().code, Code::NotFound);
  EXPECT_EQ(replace(*store, id, 2, plan_named("x")).error().code, Code::NotFound);
  EXPECT_EQ(remove(*store, id, 2).error().code, Code::NotFound);
  EXPECT_TRUE(list(*store, 10)->items.empty());

  const auto page = revisions(*store, id, 10);
  ASSERT_EQ(page->items.size(), 2u);
  EXPECT_TRUE(page->items[0].deletion);
  EXPECT_EQ(page->items[0].what, "deleted");
  EXPECT_EQ(page->items[0].name, "precious");
  EXPECT_EQ(read_at(*store, id, 2).error().code, Code::NotFound);
  EXPECT_EQ(revert(*store, id, 2).error().code, Code::NotFound);

  const auto back = revert(*store, id, 1);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->revision, 3);
  EXPECT_EQ(read(*store, id)->plan, plan_named("precious"));
  EXPECT_EQ(list(*store, 10)->items.size(), 1u);
}

TEST(Missions, AreListedNewestChangeFirst) {
  Folder folder;
  FakeClock clock;
  auto store = open_store(folder.file(), clock.options());
  const std::string a = create(*store, plan_named("a"))->id;
  clock.now = clock.now.load() + 1s;
  const std::string b = create(*store, plan_named("b", 5))->id;
  clock.now = clock.now.load() + 1s;
  ASSERT_TRUE(replace(*store, a, 1, plan_named("a2", 2)));
  const auto page = list(*store, 10);
  ASSERT_EQ(page->items.size(), 2u);
  EXPECT_EQ(page->items[0].id, a);
  EXPECT_EQ(page->items[0].name, "a2");
  EXPECT_EQ(page->items[0].revision, 2);
  EXPECT_EQ(page->items[0].items, 2);
  EXPECT_EQ(page->items[0].updated, clock.now.load());
  EXPECT_EQ(page->items[1].id, b);
}

TEST(Missions, PagesOf250MissWithoutGapOrRepetitionEvenAtEqualTimes) {
  Folder folder;
  FakeClock clock;
  auto store = open_store(folder.file(), clock.options());
  std::set<std::string> made;
  for (int i = 0; i < 250; ++i) {
    if (i % 10 == 0) clock.now = clock.now.load() + 1s;  // ten share one time
    made.insert(create(*store, plan_named("m" + std::to_string(i), 1))->id);
  }
  std::set<std::string> seen;
  std::string cursor;
  std::vector<std::size_t> sizes;
  base::WallTime before = base::WallTime::max();
  for (;;) {
    const auto page = list(*store, 40, cursor);
    ASSERT_TRUE(page);
    sizes.push_back(page->items.size());
    for (const auto& m : page->items) {
      EXPECT_TRUE(seen.insert(m.id).second) << m.id << " came twice";
      EXPECT_LE(m.updated, before);
      before = m.updated;
    }
    if (!page->next_cursor) break;
    cursor = *page->next_cursor;
    EXPECT_EQ(cursor.find_first_not_of("0123456789abcdefghjkmnpqrstvwxyz."), std::string::npos);
  }
  EXPECT_EQ(seen, made);
  EXPECT_EQ(sizes, (std::vector<std::size_t>{40, 40, 40, 40, 40, 40, 10}));
}

TEST(Missions, AnExactlyFullLastPageHasNoCursor) {
  Folder folder;
  auto store = open_store(folder.file());
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(create(*store, plan_named("m", 1)));
  const auto first = list(*store, 2);
  ASSERT_TRUE(first->next_cursor);
  EXPECT_FALSE(list(*store, 2, *first->next_cursor)->next_cursor);
}

TEST(Missions, RevisionsArePagedToo) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, plan_named("m"))->id;
  for (int r = 1; r < 7; ++r) ASSERT_TRUE(replace(*store, id, r, plan_named("m", r)));
  std::vector<std::int64_t> seen;
  std::string cursor;
  do {
    const auto page = revisions(*store, id, 3, cursor);
    for (const auto& r : page->items) seen.push_back(r.revision);
    cursor = page->next_cursor.value_or("");
  } while (!cursor.empty());
  EXPECT_EQ(seen, (std::vector<std::int64_t>{7, 6, 5, 4, 3, 2, 1}));
}

TEST(Missions, AStrangeCursorOrLimitIsRefused) {
  Folder folder;
  auto store = open_store(folder.file());
  const std::string id = create(*store, plan_named("m"))->id;
  for (const char* cursor : {"x", "12", "12x.abc", ".", "99999999999999999999999.a"}) {
    EXPECT_EQ(list(*store, 10, cursor).error().code, Code::Malformed) << cursor;
  }
  EXPECT_EQ(revisions(*store, id, 10, "1.5").error().code, Code::Malformed);
  for (const int limit : {0, -1, kMaxPage + 1}) {
    EXPECT_EQ(list(*store, limit).error().fields.at(0).pointer, "limit");
    EXPECT_EQ(events(*store, 0, base::Severity::Info, limit).error().code, Code::Invalid);
  }
}

TEST(DeletedMissions, AreListedAndRestored) {
  Folder folder;
  FakeClock clock;
  auto store = open_store(folder.file(), clock.options());
  const std::string id = create(*store, plan_named("lost", 4))->id;
  create(*store, plan_named("kept"));
  EXPECT_EQ(restore(*store, id).error().code, Code::Conflict);
  clock.now = clock.now.load() + 1h;
  ASSERT_TRUE(remove(*store, id, 1));
  const auto gone = list(*store, 10, "", {Which::Deleted});
  ASSERT_EQ(gone->items.size(), 1u);
  EXPECT_EQ(gone->items[0].name, "lost");
  EXPECT_EQ(gone->items[0].updated, clock.now.load());
  EXPECT_EQ(list(*store, 10)->items.size(), 1u);
  const auto back = restore(*store, id);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->revision, 3);
  EXPECT_EQ(back->plan, plan_named("lost", 4));
  EXPECT_EQ(revisions(*store, id, 10)->items[0].what, "restored");
  EXPECT_TRUE(list(*store, 10, "", {Which::Deleted})->items.empty());
  EXPECT_EQ(restore(*store, "nobody").error().code, Code::NotFound);
}

TEST(DeletedMissions, AreForgottenWhenTheirTimeIsOver) {
  Folder folder;
  FakeClock clock;
  Options options = clock.options();
  options.keep_deleted = 24h;
  std::string old, young;
  {
    auto store = open_store(folder.file(), options);
    old = create(*store, plan_named("old"))->id;
    young = create(*store, plan_named("young"))->id;
    create(*store, plan_named("present"));
    ASSERT_TRUE(remove(*store, old, 1));
    clock.now = clock.now.load() + 23h;
    ASSERT_TRUE(remove(*store, young, 1));
    EXPECT_EQ(list(*store, 10, "", {Which::Deleted})->items.size(), 2u);
  }
  clock.now = clock.now.load() + 2h;
  auto store = open_store(folder.file(), options);
  const auto gone = list(*store, 10, "", {Which::Deleted});
  ASSERT_EQ(gone->items.size(), 1u);
  EXPECT_EQ(gone->items[0].id, young);
  EXPECT_EQ(restore(*store, old).error().code, Code::NotFound);
  EXPECT_EQ(revisions(*store, old, 10).error().code, Code::NotFound);
  EXPECT_EQ(list(*store, 10)->items.size(), 1u);
  EXPECT_TRUE(restore(*store, young));
}

TEST(Missions, AreSplitInOneStepOrNotAtAll) {
  Folder folder;
  auto store = open_store(folder.file());
  const auto made = create(*store, plan_named("whole", 6));
  const auto split = [&](std::int64_t expected) {
    return answer_of<Halves>([&](auto reply) {
      store->split_mission(made->id, expected, plan_named("whole", 2), plan_named("rest", 4),
                           {"anna", "split after item 2"}, reply);
    });
  };
  EXPECT_EQ(split(7).error().code, Code::RevisionMismatch);
  EXPECT_EQ(list(*store, 10)->items.size(), 1u);
  const auto both = split(1);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->first.revision, 2);
  EXPECT_EQ(read(*store, made->id)->plan, plan_named("whole", 2));
  EXPECT_EQ(read(*store, both->rest.id)->plan, plan_named("rest", 4));
  EXPECT_EQ(revisions(*store, both->rest.id, 1)->items[0].what, "split from whole");
}

}  // namespace
}  // namespace roverd::store
