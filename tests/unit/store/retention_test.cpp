// What goes by itself: runs by age and room, events by age; and what stays.

#include <gtest/gtest.h>

#include "folder.hpp"
#include "store/database.hpp"
#include "store/migrations.hpp"

namespace roverd::store {
namespace {

using namespace std::chrono_literals;

constexpr base::WallTime kNow{1'790'000'000s};

base::Duration days(int n) {
  return std::chrono::hours(24) * n;
}

std::int64_t begin_run(Store& store) {
  StoredRun run;
  run.head.begun = kNow;
  run.head.name = "run";
  run.plan = plan_named("run");
  const auto id = answer_of<std::int64_t>([&](auto r) { store.begin_run(run, r); });
  EXPECT_TRUE(id);
  return id.value_or(0);
}

void add(Store& store, std::int64_t id, int points, std::optional<base::WallTime> ended) {
  RunBatch batch;
  batch.points.resize(static_cast<std::size_t>(points));
  for (RunPoint& p : batch.points) p.at = {58.378, 26.7289};
  if (ended) {
    batch.outcome = RunOutcome::Finished;
    batch.ended = *ended;
  }
  EXPECT_TRUE(answer_of<void>([&](auto r) { store.add_to_run(id, batch, r); }));
}

std::vector<std::int64_t> ids_in(Store& store) {
  const auto page = answer_of<Page<RunHead>>([&](auto r) { store.list_runs(1000, "", r); });
  std::vector<std::int64_t> ids;
  for (const RunHead& head : page.value().items) ids.push_back(head.id);
  std::reverse(ids.begin(), ids.end());
  return ids;
}

using Ids = std::vector<std::int64_t>;

/// What the store told; from its thread.
struct Told {
  std::mutex mutex;
  std::vector<base::Event> events;
  std::function<void(base::Event)> ear() {
    return [this](base::Event event) {
      const std::lock_guard lock(mutex);
      events.push_back(std::move(event));
    };
  }
  std::vector<base::Event> all() {
    const std::lock_guard lock(mutex);
    return events;
  }
};

/// Until the store has tidied up: it does so between calls.
template <class Done>
bool soon(Done done) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

TEST(Retention, BeyondTheRoomTheOldestRunsGoAndThatIsTold) {
  // Given five runs of 50 kB each,
  Folder folder;
  {
    auto store = open_store(folder.file());
    for (int i = 0; i < 5; ++i) add(*store, begin_run(*store), 500, kNow);
  }
  // when the next start has room for 120 kB,
  Told told;
  Options options;
  options.max_run_bytes = 120'000;
  options.clock = [] { return kNow; };
  options.tell = told.ear();
  auto store = open_store(folder.file(), options);
  // then the newest two stay, with their tracks.
  ASSERT_TRUE(soon([&] { return !told.all().empty(); }));
  EXPECT_EQ(ids_in(*store), (Ids{4, 5}));
  const auto track =
      answer_of<std::vector<RunPoint>>([&](auto r) { store->read_run_points(4, r); });
  EXPECT_EQ(track->size(), 500u);
  const auto events = told.all();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, "runs_removed");
  EXPECT_EQ(events[0].level, base::Severity::Info);
  EXPECT_EQ(events[0].detail.substr(0, 28), "3 runs, 1 to 3, were removed");
}

TEST(Retention, TheRunThatIsDrivenStaysHoweverLargeItGrows) {
  // Given room for 100 kB, looked at all the time, and an old run,
  Folder folder;
  Told told;
  Options options;
  options.max_run_bytes = 100'000;
  options.tidy_every = 5ms;
  options.tell = told.ear();
  auto store = open_store(folder.file(), options);
  add(*store, begin_run(*store), 100, kNow);
  // when the next one grows over all of it,
  const auto driven = begin_run(*store);
  for (int i = 0; i < 4; ++i) add(*store, driven, 500, std::nullopt);
  // then the old one goes, and what is driven stays whole,
  ASSERT_TRUE(soon([&] { return !told.all().empty(); }));
  EXPECT_EQ(ids_in(*store), Ids{driven});
  add(*store, driven, 1, std::nullopt);
  const auto track =
      answer_of<std::vector<RunPoint>>([&](auto r) { store->read_run_points(driven, r); });
  EXPECT_EQ(track->size(), 2001u);
  EXPECT_EQ(told.all()[0].detail.substr(0, 17), "run 1 was removed");
}

TEST(Retention, WhatARunTakesIsAboutWhatIsCounted) {
  // Given a run with a track of an hour's driving,
  Folder folder;
  {
    auto store = open_store(folder.file());
    const auto id = begin_run(*store);
    RunBatch batch;
    for (int i = 0; i < 18'000; ++i) {
      RunPoint p;
      p.t_s = 0.2 * i;
      p.at = {58.378 + 1e-6 * i, 26.7289};
      p.yaw_rad = 1.25;
      p.speed_mps = 0.8;
      p.sigma_m = 0.02;
      p.cross_m = 0.01;
      p.item = 3;
      p.power_w = 210.5;
      batch.points.push_back(p);
    }
    ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(id, batch, r); }));
  }
  // when its count is compared with the file,
  SQLite::Database db(folder.file().string());
  const double counted = db.execAndGet("SELECT bytes FROM runs").getInt();
  const double taken = static_cast<double>(std::filesystem::file_size(folder.file()));
  // then they agree within a fifth.
  EXPECT_NEAR(taken / counted, 1.0, 0.2) << taken << " bytes, counted as " << counted;
}

TEST(Retention, AgesCountOnlyWhereTheClockWasSet) {
  // Given runs that ended 40 days ago, before the clock was set, 40 days ago, and in the future,
  const auto filled = [](const Folder& folder) {
    auto store = open_store(folder.file());
    for (const base::WallTime ended : {kNow - days(40), base::WallTime{5s}, kNow - days(40),
                                       kNow + days(4000), base::WallTime{5s}}) {
      add(*store, begin_run(*store), 1, ended);
    }
  };
  Options options;
  options.keep_runs_for = days(30);
  options.tidy_every = 5ms;
  {
    // when the clock is not set, then all stay;
    Folder folder;
    filled(folder);
    options.clock = [] { return base::WallTime{1000s}; };
    auto store = open_store(folder.file(), options);
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(ids_in(*store), (Ids{1, 2, 3, 4, 5}));
  }
  // when it is, then those before the first young one go, the undated among them, too.
  Folder folder;
  filled(folder);
  options.clock = [] { return kNow; };
  auto store = open_store(folder.file(), options);
  EXPECT_TRUE(soon([&] { return ids_in(*store) == Ids{4, 5}; }));
}

TEST(Retention, OldEventsGoFromTheFrontAndIdsStay) {
  // Given events of 400 and 10 days, of a clock that was not set, and of 1 day,
  Folder folder;
  const auto filled = [&] {
    auto store = open_store(folder.file());
    for (const base::WallTime at : {base::WallTime{7s}, kNow - days(400), kNow - days(10),
                                    base::WallTime{8s}, kNow - days(1), kNow - days(399)}) {
      store->add_event({at, base::Severity::Info, "armed", "x"});
    }
    EXPECT_EQ(events(*store, 0, base::Severity::Info, 10)->items.size(), 6u);
  };
  filled();
  // when a year is kept,
  Options options;
  options.keep_events_for = days(365);
  options.clock = [] { return kNow; };
  auto store = open_store(folder.file(), options);
  // then the first two go; what stands behind a younger one stays in its order.
  const auto left = events(*store, 0, base::Severity::Info, 10);
  ASSERT_EQ(left->items.size(), 4u);
  EXPECT_EQ(left->items[0].id, 3);
  store->add_event({kNow, base::Severity::Info, "armed", "x"});
  EXPECT_EQ(events(*store, 6, base::Severity::Info, 10)->items.at(0).id, 7);
}

TEST(Retention, AnOlderDatabaseIsCountedWhenItIsUpgraded) {
  // Given a database of schema 9 with a run of 30 points and an event of 4 letters,
  Folder folder;
  {
    const auto old = open_database(folder.file(), migrations().first(9), 1'000'000'000);
    ASSERT_TRUE(old);
    SQLite::Database& c = (*old)->connection;
    c.exec(
        "INSERT INTO runs (begun_ns, ended_ns, outcome, mission_id, revision, name, vehicle, "
        "first_item, plan, parameters) VALUES (1, 2, 'finished', 'm', 1, 'n', 'bunker', 1, "
        "'{\"name\":\"n\",\"items\":[]}', '{}')");
    for (int i = 1; i <= 30; ++i) {
      c.exec("INSERT INTO run_points VALUES (1, " + std::to_string(i) +
             ", 0, 58, 26, 0, 0, 0, 0, NULL, NULL, 1, NULL, 1)");
    }
    c.exec("INSERT INTO run_events VALUES (1, 1, 0, 0, 'armed', 'text')");
  }
  // when this program opens it,
  open_store(folder.file());
  // then the run has its size: 200, the plan's 23 letters, 2, 30 points, the event.
  SQLite::Database db(folder.file().string());
  EXPECT_EQ(db.execAndGet("SELECT bytes FROM runs").getInt(), 200 + 23 + 2 + 3000 + 104);
}

TEST(Retention, ADatabaseThatCannotBeWrittenKeepsAllAndServesOn) {
  // Given two runs and a file that another program holds,
  Folder folder;
  Told told;
  Options options;
  options.tidy_every = 5ms;
  {
    auto store = open_store(folder.file());
    for (int i = 0; i < 2; ++i) add(*store, begin_run(*store), 500, kNow);
  }
  options.max_run_bytes = 60'000;
  options.tell = told.ear();
  {
    SQLite::Database other(folder.file().string(), SQLite::OPEN_READWRITE);
    other.exec("BEGIN IMMEDIATE");
    // when the store is opened with room for one,
    auto store = open_store(folder.file(), options);
    // then it answers, both are there, and nothing is told as removed;
    EXPECT_EQ(ids_in(*store), (Ids{1, 2}));
    EXPECT_TRUE(told.all().empty());
    other.exec("ROLLBACK");
    // and once it can be written, the older one goes.
    EXPECT_TRUE(soon([&] { return ids_in(*store) == Ids{2}; }));
  }
}

}  // namespace
}  // namespace roverd::store
