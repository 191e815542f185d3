// The recording that is being made, in the file.

#include <future>

#include <gtest/gtest.h>

#include "folder.hpp"
#include "store/store.hpp"

namespace roverd::store {
namespace {

TeachRecord record() {
  TeachRecord r;
  r.started = base::WallTime(std::chrono::seconds(1'780'000'000));
  r.name = "orchard";
  r.settings = {0.5, 15.0, 0.1, 0.3};
  return r;
}

std::vector<mission::TaughtPoint> some_points(int first, int count) {
  std::vector<mission::TaughtPoint> out;
  for (int i = first; i < first + count; ++i) {
    out.push_back({{58.0 + i * 1e-5, 26.0 + 1.0 / 3.0}, 12.5, 0.7, i % 2 == 1, i == 3});
  }
  return out;
}

class TeachStore : public testing::Test {
 protected:
  TeachStore() { open(); }

  void open() {
    auto opened = Store::open(folder_.file(), [](std::function<void()> answer) { answer(); });
    ASSERT_TRUE(opened) << opened.error().detail;
    store_ = std::move(*opened);
  }

  template <class T, class Ask>
  base::Result<T> ask(Ask ask) {
    std::promise<base::Result<T>> answer;
    ask([&answer](base::Result<T> result) { answer.set_value(std::move(result)); });
    return answer.get_future().get();
  }
  base::Result<void> begin() {
    return ask<void>([&](auto reply) { store_->begin_teach(record(), reply); });
  }
  base::Result<void> add(int first, int count) {
    return ask<void>(
        [&](auto reply) { store_->add_teach_points(some_points(first, count), reply); });
  }
  std::optional<TeachRecord> read() {
    return *ask<std::optional<TeachRecord>>([&](auto reply) { store_->read_teach(reply); });
  }

  Folder folder_;
  std::unique_ptr<Store> store_;
};

TEST_F(TeachStore, WhatWasRecordedIsThereAfterARestart) {
  EXPECT_FALSE(read());
  EXPECT_EQ(add(0, 1).error().code, base::Code::Conflict);
  ASSERT_TRUE(begin());
  ASSERT_TRUE(add(0, 3));
  ASSERT_TRUE(add(3, 2));
  store_.reset();
  open();
  const auto found = read();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->name, "orchard");
  EXPECT_EQ(found->started, record().started);
  EXPECT_EQ(found->settings, record().settings);
  EXPECT_EQ(found->points, some_points(0, 5));
  // There is one recording only.
  EXPECT_EQ(begin().error().code, base::Code::Conflict);
  EXPECT_EQ(read()->points.size(), 5u);
}

TEST_F(TeachStore, TheMissionTakesItsPlaceOrNothingHappens) {
  ASSERT_TRUE(begin());
  ASSERT_TRUE(add(0, 5));
  mission::Plan bad;
  EXPECT_FALSE(ask<StoredMission>([&](auto reply) {
    store_->finish_teach(bad, {"x", "y"}, reply);
  }));
  EXPECT_EQ(read()->points.size(), 5u);
  const auto plan = mission::mission_of(some_points(0, 5), "orchard", 0.0);
  ASSERT_TRUE(plan);
  const auto made = ask<StoredMission>([&](auto reply) {
    store_->finish_teach(*plan, {"x", "y"}, reply);
  });
  ASSERT_TRUE(made);
  EXPECT_EQ(made->plan.items.size(), 5u);
  EXPECT_FALSE(read());
  ASSERT_TRUE(begin());
  EXPECT_TRUE(read()->points.empty());
  ASSERT_TRUE(ask<void>([&](auto reply) { store_->discard_teach(reply); }));
  EXPECT_FALSE(read());
}

}  // namespace
}  // namespace roverd::store
