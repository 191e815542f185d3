#include "services/desk.hpp"

#include <atomic>
#include <future>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace roverd::services {
namespace {

using namespace std::chrono_literals;

/// Waits for everything that was put on the desk before.
void catch_up(Desk& desk) {
  std::promise<void> done;
  desk.post([&] { done.set_value(); });
  done.get_future().get();
}

TEST(Desk, WorkIsDoneInOrderOnAThreadOfItsOwn) {
  std::vector<int> seen;
  std::thread::id where;
  Desk desk;
  for (int i = 0; i < 1000; ++i) {
    desk.post([&, i] {
      seen.push_back(i);
      where = std::this_thread::get_id();
    });
  }
  desk.start(1h, [] {});
  catch_up(desk);
  ASSERT_EQ(seen.size(), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
  EXPECT_NE(where, std::this_thread::get_id());
}

TEST(Desk, TheBeatComesAlsoWhileWorkNeverEnds) {
  std::promise<void> third;
  std::atomic<int> beats{0};
  Desk desk;
  const Desk::Poster post = desk.poster();
  const std::function<void()> again = [&] {
    std::this_thread::sleep_for(1ms);
    if (beats < 3) post(again);
  };
  desk.post(again);
  desk.start(5ms, [&] {
    if (++beats == 3) third.set_value();
  });
  third.get_future().get();
  catch_up(desk);
  EXPECT_GE(beats, 3);
}

TEST(Desk, WorkThatThrowsDoesNotEndTheOthers) {
  bool done = false;
  Desk desk;
  desk.start(1h, [] {});
  desk.post([] { throw std::runtime_error("as planned"); });
  desk.post([&] { done = true; });
  catch_up(desk);
  EXPECT_TRUE(done);
}

TEST(Desk, AfterTheStopNothingIsDoneAndNothingIsTaken) {
  std::atomic<int> done{0};
  const auto held = std::make_shared<int>(1);
  Desk::Poster post;
  {
    Desk desk;
    post = desk.poster();
    desk.post([&, held] { ++done; });  // never begun
    desk.stop();
    desk.post([&, held] { ++done; });
  }
  post([&, held] { ++done; });
  EXPECT_EQ(done, 0);
  EXPECT_EQ(held.use_count(), 1);  // what they held is free
}

}  // namespace
}  // namespace roverd::services
