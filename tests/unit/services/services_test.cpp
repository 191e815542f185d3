// The services with a real robot and store: what they do, they do while nobody else turns a hand.
#include "services/services.hpp"

#include <filesystem>
#include <future>

#include <gtest/gtest.h>
#include <unistd.h>

namespace roverd::services {
namespace {

using namespace std::chrono_literals;

class ServicesTest : public ::testing::Test {
 protected:
  ServicesTest() {
    std::string name = (std::filesystem::temp_directory_path() / "roverd-services-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
    auto opened = store::Store::open(folder_ / "roverd.db", [this](std::function<void()>) {
      ++on_web;  // a web that is stuck: what it is to do is never done
    });
    if (!opened) throw std::runtime_error(opened.error().detail);
    store_ = std::move(*opened);
    services = std::make_unique<Services>(robot_, *store_, "bunker");
  }
  ~ServicesTest() override {
    services.reset();
    store_.reset();
    std::filesystem::remove_all(folder_);
  }

  /// What the services answer to `ask`.
  template <class Ask>
  base::Result<void> answer_to(Ask ask) {
    std::promise<base::Result<void>> told;
    ask([&](base::Result<void> result) { told.set_value(std::move(result)); });
    return told.get_future().get();
  }
  void tick() { robot_.tick(base::steady_now(), base::wall_now(), {}); }

  std::atomic<int> on_web{0};
  std::filesystem::path folder_;
  robot::Robot robot_{robot::Config{}};
  std::unique_ptr<store::Store> store_;
  std::unique_ptr<Services> services;
};

TEST_F(ServicesTest, TeachInIsStartedPausedAndDiscardedWhileTheWebIsStuck) {
  std::mutex mutex;
  std::vector<std::string> kinds;
  services->start({.tell = [&](const base::Event& event) {
    std::lock_guard lock(mutex);
    kinds.push_back(event.kind);
  }});
  // Until the store has answered it is loading, which is said.
  while (services->view()->teach.state == TeachState::Loading) std::this_thread::yield();
  EXPECT_EQ(services->view()->teach.state, TeachState::Idle);

  const auto started =
      answer_to([&](auto done) { services->start_teach({}, "to the barn", std::move(done)); });
  ASSERT_TRUE(started) << started.error().detail;
  EXPECT_EQ(services->view()->teach.state, TeachState::Recording);  // whoever asks next sees it
  EXPECT_EQ(services->view()->teach.name, "to the barn");

  const auto again =
      answer_to([&](auto done) { services->start_teach({}, "again", std::move(done)); });
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, base::Code::Conflict);
  EXPECT_EQ(again.error().detail, "cannot start: a recording is there, recording");

  ASSERT_TRUE(answer_to([&](auto done) { services->pause_teach(std::move(done)); }));
  EXPECT_EQ(services->view()->teach.state, TeachState::Paused);
  ASSERT_TRUE(answer_to([&](auto done) { services->discard_teach(std::move(done)); }));
  EXPECT_EQ(services->view()->teach.state, TeachState::Idle);
  services->stop();
  EXPECT_EQ(kinds, (std::vector<std::string>{"teach_started", "teach_paused", "teach_discarded"}));
  EXPECT_EQ(on_web, 0);
}

//   With the word that it was read comes what was read: nobody takes silence for "nothing".
TEST_F(ServicesTest, WhatWasLeftBehindIsOfferedFromTheMomentThatItIsKnown) {
  store::StoredPlace place;
  place.mission_id = "left";
  place.items = 3;
  store_->keep_place(place, [](auto&&) {});
  EXPECT_FALSE(services->view()->recalled);
  services->start({});
  auto view = services->view();
  while (!view->recalled) view = services->view();
  ASSERT_TRUE(view->offer);
  EXPECT_EQ(view->offer->mission_id, "left");
  services->stop();
}

TEST_F(ServicesTest, TheTrailIsReadUpToTheNewestSnapshot) {
  services->start({});
  const auto count = [&] {
    std::promise<std::optional<std::string>> told;
    services->read_trail(
        [](const Trail& trail, const base::Snapshot& s) {
          return std::to_string(trail.estimated().points().size()) + " at " +
                 std::string(base::to_string(s.mode));
        },
        [&](std::optional<std::string> text) { told.set_value(std::move(text)); });
    return told.get_future().get();
  };
  EXPECT_EQ(count(), std::nullopt);  // the loop has not begun
  tick();
  EXPECT_EQ(count(), "0 at " + std::string(base::to_string(robot_.snapshot()->mode)));
}

TEST_F(ServicesTest, AFenceReachesTheRobotWithItsNextTick) {
  services->start({});
  auto fence = std::make_shared<mission::Fence>();
  fence->name = "yard";
  services->use_fence(fence);
  do {
    tick();
    std::this_thread::sleep_for(1ms);
  } while (!robot_.snapshot()->fence);
  EXPECT_EQ(robot_.snapshot()->fence->name, "yard");
}

TEST_F(ServicesTest, AfterTheStopNothingIsAnswered) {
  services->start({});
  services->stop();
  bool answered = false;
  services->pause_teach([&](const base::Result<void>&) { answered = true; });
  services->use_fence(nullptr);
  services.reset();
  EXPECT_FALSE(answered);
}

}  // namespace
}  // namespace roverd::services
