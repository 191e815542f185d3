// Copies of the database in use, and what becomes of a damaged one.

#include "store/backups.hpp"

#include <algorithm>
#include <fstream>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include "folder.hpp"

namespace roverd::store {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path().filename());
  std::sort(out.begin(), out.end());
  return out;
}

void overwrite_with_noise(const fs::path& file, std::streamoff from) {
  std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
  out.seekp(from);
  for (int i = 0; i < 40'000; ++i) out.put(static_cast<char>(i * 31));
}

TEST(Backups, ACopyOfADatabaseInUseIsWholeAndHasWhatWasSaved) {
  // Given a store in use, with a mission that is in its log alone,
  Folder folder;
  const auto store = open_store(folder.file());
  const auto saved = create(*store, noisy_plan("saved", 2000));
  // when it is backed up and goes on,
  const auto backup = back_up(folder.file(), 7);
  ASSERT_TRUE(backup) << backup.error().detail;
  EXPECT_EQ(backup->filename(), "roverd-000001.db");
  const auto later = create(*store, plan_named("later"));
  // then the copy opens by itself and has the first alone.
  const auto copy = open_store(*backup);
  EXPECT_EQ(read(*copy, saved->id)->plan, saved->plan);
  EXPECT_FALSE(read(*copy, later->id));
}

TEST(Backups, OneMoreDescriptorIsHeldForAllOfThem) {
  // SQLite must not close what the first copy read while the store holds its locks (POSIX drops
  // them all with any descriptor of the file): it keeps it for the next one. Given a first backup,
  Folder folder;
  const auto store = open_store(folder.file());
  ASSERT_TRUE(create(*store, plan_named("saved")));
  const auto held = [] {
    const fs::directory_iterator all("/proc/self/fd");
    return std::distance(fs::begin(all), fs::end(all));
  };
  const auto before = held();
  ASSERT_TRUE(back_up(folder.file(), 3));
  const auto after_one = held();
  EXPECT_LE(after_one, before + 1);
  // when more are made, then no more are held.
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(back_up(folder.file(), 3));
  EXPECT_EQ(held(), after_one);
}

TEST(Backups, OneTakesLittleMemory) {
  // Given a database of some megabytes,
  Folder folder;
  {
    const auto store = open_store(folder.file());
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(create(*store, noisy_plan("large", 20'000)));
  }
  ASSERT_GT(fs::file_size(folder.file()), 3'000'000u);
  // when it is backed up, then SQLite takes less than two for it: its caches and a row.
  const auto before = sqlite3_memory_used();
  sqlite3_memory_highwater(1);
  ASSERT_TRUE(back_up(folder.file(), 3));
  EXPECT_LT(sqlite3_memory_highwater(0) - before, 2'000'000);
}

TEST(Backups, TheNewestAreKept) {
  Folder folder;
  const auto store = open_store(folder.file());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(back_up(folder.file(), 3));
  EXPECT_EQ(names_in(backup_folder(folder.file())),
            (std::vector<std::string>{"roverd-000003.db", "roverd-000004.db", "roverd-000005.db"}));
}

TEST(Backups, WithoutADatabaseThereIsNone) {
  Folder folder;
  EXPECT_EQ(back_up(folder.file(), 3).error().code, base::Code::Unavailable);
  EXPECT_TRUE(names_in(backup_folder(folder.file())).empty());
}

TEST(Backups, WhatIsNotFinishedNeverCounts) {
  // Given what a backup that was killed has left,
  Folder folder;
  const auto store = open_store(folder.file());
  const auto saved = create(*store, plan_named("saved"));
  fs::create_directories(backup_folder(folder.file()));
  for (const char* name : {"unfinished", "unfinished-wal"}) {
    std::ofstream(backup_folder(folder.file()) / name) << "half";
  }
  // when the program starts anew, then it goes; and when it is not even gone,
  drop_unfinished(folder.file());
  EXPECT_TRUE(names_in(backup_folder(folder.file())).empty());
  std::ofstream(backup_folder(folder.file()) / "unfinished") << "half";
  // then the next one takes its place.
  const auto made = back_up(folder.file(), 3);
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(names_in(backup_folder(folder.file())), std::vector<std::string>{"roverd-000001.db"});
  EXPECT_EQ(read(*open_store(*made), saved->id)->plan, saved->plan);
}

TEST(Backups, OneAtATime) {
  // Given one that is being made by somebody else,
  Folder folder;
  const auto store = open_store(folder.file());
  const fs::path backups = backup_folder(folder.file());
  fs::create_directories(backups);
  std::ofstream(backups / "unfinished") << "half";
  const int theirs = ::open(backups.c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(theirs, LOCK_EX | LOCK_NB), 0);
  // when another one is wanted, then it is refused, and the file of the first is left alone.
  const auto made = back_up(folder.file(), 3);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().detail, "another backup is being made");
  drop_unfinished(folder.file());
  EXPECT_EQ(names_in(backups), std::vector<std::string>{"unfinished"});
  ::close(theirs);
  EXPECT_TRUE(back_up(folder.file(), 3));
}

TEST(Backups, ADamagedDatabaseGivesNone) {
  Folder folder;
  {
    const auto store = open_store(folder.file());
    ASSERT_TRUE(create(*store, noisy_plan("kept", 3000)));
    ASSERT_TRUE(back_up(folder.file(), 1));
  }
  overwrite_with_noise(folder.file(), 4096);
  EXPECT_FALSE(back_up(folder.file(), 1));
  EXPECT_EQ(names_in(backup_folder(folder.file())), std::vector<std::string>{"roverd-000001.db"});
}

TEST(Backups, ACopyThatIsNotWholeGivesNone) {
  // Given a table that holds what its own words forbid: copied as it is, and found by the check
  Folder folder;
  {
    SQLite::Database db(folder.file(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    db.exec("CREATE TABLE t (a)");
    db.exec("INSERT INTO t VALUES (NULL)");
    db.exec("PRAGMA writable_schema = ON");
    db.exec("UPDATE sqlite_schema SET sql = 'CREATE TABLE t (a NOT NULL)'");
  }
  const auto made = back_up(folder.file(), 1);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().detail.find("NULL value in t.a"), std::string::npos)
      << made.error().detail;
  EXPECT_TRUE(names_in(backup_folder(folder.file())).empty());
}

TEST(Backups, TheFirstComesWhenTheNewestIsOldEnough) {
  using namespace std::chrono_literals;
  const BackupOptions daily{.keep = 7, .period = 24h, .first = 10min};
  Folder folder;
  const auto store = open_store(folder.file());
  // Without one: soon.
  EXPECT_EQ(first_backup_in(folder.file(), daily), daily.first);
  const auto newest = back_up(folder.file(), 7);
  ASSERT_TRUE(newest);
  const auto made_before = [&](std::chrono::hours age) {
    fs::last_write_time(*newest, fs::file_time_type::clock::now() - age);
    return first_backup_in(folder.file(), daily);
  };
  // With one of today: in what is left of the day, to the second.
  EXPECT_GT(made_before(20h), 4h - 10s);
  EXPECT_LE(made_before(20h), 4h);
  // With an old one, or one of the future: soon.
  EXPECT_EQ(made_before(25h), daily.first);
  EXPECT_EQ(made_before(-3h), daily.first);
}

TEST(Rescue, AWholeDatabaseIsLeftAlone) {
  Folder folder;
  EXPECT_FALSE(rescue(folder.file()));  // there is none
  open_store(folder.file());
  EXPECT_FALSE(rescue(folder.file()));
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"roverd.db", "roverd.db.lock"}));
}

TEST(Rescue, ADamagedOneIsSetAsideAndTheNewestWholeBackupTakesItsPlace) {
  // Given a mission in two backups, the newer of which is damaged, and a damaged database,
  Folder folder;
  std::string id;
  {
    const auto store = open_store(folder.file());
    id = create(*store, noisy_plan("kept", 3000))->id;
    ASSERT_TRUE(back_up(folder.file(), 7));
    const auto second = back_up(folder.file(), 7);
    overwrite_with_noise(*second, 4096);
  }
  overwrite_with_noise(folder.file(), 4096);
  ASSERT_FALSE(Store::open(folder.file(), at_once));
  // when it is rescued,
  const auto told = rescue(folder.file());
  // then the older backup is in use, nothing was thrown away, and it is said.
  ASSERT_TRUE(told);
  EXPECT_NE(told->find("roverd.db.damaged-1"), std::string::npos) << *told;
  EXPECT_NE(told->find("roverd-000001.db"), std::string::npos) << *told;
  EXPECT_EQ(told->find('\n'), std::string::npos);
  EXPECT_TRUE(fs::exists(folder.file("roverd.db.damaged-1")));
  EXPECT_EQ(read(*open_store(folder.file()), id)->plan.name, "kept");
}

TEST(Rescue, WithoutABackupTheStoreBeginsEmpty) {
  for (const std::string damage :
       {"not a database at all, but long enough to be looked at", "zeros"}) {
    Folder folder;
    if (damage == "zeros") {  // what a power cut leaves of a file on some file systems
      std::ofstream(folder.file(), std::ios::binary) << std::string(8192, '\0');
    } else {
      std::ofstream(folder.file()) << damage;
    }
    const auto told = rescue(folder.file());
    ASSERT_TRUE(told) << damage;
    EXPECT_NE(told->find("there is no backup"), std::string::npos) << *told;
    EXPECT_TRUE(list(*open_store(folder.file()), 10)->items.empty());
    EXPECT_TRUE(fs::exists(folder.file("roverd.db.damaged-1")));
  }
}

TEST(Rescue, TheSecondDamagedOneDoesNotReplaceTheFirst) {
  Folder folder;
  for (int i = 1; i <= 2; ++i) {
    std::ofstream(folder.file()) << "damaged, the " << i
                                 << ". time, and long enough to be seen as such";
    ASSERT_TRUE(rescue(folder.file()));
    EXPECT_TRUE(fs::exists(folder.file("roverd.db.damaged-" + std::to_string(i))));
  }
}

TEST(Rescue, WhatIsInUseOrOfAnotherProgramIsLeftAlone) {
  Folder folder;
  const auto store = open_store(folder.file());
  overwrite_with_noise(folder.file(), 4096);
  EXPECT_FALSE(rescue(folder.file()));
  const auto other = folder.file("other.db");
  {
    SQLite::Database db(other.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    db.exec("CREATE TABLE theirs (a)");
  }
  EXPECT_FALSE(rescue(other));
}

}  // namespace
}  // namespace roverd::store
