// Runs, the place of the mission in hand, and kept parameters.

#include <gtest/gtest.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

std::unique_ptr<Store> open(const Folder& folder, std::int64_t keep = 1000) {
  Options options;
  options.keep_runs = keep;
  auto store = Store::open(folder.file(), at_once, options);
  EXPECT_TRUE(store) << store.error().detail;
  return std::move(*store);
}

StoredRun some_run(const std::string& name) {
  StoredRun run;
  run.head.begun = base::WallTime{std::chrono::seconds(1'780'000'000)};
  run.head.mission_id = "m1";
  run.head.revision = 3;
  run.head.name = name;
  run.head.vehicle = "bunker";
  run.head.first_item = 2;
  run.plan = plan_named(name);
  run.parameters = {{"nav.speed.max_mps", 0.7}, {"radio.swa_up", std::string("arm")}};
  return run;
}

std::int64_t begun(Store& store, const std::string& name) {
  const auto id = answer_of<std::int64_t>([&](auto r) { store.begin_run(some_run(name), r); });
  EXPECT_TRUE(id) << id.error().detail;
  return id.value_or(0);
}

RunBatch batch(int from, int points) {
  RunBatch b;
  for (int i = from; i < from + points; ++i) {
    RunPoint p;
    p.t_s = 0.2 * i;
    p.at = {58.378 + 1e-6 * i, 26.7289};
    p.yaw_rad = 1.25;
    p.speed_mps = 0.8;
    if (i % 2 == 0) p.cross_m = -0.01;
    p.item = 1 + i / 10;
    p.by_itself = i % 7 != 0;
    b.points.push_back(p);
  }
  b.events.push_back({base::WallTime{std::chrono::seconds(1'780'000'001)}, base::Severity::Warning,
                      "item_missed", "item 1 missed"});
  return b;
}

TEST(Runs, AreReadBackAsTheyWereDriven) {
  Folder folder;
  auto store = open(folder);
  const auto id = begun(*store, "field");
  ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(id, batch(0, 10), r); }));
  RunBatch last = batch(10, 5);
  last.outcome = RunOutcome::Finished;
  last.ended = base::WallTime{std::chrono::seconds(1'780'000'100)};
  ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(id, last, r); }));
  const auto run = answer_of<StoredRun>([&](auto r) { store->read_run(id, r); });
  ASSERT_TRUE(run) << run.error().detail;
  EXPECT_EQ(run->head.outcome, RunOutcome::Finished);
  EXPECT_EQ(run->head.first_item, 2);
  EXPECT_EQ(run->plan, plan_named("field"));
  ASSERT_EQ(run->parameters.size(), 2u);
  EXPECT_EQ(std::get<double>(run->parameters[0].value), 0.7);
  EXPECT_EQ(run->events.size(), 2u);
  const auto points =
      answer_of<std::vector<RunPoint>>([&](auto r) { store->read_run_points(id, r); });
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), 15u);
  EXPECT_NEAR((*points)[12].t_s, 2.4, 1e-9);
  EXPECT_EQ((*points)[12].at.lat, 58.378 + 12e-6);
  EXPECT_EQ((*points)[12].cross_m, -0.01);
  EXPECT_FALSE((*points)[13].cross_m);
  EXPECT_EQ((*points)[14].item, 2);
  EXPECT_FALSE((*points)[14].by_itself);
  // The same without a store, while it is open.
  const auto other = read_run(folder.file(), id);
  ASSERT_TRUE(other) << other.error().detail;
  EXPECT_EQ(other->points.size(), 15u);
  EXPECT_EQ(read_run(folder.file(), 99).error().code, base::Code::NotFound);
  EXPECT_EQ(read_run(folder.file("none.db"), 1).error().code, base::Code::NotFound);
}

TEST(Runs, OneIsForgottenWithAllItHasButNotWhileItIsDriven) {
  // Given a run that ended and one that is being driven,
  Folder folder;
  auto store = open(folder);
  const auto ended = begun(*store, "ended");
  RunBatch last = batch(0, 10);
  last.outcome = RunOutcome::Finished;
  last.ended = base::WallTime{std::chrono::seconds(1'780'000'100)};
  ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(ended, last, r); }));
  const auto driven = begun(*store, "driven");
  // when both are deleted,
  const auto forget = [&](std::int64_t id) {
    return answer_of<void>([&](auto r) { store->delete_run(id, r); });
  };
  EXPECT_TRUE(forget(ended));
  const auto refused = forget(driven);
  // then the first is gone for good, and the second goes on.
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  EXPECT_EQ(refused.error().detail, "run " + std::to_string(driven) + " is being driven");
  EXPECT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(driven, batch(0, 1), r); }));
  EXPECT_EQ(forget(ended).error().code, base::Code::NotFound);
  EXPECT_EQ(read_run(folder.file(), ended).error().code, base::Code::NotFound);
  EXPECT_EQ(read_run(folder.file(), driven)->points.size(), 1u);
}

TEST(Runs, OlderThanTheirDaysAreForgottenAtTheNextStart) {
  // Given runs that ended 100 and 9 days before now,
  const base::WallTime now{std::chrono::seconds(1'790'000'000)};
  const auto days = [](int n) { return std::chrono::hours(24) * n; };
  Folder folder;
  std::vector<std::int64_t> ids;
  {
    auto store = open(folder);
    for (const int age : {100, 9}) {
      ids.push_back(begun(*store, "run"));
      RunBatch last;
      last.outcome = RunOutcome::Finished;
      last.ended = now - days(age);
      ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(ids.back(), last, r); }));
    }
  }
  // when the program starts with ten days to keep,
  Options options;
  options.keep_runs_for = days(10);
  options.clock = [now] { return now; };
  auto store = Store::open(folder.file(), at_once, options);
  ASSERT_TRUE(store);
  // then the younger one is left.
  const auto left = answer_of<Page<RunHead>>([&](auto r) { (*store)->list_runs(10, "", r); });
  ASSERT_EQ(left->items.size(), 1u);
  EXPECT_EQ(left->items[0].id, ids[1]);
}

TEST(Runs, OneThatWasCutOffIsInterruptedWithItsLastPoint) {
  Folder folder;
  std::int64_t id = 0;
  {
    auto store = open(folder);
    id = begun(*store, "field");
    ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(id, batch(0, 11), r); }));
  }
  auto store = open(folder);
  const auto run = answer_of<StoredRun>([&](auto r) { store->read_run(id, r); });
  ASSERT_TRUE(run);
  EXPECT_EQ(run->head.outcome, RunOutcome::Interrupted);
  ASSERT_TRUE(run->head.ended);
  EXPECT_NEAR(base::seconds(*run->head.ended - run->head.begun), 2.0, 1e-6);
}

TEST(Runs, TheNewestAreKeptAndListedInPages) {
  Folder folder;
  auto store = open(folder, 3);
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    const auto id = begun(*store, name);
    ASSERT_TRUE(answer_of<void>([&](auto r) { store->add_to_run(id, batch(0, 3), r); }));
  }
  const auto first = answer_of<Page<RunHead>>([&](auto r) { store->list_runs(2, "", r); });
  ASSERT_TRUE(first);
  ASSERT_EQ(first->items.size(), 2u);
  EXPECT_EQ(first->items[0].name, "e");
  ASSERT_TRUE(first->next_cursor);
  const auto rest =
      answer_of<Page<RunHead>>([&](auto r) { store->list_runs(2, *first->next_cursor, r); });
  ASSERT_EQ(rest->items.size(), 1u);
  EXPECT_EQ(rest->items[0].name, "c");
  EXPECT_FALSE(rest->next_cursor);
  const auto gone = answer_of<std::vector<RunPoint>>([&](auto r) { store->read_run_points(1, r); });
  EXPECT_EQ(gone.error().code, base::Code::NotFound);
  const auto late = answer_of<void>([&](auto r) { store->add_to_run(1, batch(0, 1), r); });
  EXPECT_EQ(late.error().code, base::Code::NotFound);
  const auto bad = answer_of<Page<RunHead>>([&](auto r) { store->list_runs(2, "x", r); });
  EXPECT_EQ(bad.error().code, base::Code::Malformed);
}

TEST(Runs, ThePlaceOfTheMissionInHandSurvives) {
  Folder folder;
  StoredPlace place;
  place.time = base::WallTime{std::chrono::seconds(1'780'000'000)};
  place.mission_id = "m1";
  place.revision = 2;
  place.name = "field";
  place.item = 3;
  place.items = 5;
  place.place = {true, 4, 2, 17.25, 1.5, -0.5, {2, -1, 1}};
  {
    auto store = open(folder);
    const auto none = answer_of<std::optional<StoredPlace>>([&](auto r) { store->read_place(r); });
    ASSERT_TRUE(none);
    EXPECT_FALSE(*none);
    ASSERT_TRUE(answer_of<void>([&](auto r) { store->keep_place(place, r); }));
    ASSERT_TRUE(answer_of<void>([&](auto r) { store->keep_place(place, r); }));
  }
  auto store = open(folder);
  const auto kept = answer_of<std::optional<StoredPlace>>([&](auto r) { store->read_place(r); });
  ASSERT_TRUE(kept && *kept);
  EXPECT_EQ((*kept)->place, place.place);
  EXPECT_EQ((*kept)->revision, 2);
  EXPECT_EQ((*kept)->item, 3);
  ASSERT_TRUE(answer_of<void>([&](auto r) { store->keep_place(std::nullopt, r); }));
  const auto gone = answer_of<std::optional<StoredPlace>>([&](auto r) { store->read_place(r); });
  EXPECT_FALSE(*gone);
}

TEST(Runs, KeptParametersAreReadBeforeTheStoreOpens) {
  Folder folder;
  EXPECT_TRUE(read_parameters(folder.file()).empty());
  {
    auto store = open(folder);
    const auto keep = [&](const char* name, base::ParamValue value) {
      return answer_of<void>([&](auto r) { store->keep_parameter({name, value}, r); }).has_value();
    };
    EXPECT_TRUE(keep("nav.speed.max_mps", 0.5));
    EXPECT_TRUE(keep("nav.speed.max_mps", 0.6));
    EXPECT_TRUE(keep("robot.safety.radio_required", false));
    EXPECT_EQ(read_parameters(folder.file()).size(), 2u);  // also while it is open
  }
  const auto kept = read_parameters(folder.file());
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(std::get<double>(kept[0].value), 0.6);
  EXPECT_EQ(std::get<bool>(kept[1].value), false);
}

}  // namespace
}  // namespace roverd::store
