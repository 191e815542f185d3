// What a data folder may look like when roverd starts.

#include <algorithm>
#include <fstream>
#include <future>
#include <iterator>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "folder.hpp"
#include "store/database.hpp"
#include "store/migrations.hpp"
#include "store/missions.hpp"

namespace roverd::store {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// The reason why opening fails; the file itself must be as it was.
std::string refusal(const fs::path& file) {
  const bool was_there = fs::is_regular_file(file);
  const std::string before = was_there ? bytes_of(file) : "";
  const auto store = Store::open(file, at_once);
  EXPECT_FALSE(store);
  if (store) return "opened";
  EXPECT_EQ(store.error().code, base::Code::Unavailable);
  EXPECT_EQ(store.error().detail.find('\n'), std::string::npos);
  EXPECT_TRUE(!was_there || bytes_of(file) == before) << "the file was changed";
  return store.error().detail;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

int user_version(const fs::path& file) {
  SQLite::Database db(file.string(), SQLite::OPEN_READONLY);
  return db.execAndGet("PRAGMA user_version").getInt();
}

TEST(Opening, ANewFileGetsTheNewestSchema) {
  Folder folder;
  open_store(folder.file());
  EXPECT_EQ(user_version(folder.file()), migrations().back().number);
}

TEST(Opening, TheConnectionIsDurableAndStrict) {
  Folder folder;
  const auto db = open_database(folder.file(), migrations(), 1'000'000'000);
  ASSERT_TRUE(db);
  SQLite::Database& c = (*db)->connection;
  EXPECT_EQ(c.execAndGet("PRAGMA journal_mode").getString(), "wal");
  EXPECT_EQ(c.execAndGet("PRAGMA synchronous").getInt(), 2);  // FULL
  EXPECT_EQ(c.execAndGet("PRAGMA foreign_keys").getInt(), 1);
  EXPECT_EQ(c.execAndGet("SELECT count(*) FROM pragma_table_list WHERE type = 'table' AND "
                         "name NOT LIKE 'sqlite%' AND strict = 0")
                .getInt(),
            0);
  EXPECT_THROW(c.exec("INSERT INTO missions VALUES ('a', 1, 0, 0, 'x', 0, 0, 0)"),
               SQLite::Exception);  // there is no such revision
}

TEST(Opening, AListOfMissionsIsReadFromItsIndex) {
  Folder folder;
  const auto db = open_database(folder.file(), migrations(), 1'000'000'000);
  const auto how = [&](const Filter& filter) {
    SQLite::Statement plan((*db)->connection, "EXPLAIN QUERY PLAN " + list_sql(filter));
    std::string out;
    while (plan.executeStep()) out += plan.getColumn(3).getString() + '\n';
    // What is sorted is the page that was found, never the list.
    const std::size_t begin = out.find("SEARCH");
    const std::string first = out.substr(begin, out.find('(') - begin);
    EXPECT_LE(out.find("SCAN found"), out.find("B-TREE")) << out;
    return first;
  };
  EXPECT_EQ(how({}), "SEARCH m USING COVERING INDEX missions_in_use ");
  EXPECT_EQ(how({Which::Present, "north"}), "SEARCH m USING COVERING INDEX missions_in_use ");
  EXPECT_EQ(how({Which::Archived}), "SEARCH m USING COVERING INDEX missions_in_archive ");
  EXPECT_EQ(how({Which::Deleted}), "SEARCH m USING INDEX missions_by_deletion ");
  EXPECT_EQ(how({Which::Present, "", "farm"}), "SEARCH t USING PRIMARY KEY ");
}

TEST(Opening, AListOfDeletedMissionsIsReadFromItsIndex) {
  Folder folder;
  const auto db = open_database(folder.file(), migrations(), 1'000'000'000);
  SQLite::Statement plan((*db)->connection,
                         "EXPLAIN QUERY PLAN SELECT id FROM missions WHERE deleted = 1 AND "
                         "(updated_ns, id) < (?, ?) ORDER BY updated_ns DESC, id DESC LIMIT ?");
  std::string text;
  while (plan.executeStep()) text += plan.getColumn(3).getString() + "\n";
  EXPECT_TRUE(contains(text, "SEARCH missions USING COVERING INDEX missions_by_deletion") ||
              contains(text, "SEARCH missions USING INDEX missions_by_deletion"))
      << text;
  EXPECT_FALSE(contains(text, "TEMP B-TREE")) << text;
}

TEST(Opening, EveryOlderSchemaIsUpgradedWithItsData) {
  const auto all = migrations();
  for (std::size_t known = 1; known <= all.size(); ++known) {
    Folder folder;
    std::string id;
    {
      // given a database as an older program left it, with a mission of two revisions
      const auto old = open_database(folder.file(), all.first(known), 1'000'000'000);
      ASSERT_TRUE(old);
      SQLite::Database& c = (*old)->connection;
      c.exec("BEGIN");
      c.exec(
          "INSERT INTO missions (id, revision, created_ns, updated_ns, name, items, length_m) "
          "VALUES ('0123456789ab', 2, 1000, 2000, 'two', 1, 0)");
      c.exec(
          "INSERT INTO revisions (mission_id, revision, time_ns, author, what, name, items, "
          "length_m, plan) VALUES "
          "('0123456789ab', 1, 1000, 'anna', 'created', 'one', 0, 0, "
          "'{\"name\":\"one\",\"items\":[]}'),"
          "('0123456789ab', 2, 2000, 'bert', 'replaced', 'two', 1, 0, "
          "'{\"name\":\"two\",\"items\":[{\"type\":\"waypoint\",\"lat\":1,\"lon\":2}]}')");
      if (known >= 11) {
        c.exec("INSERT INTO users VALUES ('carl', 'viewer', 'hash', 1000)");
        c.exec(
            "INSERT INTO sessions (id, hash, user, device, address, created_ns, seen_ns) VALUES "
            "('s0', 'earlier', 'carl', 'phone', 'here', 1000, 1000)");
      }
      if (known >= 9) {
        c.exec(
            "INSERT INTO route_maps (id, name, created_ns, origin_lat, origin_lon, heading_deg, "
            "nodes, links) VALUES ('r0', 'yard', 1000, 58, 26, 90, 1, 0)");
        c.exec("INSERT INTO route_nodes (map, node, x_m, y_m, theta_rad) VALUES (1, 7, 2, 3, 0)");
      }
      c.exec("COMMIT");
    }
    EXPECT_EQ(user_version(folder.file()), static_cast<int>(known));
    // when this program opens it
    auto store = open_store(folder.file());
    // then everything is there and can be worked with
    EXPECT_EQ(user_version(folder.file()), all.back().number);
    const auto found = read(*store, "0123456789ab");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->revision, 2);
    EXPECT_EQ(found->plan.items.size(), 1u);
    EXPECT_EQ(read_at(*store, "0123456789ab", 1)->plan.name, "one");
    auto drawn = plan_named("three");
    drawn.drawing = {{"kind", "survey"}};
    EXPECT_TRUE(replace(*store, "0123456789ab", 2, drawn));
    EXPECT_EQ(read(*store, "0123456789ab")->plan.drawing, drawn.drawing);
    EXPECT_TRUE(read_at(*store, "0123456789ab", 2)->plan.drawing.is_null());
    const auto yard = answer_of<RouteMap>([&](auto reply) { store->read_route_map("r0", reply); });
    EXPECT_EQ(yard.has_value(), known >= 9);
    if (yard) {
      EXPECT_FALSE(yard->about.frame.map);
      EXPECT_EQ(yard->graph.nodes, (std::vector<mission::MapNode>{{7, 2.0, 3.0, 0.0}}));
    }
    store->add_event({base::WallTime{}, base::Severity::Info, "armed", "x"});
    EXPECT_EQ(events(*store, 0, base::Severity::Info, 10)->items.size(), 1u);
    const people::User anna{"anna", people::Role::Admin, "hash", {}};
    std::promise<base::Result<void>> kept;
    const people::Device phone{"d1",  "shown", "anna", "phone", people::Role::Admin,
                               "pin", 0,       {},     {}};
    const people::Session by_pin{"s1", "cookie", "anna", "phone", "here", {}, {}, "d1"};
    store->change_people(
        {.now = {.users = {anna}, .sessions = {by_pin}, .tokens = {}, .devices = {phone}}},
        [&](base::Result<void> done) { kept.set_value(std::move(done)); });
    EXPECT_TRUE(kept.get_future().get());
    std::promise<people::Everybody> read_back;
    store->read_people([&](base::Result<people::Everybody> everybody) {
      read_back.set_value(everybody.value_or(people::Everybody{}));
    });
    const auto everybody = read_back.get_future().get();
    EXPECT_EQ(everybody.devices.size(), 1u);
    EXPECT_EQ(everybody.sessions.size(), known >= 11 ? 2u : 1u);
    // A session of an earlier program was made by a password.
    EXPECT_EQ(everybody.sessions.back().paired, known >= 11 ? "" : "d1");
  }
}

TEST(Opening, AMigrationThatFailsLeavesTheOldSchema) {
  Folder folder;
  std::vector<Migration> steps(migrations().begin(), migrations().end());
  open_store(folder.file());
  const int number = steps.back().number + 1;
  steps.push_back({number, "broken", "CREATE TABLE extra (a INTEGER) STRICT; SELECT nonsense;"});
  const auto db = open_database(folder.file(), steps, 1'000'000'000);
  ASSERT_FALSE(db);
  EXPECT_TRUE(contains(db.error().detail, "nonsense")) << db.error().detail;
  EXPECT_EQ(user_version(folder.file()), number - 1);
  SQLite::Database c(folder.file().string());
  EXPECT_FALSE(c.tableExists("extra"));
}

TEST(Opening, ADatabaseOfANewerProgramIsRefused) {
  Folder folder;
  open_store(folder.file());
  const int known = migrations().back().number;
  {
    SQLite::Database c(folder.file().string(), SQLite::OPEN_READWRITE);
    c.exec("PRAGMA user_version = " + std::to_string(known + 1));
  }
  EXPECT_EQ(refusal(folder.file()), folder.file().string() + " is of schema " +
                                        std::to_string(known + 1) + ", this program knows up to " +
                                        std::to_string(known) +
                                        ": start the newer program or another data folder");
}

TEST(Opening, ADatabaseOfAnotherProgramIsRefused) {
  Folder folder;
  {
    SQLite::Database c(folder.file().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    c.exec("CREATE TABLE photos (id INTEGER)");
  }
  EXPECT_TRUE(contains(refusal(folder.file()), "is a database of another program"));
}

TEST(Opening, AFileThatIsNoDatabaseIsRefused) {
  Folder folder;
  write_bytes(folder.file(), "These are my notes.\n");
  EXPECT_EQ(refusal(folder.file()), folder.file().string() + " is not a database");
}

TEST(Opening, ADamagedFileIsRefused) {
  Folder folder;
  {
    auto store = open_store(folder.file());
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(create(*store, plan_named("m", 200)));
  }
  const std::string good = bytes_of(folder.file());
  ASSERT_GT(good.size(), 100'000u);
  std::string torn = good;
  std::fill(torn.begin() + 8192, torn.begin() + 60'000, '\xA5');
  write_bytes(folder.file(), torn);
  EXPECT_TRUE(contains(refusal(folder.file()), "damaged"));
  write_bytes(folder.file(), good.substr(0, good.size() / 2));
  EXPECT_TRUE(contains(refusal(folder.file()), "damaged"));
  write_bytes(folder.file(), good.substr(0, 50));
  EXPECT_NE(refusal(folder.file()), "opened");
}

TEST(Opening, AnEmptyFileIsANewDatabase) {
  Folder folder;
  write_bytes(folder.file(), "");
  EXPECT_TRUE(create(*open_store(folder.file()), plan_named("x")));
}

TEST(Opening, AMissingOrImpossibleFolderIsNamed) {
  Folder folder;
  EXPECT_EQ(refusal(folder.path() / "none" / "roverd.db"),
            "the data folder " + (folder.path() / "none").string() + " does not exist");
  write_bytes(folder.path() / "file", "x");
  EXPECT_TRUE(contains(refusal(folder.path() / "file" / "roverd.db"), "is not a folder"));
  EXPECT_TRUE(contains(refusal(folder.path()), "is a folder, not a database"));
}

TEST(Opening, AFolderThatCannotBeWrittenIsNamed) {
  // /proc takes no files from anybody, not even from root.
  EXPECT_TRUE(contains(refusal("/proc/roverd.db"), "cannot write into the data folder: /proc/"));
  if (::geteuid() == 0) return;  // permissions do not hold for root
  Folder folder;
  open_store(folder.file());
  fs::remove(folder.file().string() + ".lock");
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_TRUE(contains(refusal(folder.file()), "cannot write into the data folder: "))
      << refusal(folder.file());
  fs::permissions(folder.path(), fs::perms::owner_all);
  fs::permissions(folder.file(), fs::perms::owner_read);
  EXPECT_TRUE(contains(refusal(folder.file()), "may not be written"));
  fs::permissions(folder.file(), fs::perms::owner_all);
}

TEST(Opening, ASecondProgramOnTheSameFolderIsRefusedUntilTheFirstEnds) {
  Folder folder;
  auto first = open_store(folder.file());
  EXPECT_EQ(refusal(folder.file()), folder.file().string() +
                                        " is in use by another roverd (process " +
                                        std::to_string(::getpid()) + ")");
  ASSERT_TRUE(create(*first, plan_named("still works")));
  first.reset();
  EXPECT_EQ(list(*open_store(folder.file()), 10)->items.size(), 1u);
}

}  // namespace
}  // namespace roverd::store
