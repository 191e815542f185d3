// Revisions in few bytes: each is what was saved, whichever way it is kept.

#include "store/packed.hpp"

#include <random>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "folder.hpp"
#include "mission/json/json.hpp"
#include "store/database.hpp"

namespace roverd::store {
namespace {

mission::Plan moved(mission::Plan plan, std::size_t item) {
  std::get<mission::Waypoint>(plan.items.at(item)).at.lat += 1.23456e-5;
  return plan;
}

std::int64_t kept_bytes(const std::filesystem::path& file, const std::string& id) {
  SQLite::Database db(file.string(), SQLite::OPEN_READONLY);
  SQLite::Statement sum(db, "SELECT sum(length(packed)) FROM revisions WHERE mission_id = ?");
  sum.bind(1, id);
  sum.executeStep();
  return sum.getColumn(0).getInt64();
}

TEST(Packed, TextComesBackWithAndWithoutAPrefix) {
  const std::string text = mission::plan_to_text(plan_named("text", 500));
  const std::string other = mission::plan_to_text(moved(plan_named("text", 500), 77));

  EXPECT_EQ(unpack(pack(text)).value(), text);
  EXPECT_EQ(unpack(pack(other, text), text).value(), other);
  EXPECT_LT(pack(other, text).size(), 200u);
  EXPECT_EQ(unpack(pack("")).value(), "");
}

TEST(Packed, DamageIsRefused) {
  const std::string text = mission::plan_to_text(plan_named("text", 50));
  const std::string packed = pack(text);
  for (std::size_t i = 0; i < packed.size(); ++i) {
    std::string bad = packed;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    const auto got = unpack(bad);
    EXPECT_TRUE(!got || *got == text) << i;
  }
  EXPECT_FALSE(unpack(packed.substr(0, packed.size() / 2)));
  EXPECT_FALSE(unpack(""));
  // Without the prefix that it was made with it is no text, or, by its checksum, the right one.
  const auto other = unpack(pack(text, text), "another prefix");
  EXPECT_TRUE(!other || *other == text);
}

TEST(Packed, AHundredEditsOfAThousandItemsCostWhatTheyChange) {
  Folder folder;
  auto store = open_store(folder.file());
  std::mt19937 random(3);
  std::vector<mission::Plan> plans{plan_named("long", 1000)};
  const std::string id = create(*store, plans.front())->id;
  for (int i = 0; i < 100; ++i) {
    plans.push_back(moved(plans.back(), random() % 1000));
    ASSERT_TRUE(replace(*store, id, i + 1, plans.back()));
  }

  // Every one of them is there, also after a restart.
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < plans.size(); ++i) {
      EXPECT_EQ(read_at(*store, id, static_cast<std::int64_t>(i) + 1)->plan, plans[i]) << i;
    }
    store.reset();
    store = open_store(folder.file());
  }
  EXPECT_LT(kept_bytes(folder.file(), id) / 101, 5000);
}

TEST(Packed, RandomChangesKeepEveryRevision) {
  Folder folder;
  auto store = open_store(folder.file());
  std::mt19937 random(5);
  std::vector<mission::Plan> plans{plan_named("any", 20)};
  const std::string id = create(*store, plans.front())->id;
  for (int i = 0; i < 60; ++i) {
    mission::Plan plan = plans[random() % plans.size()];
    if (random() % 3 == 0) plan = plan_named("other " + std::to_string(i), int(random() % 200));
    if (!plan.items.empty()) plan = moved(plan, random() % plan.items.size());
    plans.push_back(plan);
    ASSERT_TRUE(replace(*store, id, i + 1, plan));
  }
  for (std::size_t i = 0; i < plans.size(); ++i) {
    EXPECT_EQ(read_at(*store, id, static_cast<std::int64_t>(i) + 1)->plan, plans[i]) << i;
  }
  ASSERT_TRUE(revert(*store, id, 7));
  EXPECT_EQ(read(*store, id)->plan, plans[6]);
}

TEST(Packed, ADatabaseOfTheFirstReleasesIsReadAndGoesOn) {
  // given a file of schema 3 with two revisions as text, and a deleted mission
  Folder folder;
  const mission::Plan first = plan_named("Põllu SERV", 30);
  const mission::Plan second = moved(first, 4);
  {
    const auto old = migrations().first(3);
    const auto db = open_database(folder.file(), old, 1'000'000'000);
    ASSERT_TRUE(db);
    SQLite::Database& c = (*db)->connection;
    c.exec("BEGIN");
    SQLite::Statement row(c, "INSERT INTO revisions VALUES (?, ?, ?, 'anna', ?, ?, 30, 1.0, ?)");
    const auto add = [&](const char* id, int revision, const std::optional<mission::Plan>& plan) {
      row.bind(1, id);
      row.bind(2, revision);
      row.bind(3, 1000 + revision);
      row.bind(4, plan ? "saved" : "deleted");
      row.bind(5, first.name);
      if (plan) row.bind(6, mission::plan_to_text(*plan));
      row.exec();
      row.reset();
      row.clearBindings();
    };
    add("old", 1, first);
    add("old", 2, second);
    add("gone", 1, first);
    add("gone", 2, std::nullopt);
    c.exec("INSERT INTO missions VALUES ('old', 2, 1, 1002, 'Põllu SERV', 30, 1.0, 0)");
    c.exec("INSERT INTO missions VALUES ('gone', 2, 1, 1002, 'Põllu SERV', 30, 1.0, 1)");
    c.exec("COMMIT");
  }

  // when this program opens it
  Options options;
  options.keep_deleted = std::chrono::hours(24 * 365 * 200);
  auto store = open_store(folder.file(), options);

  // then all of it is there, is found by name, and goes on in the new form
  EXPECT_EQ(read_at(*store, "old", 1)->plan, first);
  EXPECT_EQ(read(*store, "old")->plan, second);
  ASSERT_EQ(list(*store, 10, "", {Which::Present, "põllu serv"})->items.size(), 1u);
  const mission::Plan third = moved(second, 9);
  ASSERT_TRUE(replace(*store, "old", 2, third));
  EXPECT_EQ(read_at(*store, "old", 1)->plan, first);
  EXPECT_EQ(read_at(*store, "old", 2)->plan, second);
  EXPECT_EQ(read(*store, "old")->plan, third);
  EXPECT_LT(kept_bytes(folder.file(), "old"), 300);
  const auto history = revisions(*store, "gone", 10);
  EXPECT_TRUE(history->items.at(0).deletion);
  EXPECT_FALSE(history->items.at(1).deletion);
  EXPECT_EQ(restore(*store, "gone")->plan, first);
}

}  // namespace
}  // namespace roverd::store
