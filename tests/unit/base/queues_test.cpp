#include <thread>

#include <gtest/gtest.h>

#include "base/inbox.hpp"
#include "base/latest.hpp"

namespace roverd::base {
namespace {

TEST(Inbox, KeepsOrderAndDropsTheOldestWhenFull) {
  Inbox<int> inbox(3);
  EXPECT_TRUE(inbox.put(1));
  EXPECT_TRUE(inbox.put(2));
  EXPECT_TRUE(inbox.put(3));
  EXPECT_FALSE(inbox.put(4));
  std::vector<int> out;
  ASSERT_TRUE(inbox.try_take(out));
  EXPECT_EQ(out, (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(inbox.dropped(), 1u);
}

TEST(Inbox, AnOfferIsRefusedRatherThanDroppingSomebodyElses) {
  Inbox<int> inbox(1);
  EXPECT_TRUE(inbox.offer(1));
  EXPECT_FALSE(inbox.offer(2));
  std::vector<int> out;
  inbox.take(out);
  EXPECT_EQ(out, std::vector<int>{1});
}

TEST(Inbox, WhatMustGetInHasRoomBeyondTheOthers) {
  Inbox<int> inbox(1);
  EXPECT_TRUE(inbox.offer(1));
  EXPECT_FALSE(inbox.offer(2));
  EXPECT_TRUE(inbox.offer(3, 1));
  EXPECT_FALSE(inbox.offer(4, 1));
  std::vector<int> out;
  ASSERT_TRUE(inbox.try_take(out));
  EXPECT_EQ(out, (std::vector<int>{1, 3}));
}

TEST(Inbox, LosesNothingBetweenTwoThreads) {
  Inbox<int> inbox(1'000'000);
  std::thread writer([&] {
    for (int i = 0; i < 20'000; ++i) inbox.put(i);
  });
  std::vector<int> out;
  while (out.size() < 20'000) inbox.try_take(out);
  writer.join();
  for (int i = 0; i < 20'000; ++i) ASSERT_EQ(out[static_cast<std::size_t>(i)], i);
}

TEST(Latest, IsNullAtFirstAndThenTheNewest) {
  Latest<int> latest;
  EXPECT_EQ(latest.get(), nullptr);
  latest.publish(std::make_shared<const int>(1));
  latest.publish(std::make_shared<const int>(2));
  EXPECT_EQ(*latest.get(), 2);
}

TEST(Latest, ReadersInOtherThreadsNeverSeeAnOlderValueAfterANewerOne) {
  Latest<int> latest;
  std::atomic<bool> done{false};
  std::thread reader([&] {
    int last = 0;
    while (!done) {
      const auto value = latest.get();
      if (value == nullptr) continue;
      ASSERT_GE(*value, last);
      last = *value;
    }
  });
  for (int i = 1; i <= 20'000; ++i) latest.publish(std::make_shared<const int>(i));
  done = true;
  reader.join();
  EXPECT_LE(latest.missed(), 20'000u);
}

}  // namespace
}  // namespace roverd::base
