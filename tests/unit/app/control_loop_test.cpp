// The thread of the ticks: they come at their own times, and an alert is heeded between two of
// them.

#include "app/control_loop.hpp"

#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace roverd {
namespace {

using namespace std::chrono_literals;

/// What the loop's thread did, in order.
struct Diary {
  struct Entry {
    bool tick = false;
    base::Time planned;  ///< of a tick
  };
  std::mutex mutex;
  std::vector<Entry> entries;
  void note(Entry entry) {
    std::lock_guard lock(mutex);
    entries.push_back(entry);
  }
  std::vector<Entry> so_far() {
    std::lock_guard lock(mutex);
    return entries;
  }
};

TEST(ControlLoop, AnAlertIsHeededBetweenTicksAndTheTicksStayWhereTheyAre) {
  Diary diary;
  {
    ControlLoop loop(
        [&](base::Time now, base::WallTime, base::Duration late) {
          diary.note({true, now - late});
        },
        [&](base::Time) {
          diary.note({false, {}});
        });
    while (diary.so_far().empty()) std::this_thread::sleep_for(1ms);
    // Given alerts all the time,
    const auto end = std::chrono::steady_clock::now() + 400ms;
    while (std::chrono::steady_clock::now() < end) {
      loop.alert();
      std::this_thread::sleep_for(1ms);
    }
  }
  // then each period has several, and every tick is planned a whole number of periods after the
  // first one, none twice.
  const auto entries = diary.so_far();
  int heeded = 0;
  base::Time last = entries.front().planned - ControlLoop::kPeriod;
  for (const auto& entry : entries) {
    if (!entry.tick) {
      ++heeded;
      continue;
    }
    EXPECT_EQ((entry.planned - entries.front().planned) % ControlLoop::kPeriod, 0ns);
    EXPECT_GE(entry.planned - last, ControlLoop::kPeriod);
    last = entry.planned;
  }
  EXPECT_GT(heeded, static_cast<int>(entries.size()) / 2);
}

TEST(ControlLoop, AlertsThatWereNotHeededYetAreOne) {
  std::mutex gate;
  gate.lock();
  std::atomic<int> heeded{0};
  std::atomic<int> ticks{0};
  ControlLoop loop(
      [&](base::Time, base::WallTime, base::Duration) {
        if (ticks++ == 0) std::lock_guard wait(gate);
      },
      [&](base::Time) { ++heeded; });
  while (ticks == 0) std::this_thread::sleep_for(1ms);
  for (int i = 0; i < 1000; ++i) loop.alert();  // the first tick is still at work
  gate.unlock();
  while (ticks < 4) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(heeded, 1);
}

}  // namespace
}  // namespace roverd
