// What keeps the latched emergency stop over the end of the program.

#include "app/estop_keeper.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace roverd {
namespace {

namespace fs = std::filesystem;

class EstopFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "estop.XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    file = folder_ / "estop";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<EstopKeeper> open(bool first = false) {
    return EstopKeeper::open(file, first, {});
  }
  std::string text() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(std::string_view text) const {
    std::ofstream(file, std::ios::binary).write(text.data(), static_cast<long>(text.size()));
  }
  static void wait(EstopKeeper& keeper) {
    std::promise<void> kept;
    keeper.when_kept([&kept] { kept.set_value(); });
    ASSERT_EQ(kept.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  }

  fs::path file;

 private:
  fs::path folder_;
};

TEST_F(EstopFile, ANewRobotBeginsReleasedAndWhatIsLatchedIsLatchedAfterwards) {
  {
    const auto keeper = open(true);
    EXPECT_FALSE(keeper->found().latched);
    EXPECT_EQ(text(), estop_text(false));
    keeper->want(true);
    wait(*keeper);
    EXPECT_EQ(text(), estop_text(true));  // while the program still runs: a kill changes nothing
  }
  {
    const auto keeper = open();
    EXPECT_TRUE(keeper->found().latched);
    EXPECT_NE(keeper->found().why.find("before the program started"), std::string::npos);
    keeper->want(false);
    keeper->want(true);
    keeper->want(false);  // the newest counts; written at the end at the latest
  }
  EXPECT_FALSE(open()->found().latched);
}

TEST_F(EstopFile, AMissingFileIsASurpriseWhereTheRobotHasRunBefore) {
  const auto keeper = open();
  EXPECT_TRUE(keeper->found().latched);
  EXPECT_NE(keeper->found().why.find("is missing"), std::string::npos);
  EXPECT_EQ(text(), estop_text(true));
}

TEST_F(EstopFile, WhateverElseStandsThereCountsAsLatched) {
  const std::string released(estop_text(false));
  const std::string latched(estop_text(true));
  std::vector<std::string> all = {"",
                                  "released",
                                  std::string(released.size(), '\0'),
                                  released + "\n",
                                  latched + released,
                                  released.substr(1)};
  // A write that was cut anywhere, either way.
  for (std::size_t n = 1; n < released.size(); ++n) {
    const std::string mixed = latched.substr(0, n) + released.substr(n);
    if (mixed != released && mixed != latched) all.push_back(mixed);
    all.push_back(released.substr(0, n));
  }
  for (const std::string& damaged : all) {
    write(damaged);
    const auto keeper = open();
    EXPECT_TRUE(keeper->found().latched) << damaged;
    EXPECT_NE(keeper->found().why.find("is damaged"), std::string::npos) << damaged;
    EXPECT_EQ(text(), latched) << damaged;
  }
}

TEST_F(EstopFile, AFileThatCannotBeHadIsNamedAndCountsAsLatched) {
  fs::create_directory(file);
  const auto keeper = open(true);
  EXPECT_TRUE(keeper->found().latched);
  EXPECT_NE(keeper->found().why.find(file.string() + ": Is a directory"), std::string::npos);
  keeper->want(false);
  wait(*keeper);
}

TEST(EstopKeeperTrouble, WhatCannotBeWrittenIsToldOnceAndNobodyWaitsForIt) {
  ASSERT_EQ(::access("/dev/full", W_OK), 0);
  std::promise<std::string> told;
  int times = 0;
  auto keeper = EstopKeeper::open("/dev/full", true, {[&](const std::string& why) {
                                    if (++times == 1) told.set_value(why);
                                  }});
  keeper->want(true);
  std::promise<void> answered;
  keeper->when_kept([&] { answered.set_value(); });
  EXPECT_EQ(answered.get_future().wait_for(std::chrono::seconds(20)), std::future_status::ready);
  auto why = told.get_future();
  ASSERT_EQ(why.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_NE(why.get().find("/dev/full cannot be written"), std::string::npos);
  keeper.reset();
  EXPECT_EQ(times, 1);
}

}  // namespace
}  // namespace roverd
