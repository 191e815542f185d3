// Copies of the database in use, and what becomes of a damaged one.

#include "store/backups.hpp"

#include <algorithm>
#include <fstream>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

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

TEST(Backups, TheyAreMadeByThemselves) {
  Folder folder;
  const auto store = open_store(folder.file());
  const Backups backups(
      folder.file(),
      {.keep = 2, .period = std::chrono::milliseconds(30), .first = std::chrono::milliseconds(1)});
  const auto first = backup_folder(folder.file()) / "roverd-000001.db";
  const auto third = backup_folder(folder.file()) / "roverd-000003.db";
  const auto done = [&] { return fs::exists(third) && !fs::exists(first); };
  for (int i = 0; i < 1000 && !done(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(done());
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
