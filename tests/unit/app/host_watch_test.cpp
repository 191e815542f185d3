// What is said of the robot's own computer.

#include "app/host_watch.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace roverd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

HostFacts all_well() {
  HostFacts facts;
  facts.now = base::Time(seconds(1000));
  facts.wall = base::WallTime(seconds(1'770'000'000));
  facts.storage = {.looked = base::Time(seconds(999)), .trouble = {}, .free_bytes = 50'000'000'000};
  facts.real_time = true;
  facts.memory_locked = true;
  facts.lateness_s = 0.0005;
  return facts;
}

std::vector<std::string> ids(const HostFacts& facts) {
  std::vector<std::string> out;
  for (const auto& problem : host_problems(facts)) out.push_back(problem.id);
  return out;
}

using Ids = std::vector<std::string>;

TEST(HostWatch, NothingIsSaidWhereAllIsWell) {
  EXPECT_EQ(ids(all_well()), Ids{});
}

TEST(HostWatch, ADiskThatKeepsNothingIsNamedWithItsReason) {
  HostFacts facts = all_well();
  facts.storage.trouble = "the disk is full, nothing was changed";
  ASSERT_EQ(ids(facts), Ids{"storage_failed"});
  EXPECT_EQ(host_problems(facts)[0].detail,
            "changes cannot be saved: the disk is full, nothing was changed");
  EXPECT_TRUE(host_problems(facts)[0].alarming);
}

TEST(HostWatch, ADiskIsSilentAfterTenSecondsAndLowBelow200MB) {
  HostFacts facts = all_well();
  facts.storage.looked = facts.now - milliseconds(10'000);
  EXPECT_EQ(ids(facts), Ids{});
  facts.storage.looked = facts.now - milliseconds(10'001);
  EXPECT_EQ(ids(facts), Ids{"storage_silent"});

  facts = all_well();
  facts.storage.free_bytes = 200'000'000;
  EXPECT_EQ(ids(facts), Ids{});
  facts.storage.free_bytes = 199'999'999;
  ASSERT_EQ(ids(facts), Ids{"storage_low"});
  EXPECT_EQ(host_problems(facts)[0].detail, "the disk is nearly full: 200 MB are left");
  facts.storage.free_bytes.reset();  // a file system that does not tell
  EXPECT_EQ(ids(facts), Ids{});
}

TEST(HostWatch, AClockThatWasNeverSetIsSaid) {
  HostFacts facts = all_well();
  facts.wall = base::WallTime{};  // a board without a battery
  EXPECT_EQ(ids(facts), Ids{"clock_unset"});
  facts.wall = base::WallTime(seconds(1'735'689'600));  // 2025-01-01
  EXPECT_EQ(ids(facts), Ids{});
}

TEST(HostWatch, RefusedPriorityIsToldWithTheLatenessAndAlarmsOnlyWhenTheLoopIsLate) {
  HostFacts facts = all_well();
  facts.real_time = false;
  ASSERT_EQ(ids(facts), Ids{"realtime_refused"});
  const auto quiet = host_problems(facts)[0];
  EXPECT_FALSE(quiet.alarming);
  EXPECT_NE(quiet.detail.find("the control loop wakes up to 0.5 ms late"), std::string::npos)
      << quiet.detail;
  facts.lateness_s = 0.020;
  EXPECT_EQ(ids(facts), Ids{"realtime_refused"});
  facts.lateness_s = 0.0328;
  ASSERT_EQ(ids(facts), (Ids{"loop_late", "realtime_refused"}));
  EXPECT_TRUE(host_problems(facts)[0].alarming);
  facts.lateness_s.reset();
  EXPECT_EQ(ids(facts), Ids{"realtime_refused"});
  facts.memory_locked = false;
  ASSERT_EQ(ids(facts), (Ids{"realtime_refused", "memory_unlocked"}));
  EXPECT_FALSE(host_problems(facts)[1].alarming);
}

TEST(HostWatch, ThatNobodyFindsItByNameIsToldAndAlarmsNobody) {
  HostFacts facts = all_well();
  facts.unannounced = "no avahi-daemon runs";
  ASSERT_EQ(ids(facts), Ids{"not_announced"});
  EXPECT_FALSE(host_problems(facts)[0].alarming);
  EXPECT_EQ(host_problems(facts)[0].detail,
            "nobody finds this robot by its name: no avahi-daemon runs");
}

TEST(LatenessWatch, NamesWhatAllButAThousandthWereBelow) {
  // Given 1000 wake-ups: 998 below 64 us, two between 4.1 and 8.2 ms,
  LatenessWatch watch;
  base::LoopHealth loop;
  loop.lateness_log2_us[13] = 77;  // before anybody looked
  watch.take(loop, base::Time(seconds(1)));
  EXPECT_FALSE(watch.p999_s());
  loop.lateness_log2_us[6] += 998;
  loop.lateness_log2_us[13] += 2;
  watch.take(loop, base::Time(seconds(20)));
  // then the thousandth is the later of the two; with a single one it is not.
  ASSERT_TRUE(watch.p999_s());
  EXPECT_NEAR(*watch.p999_s(), 8192e-6, 1e-9);
  loop.lateness_log2_us[6] += 2000;
  watch.take(loop, base::Time(seconds(60)));
  EXPECT_NEAR(*watch.p999_s(), 64e-6, 1e-9);
  // A new minute begins anew.
  watch.take(loop, base::Time(seconds(62)));
  loop.lateness_log2_us[13] += 600;
  watch.take(loop, base::Time(seconds(70)));
  EXPECT_NEAR(*watch.p999_s(), 8192e-6, 1e-9);
}

}  // namespace
}  // namespace roverd
