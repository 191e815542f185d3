// Backups by a program of their own: when it is started, what is told of it, and that it ends.

#include "app/backup_keeper.hpp"

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "store/store.hpp"

namespace roverd {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr store::BackupOptions kOften{.keep = 2, .period = 10ms, .first = 1ms};

class BackupKeeperTest : public testing::Test {
 protected:
  BackupKeeperTest() {
    std::string name = (fs::temp_directory_path() / "backup-keeper.XXXXXX").string();
    data = ::mkdtemp(name.data());
  }
  ~BackupKeeperTest() override {
    std::error_code ec;
    fs::remove_all(data, ec);
  }

  std::unique_ptr<BackupKeeper> keeper(std::vector<std::string> program) {
    const auto hear = [this](const std::string& why) {
      {
        std::lock_guard lock(mutex);
        told.push_back(why);
      }
      heard.notify_one();
    };
    return std::make_unique<BackupKeeper>(data, kOften, hear, std::move(program));
  }
  /// The data folder is its first argument.
  std::unique_ptr<BackupKeeper> script(const std::string& text) {
    return keeper({"/bin/sh", "-c", text, "sh", data.string()});
  }
  /// Waits until that much was told. @return all of it
  std::vector<std::string> troubles(std::size_t count) {
    std::unique_lock lock(mutex);
    heard.wait_for(lock, 30s, [&] { return told.size() >= count; });
    return told;
  }
  bool appears(const char* name) const {
    for (int i = 0; i < 3000 && !fs::exists(data / name); ++i) ::usleep(10'000);
    return fs::exists(data / name);
  }

  fs::path data;
  std::mutex mutex;
  std::condition_variable heard;
  std::vector<std::string> told;
};

TEST_F(BackupKeeperTest, OneAfterTheOtherIsMadeWithoutAWord) {
  // Given a program that leaves a file for each time that it was started
  const auto backups = script("n=$(ls \"$1\" | wc -l); : >\"$1/run-$n\"; echo run");
  // When it has been started again and again, then nothing was told
  EXPECT_TRUE(appears("run-3"));
  EXPECT_TRUE(troubles(0).empty());
}

TEST_F(BackupKeeperTest, WhatFailsIsToldEachTimeAndLeavesNothing) {
  // Given a program that fails when it is half through, and would say so if half a file were there
  fs::create_directory(data / "backups");
  const auto backups = script(
      "cd \"$1/backups\"; test ! -e unfinished || { echo left >&2; exit 2; }; echo half "
      ">unfinished; "
      "echo 'disk full' >&2; exit 1");
  // Then it is told why, and the next time again, with nothing that was left
  const auto all = troubles(2);
  ASSERT_GE(all.size(), 2u);
  EXPECT_EQ(all[0], "no backup could be made: sh ended with exit code 1: disk full");
  EXPECT_EQ(all[1], all[0]);
}

TEST_F(BackupKeeperTest, AProgramThatIsNotThereIsTold) {
  const auto backups = keeper({"/nowhere/roverd", "backup"});
  ASSERT_FALSE(troubles(1).empty());
  EXPECT_EQ(troubles(1)[0], "no backup could be made: /nowhere/roverd: No such file or directory");
}

TEST_F(BackupKeeperTest, OneInProgressEndsWithIt) {
  // Given one that takes long
  auto backups = script("echo $$ >\"$1/new\"; mv \"$1/new\" \"$1/pid\"; exec sleep 600");
  ASSERT_TRUE(appears("pid"));
  int pid = 0;
  std::ifstream(data / "pid") >> pid;
  ASSERT_EQ(::kill(pid, 0), 0);
  // When the keeper ends, then so has the program, and nothing is told
  backups.reset();
  EXPECT_EQ(::kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
  EXPECT_TRUE(troubles(0).empty());
}

TEST_F(BackupKeeperTest, WhatAKilledOneHasLeftGoesAtTheStart) {
  fs::create_directory(data / "backups");
  std::ofstream(data / "backups" / "unfinished") << "half";
  const auto backups = script("test -e \"$1/backups/unfinished\" || : >\"$1/clean\"");
  EXPECT_TRUE(appears("clean"));
}

}  // namespace
}  // namespace roverd
