// What is removed of the recordings of earlier starts, and what never is.

#include "app/recordings.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "link/record_file.hpp"

namespace roverd {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr base::WallTime kDay{1'790'000'000s};

base::Duration days_of(int n) {
  return std::chrono::hours(24) * n;
}

using Names = std::set<std::string>;

class Recordings : public testing::Test {
 protected:
  Recordings() {
    std::string name = (fs::temp_directory_path() / "recordings.XXXXXX").string();
    scratch = ::mkdtemp(name.data());
    folder = scratch / "recordings";
    fs::create_directory(folder);
  }
  ~Recordings() override {
    std::error_code ec;
    fs::permissions(folder, fs::perms::owner_all, ec);
    fs::remove_all(scratch, ec);
  }

  void put(const std::string& name, std::size_t bytes, base::WallTime changed) const {
    std::ofstream(folder / name) << std::string(bytes, 'x');
    date(folder / name, changed);
  }
  static void date(const fs::path& file, base::WallTime changed) {
    const auto ns = changed.time_since_epoch().count();
    const timespec at{ns / 1'000'000'000, ns % 1'000'000'000};
    const timespec both[2] = {at, at};
    ASSERT_EQ(::utimensat(AT_FDCWD, file.c_str(), both, AT_SYMLINK_NOFOLLOW), 0);
  }
  Names left() const {
    Names out;
    for (const auto& entry : fs::directory_iterator(folder)) out.insert(entry.path().filename());
    return out;
  }
  std::vector<base::Event> tidy(RecordingBounds bounds, base::WallTime now = kDay) const {
    return RecordingTidier(folder, bounds).tidy(now);
  }

  fs::path scratch;
  fs::path folder;
};

TEST(RecordingNames, AreOursByTheirForm) {
  for (const char* ours : {"20260301T120000Z-bunker.log", "20260301T120000Z-gnss-2.raw",
                           "20260301T120000Z-mti.002.raw", "20260301T120000Z-bunker.1000.log",
                           "20260301T120000Z-top.pcap", "20260301T120000Z-top_2.003.pcap"}) {
    EXPECT_TRUE(is_recording_name(ours)) << ours;
  }
  for (const char* foreign :
       {"", "notes.txt", "20260301T120000Z-.log", "20260301T120000Z.log", "bunker.log",
        "20260301T120000Z-bunker.log.bak", "20260301T120000Z-bunker.2.log",
        "20260301T120000Z-bunker.00x.log", "20260301T120000Z-bunker.002.003.log",
        "2026-03-01T120000Z-bunker.log", "x20260301T120000Z-bunker.log", "20260301T120000Z-a b.raw",
        "20260301T120000Z-../x.raw", "20260301T120000Z-bunker.csv", "20260301T120000Z-top.pcapng",
        "20260301T120000Z-.pcap"}) {
    EXPECT_FALSE(is_recording_name(foreign)) << foreign;
  }
}

TEST_F(Recordings, BeyondTheRoomTheOldestFilesGoWhole) {
  // Given four files of 1000 bytes, the older two of equal times,
  put("20260301T120000Z-bunker.log", 1000, kDay - 3h);
  put("20260301T120000Z-bunker.002.log", 1000, kDay - 3h);
  put("20260302T120000Z-bunker.log", 1000, kDay - 2h);
  put("20260303T120000Z-gnss.raw", 1000, kDay - 1h);
  // when there is room for 2999,
  const auto told = tidy({.total_bytes = 2999});
  // then two go, by time and then by name, and one event says so.
  EXPECT_EQ(left(), (Names{"20260302T120000Z-bunker.log", "20260303T120000Z-gnss.raw"}));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, "recordings_removed");
  EXPECT_EQ(told[0].level, base::Severity::Info);
  EXPECT_EQ(told[0].wall, kDay);
  EXPECT_EQ(told[0].detail.substr(0, told[0].detail.find('(')),
            "2 recordings, 20260301T120000Z-bunker.002.log to 20260301T120000Z-bunker.log, were "
            "removed ");
  // and within the bounds nothing more goes, nor is told.
  EXPECT_TRUE(tidy({.total_bytes = 2000}).empty());
  EXPECT_EQ(left().size(), 2u);
}

TEST_F(Recordings, OlderThanTheirDaysTheyGoByASetClockOnly) {
  // Given files of 31 and 29 days, of the future, and from before the clock was set,
  put("20260301T120000Z-old.log", 10, kDay - days_of(31));
  put("20260301T120000Z-young.log", 10, kDay - days_of(29));
  put("20260301T120000Z-future.log", 10, kDay + days_of(9000));
  put("19700101T000100Z-unset.log", 10, base::WallTime{60s});
  const RecordingBounds month{.keep_for = days_of(30)};
  // when the clock is not set, then nothing goes,
  EXPECT_TRUE(tidy(month, base::WallTime{1000s}).empty());
  EXPECT_EQ(left().size(), 4u);
  // and when it is, then the one that is old by it.
  EXPECT_EQ(tidy(month).size(), 1u);
  EXPECT_EQ(left(), (Names{"19700101T000100Z-unset.log", "20260301T120000Z-future.log",
                           "20260301T120000Z-young.log"}));
  // By room, the undated one is the oldest, and the one of the future the youngest.
  tidy({.total_bytes = 20});
  EXPECT_EQ(left(), (Names{"20260301T120000Z-future.log", "20260301T120000Z-young.log"}));
}

TEST_F(Recordings, WhatIsNotOursStaysAndDoesNotCount) {
  // Given large foreign files, folders and links with names like ours, and one recording,
  put("notes.txt", 5000, kDay - days_of(900));
  put("20260301T120000Z-bunker.log.bak", 5000, kDay - days_of(900));
  fs::create_directory(folder / "20260301T120000Z-folder.log");
  date(folder / "20260301T120000Z-folder.log", kDay - days_of(900));
  std::ofstream(scratch / "target.log") << std::string(5000, 'x');
  date(scratch / "target.log", kDay - days_of(900));
  fs::create_symlink(scratch / "target.log", folder / "20260301T120000Z-link.log");
  date(folder / "20260301T120000Z-link.log", kDay - days_of(900));
  ASSERT_EQ(::mkfifo((folder / "20260301T120000Z-pipe.log").c_str(), 0600), 0);
  date(folder / "20260301T120000Z-pipe.log", kDay - days_of(900));
  put("20260301T120000Z-bunker.log", 100, kDay - 1h);
  const Names before = left();
  // when there is room for the recording alone,
  EXPECT_TRUE(tidy({.total_bytes = 100, .keep_for = days_of(30)}).empty());
  // then everything is as it was.
  EXPECT_EQ(left(), before);
  EXPECT_EQ(fs::file_size(scratch / "target.log"), 5000u);
}

TEST_F(Recordings, AFolderBehindALinkIsLeftAloneAndThatIsToldOnce) {
  // Given a link where the folder should be,
  put("20260301T120000Z-bunker.log", 100, kDay - days_of(900));
  fs::create_directory_symlink(folder, scratch / "linked");
  RecordingTidier tidier(scratch / "linked", {.total_bytes = 1});
  // when it is tidied up,
  const auto told = tidier.tidy(kDay);
  // then nothing goes, and it is told, once.
  EXPECT_EQ(left().size(), 1u);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, "recordings_stay");
  EXPECT_EQ(told[0].level, base::Severity::Warning);
  EXPECT_TRUE(tidier.tidy(kDay).empty());
}

TEST_F(Recordings, AnEmptyFolderAndNoneAreFine) {
  EXPECT_TRUE(tidy({.total_bytes = 1, .keep_for = days_of(1)}).empty());
  fs::remove(folder);
  EXPECT_TRUE(tidy({.total_bytes = 1, .keep_for = days_of(1)}).empty());
  std::ofstream(folder) << "a file";
  EXPECT_EQ(tidy({.total_bytes = 1}).size(), 1u);
  EXPECT_TRUE(fs::exists(folder));
  // And without bounds nobody looks.
  EXPECT_TRUE(tidy({}).empty());
}

TEST_F(Recordings, TheOneThatIsWrittenStaysUntilItsNextFile) {
  // Given an old file and a recording that is being written, its first file full,
  put("20260301T120000Z-bunker.log", 1000, kDay - days_of(2));
  link::RecordOptions options;
  options.max_bytes = 100;
  options.keep_free_bytes = 0;
  const fs::path first = folder / "20260302T120000Z-bunker.log";
  auto file = link::RecordFile::create(first.string(), options);
  ASSERT_TRUE(file);
  ASSERT_TRUE((*file)->write(std::string(90, 'a')));
  date(first, kDay - days_of(1));
  // when there is no room for either, then the old one goes and the other stays,
  tidy({.total_bytes = 1, .keep_for = std::chrono::hours(1)});
  EXPECT_EQ(left(), Names{"20260302T120000Z-bunker.log"});
  // also for one whose first file is followed by a second: that one is written now.
  ASSERT_TRUE((*file)->write(std::string(90, 'b')));
  tidy({.total_bytes = 1});
  EXPECT_EQ(left(), Names{"20260302T120000Z-bunker.002.log"});
  ASSERT_TRUE((*file)->write("c"));
  ASSERT_TRUE((*file)->sync());
  EXPECT_EQ(fs::file_size(folder / "20260302T120000Z-bunker.002.log"), 91u);
  // Once it is closed it goes like all others.
  file->reset();
  tidy({.total_bytes = 1});
  EXPECT_EQ(left(), Names{});
}

TEST_F(Recordings, TenThousandFilesAreTidiedUpAtOnce) {
  for (int i = 0; i < 10'000; ++i) {
    char name[64];
    std::snprintf(name, sizeof name, "20260301T%06dZ-gnss.raw", i);
    put(name, 10, kDay - days_of(1) + std::chrono::seconds(i));
  }
  const auto told = tidy({.total_bytes = 1000});
  ASSERT_EQ(told.size(), 1u);
  const Names stay = left();
  EXPECT_EQ(stay.size(), 100u);
  EXPECT_EQ(*stay.begin(), "20260301T009900Z-gnss.raw");
}

TEST_F(Recordings, OneThatVanishesMeanwhileIsNotMissed) {
  // Given three files of which the first is gone when its turn comes,
  std::vector<std::string> asked;
  const auto entry = [](const char* name, int hour) {
    return RecordingEntry{name, kDay + std::chrono::hours(hour), 1000};
  };
  // when room for one is to be made,
  spare_recordings({entry("c", 3), entry("a", 1), entry("b", 2)}, {.total_bytes = 1000}, kDay,
                   [&](const RecordingEntry& e) {
                     asked.push_back(e.name);
                     return e.name == "a" ? Removal::WasGone : Removal::Gone;
                   });
  // then its room counts as made.
  EXPECT_EQ(asked, (std::vector<std::string>{"a", "b"}));
  // And one that is in use or stays for another reason makes none: the next one goes for it.
  asked.clear();
  spare_recordings({entry("c", 3), entry("a", 1), entry("b", 2)}, {.total_bytes = 2000}, kDay,
                   [&](const RecordingEntry& e) {
                     asked.push_back(e.name);
                     return e.name == "a" ? Removal::InUse : Removal::Gone;
                   });
  EXPECT_EQ(asked, (std::vector<std::string>{"a", "b"}));
}

TEST_F(Recordings, SomebodyElseMayRemoveThemAtTheSameTime) {
  for (int i = 0; i < 2000; ++i) {
    char name[64];
    std::snprintf(name, sizeof name, "20260301T%06dZ-gnss.raw", i);
    put(name, 10, kDay - days_of(1));
  }
  std::thread other([&] {
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::error_code ec;
      fs::remove(entry.path(), ec);
    }
  });
  RecordingTidier tidier(folder, {.total_bytes = 100});
  for (int i = 0; i < 20; ++i) {
    for (const base::Event& event : tidier.tidy(kDay)) {
      EXPECT_EQ(event.kind, "recordings_removed") << event.detail;
    }
  }
  other.join();
}

TEST_F(Recordings, AFolderThatMayNotBeWrittenKeepsAllAndSaysSoOnce) {
  if (::getuid() == 0) GTEST_SKIP() << "permissions do not hold for root";
  // Given a folder that nobody may write,
  put("20260301T120000Z-bunker.log", 1000, kDay - 1h);
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  RecordingTidier tidier(folder, {.total_bytes = 1});
  // when it is tidied up twice, then it is told once,
  const auto told = tidier.tidy(kDay);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, "recordings_stay");
  EXPECT_NE(told[0].detail.find("20260301T120000Z-bunker.log: Permission denied"),
            std::string::npos)
      << told[0].detail;
  EXPECT_TRUE(tidier.tidy(kDay).empty());
  // and once it may be, the file goes; a new trouble is told again.
  fs::permissions(folder, fs::perms::owner_all);
  EXPECT_EQ(tidier.tidy(kDay).at(0).kind, "recordings_removed");
  put("20260301T120000Z-bunker.log", 1000, kDay - 1h);
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(tidier.tidy(kDay).size(), 1u);
}

}  // namespace
}  // namespace roverd
