// Drivers that throw or hang, beside one that works: nobody else notices, and a restart helps.

#include "supervise/supervisor.hpp"

#include <atomic>
#include <future>
#include <stdexcept>

#include <boost/asio/post.hpp>
#include <gtest/gtest.h>

namespace roverd {
namespace {

using namespace std::chrono_literals;
using base::DriverPhase;
using base::DriverStatus;

/// What went wrong with a driver is chosen while it runs.
struct Fate {
  std::atomic<bool> throw_in_make{false};
  std::atomic<bool> throw_in_start{false};
  std::atomic<bool> throw_in_tick{false};
  std::atomic<bool> throw_in_link{false};
  std::atomic<bool> hang_in_start{false};
  std::promise<void> wake_up;  ///< ends the hanging
  std::shared_future<void> woken{wake_up.get_future().share()};
  std::atomic<int> made{0};
  std::atomic<int> ticks{0};
  std::atomic<int> stops{0};
  std::atomic<int> restarts{0};
  std::atomic<int> sent{0};
  std::atomic<int> lights{-1};
  std::function<void(base::Recording, const std::string&)> on_recording;
};

void throw_if(const std::atomic<bool>& wanted, const char* what) {
  if (wanted) throw std::runtime_error(what);
}

DevicePlan plan_for(const std::string& name, const std::shared_ptr<Fate>& fate, bool moves) {
  DevicePlan plan{.name = name, .moves = moves, .lights = moves, .make = {}};
  plan.make = [name, fate, moves](boost::asio::io_context& io, const DeviceEars& ears) {
    ++fate->made;
    throw_if(fate->throw_in_make, "no memory for it");
    fate->on_recording = ears.on_recording;
    const auto tell = [name, ears](DriverPhase phase, base::Time now) {
      DriverStatus status;
      status.stamp = now;
      status.name = name;
      status.phase = phase;
      ears.on_measurement(status);
    };
    Device device{.start =
                      [fate, tell](base::Time now) {
                        throw_if(fate->throw_in_start, "the start went wrong");
                        if (fate->hang_in_start) fate->woken.wait();
                        tell(DriverPhase::Up, now);
                      },
                  .tick =
                      [fate, tell, &io](base::Time now) {
                        throw_if(fate->throw_in_tick, "a value that cannot be");
                        if (fate->throw_in_link.exchange(false)) {
                          boost::asio::post(io, [] { throw std::runtime_error("broken frame"); });
                        }
                        ++fate->ticks;
                        tell(DriverPhase::Up, now);
                      },
                  .stop =
                      [fate, tell](base::Time now) {
                        ++fate->stops;
                        tell(DriverPhase::Down, now);
                      },
                  .restart = [fate](base::Time) { ++fate->restarts; }};
    if (moves) {
      device.send = [fate](const base::DriveCommand&, base::Time) { ++fate->sent; };
      device.set_lights = [fate](const base::LightState& lights, base::Time) {
        fate->lights = lights.front_pct;
        return lights.front_pct <= 100;
      };
    }
    return device;
  };
  return plan;
}

class Bay : public ::testing::Test {
 protected:
  void TearDown() override { supervisor.reset(); }  // its last words need a hearer

  void open() {
    auto made = Supervisor::make({plan_for("wheels", wheels, true), plan_for("eyes", eyes, false)},
                                 [this](const base::Measurement& m) {
                                   const auto* status = std::get_if<DriverStatus>(&m);
                                   if (status == nullptr) return;
                                   std::lock_guard lock(mutex_);
                                   heard_.push_back(status->name);
                                   statuses_[status->name].push_back(*status);
                                 });
    ASSERT_TRUE(made);
    supervisor = std::move(*made);
    supervisor->start();
  }

  DriverStatus last(const std::string& name) {
    std::lock_guard lock(mutex_);
    const auto& all = statuses_[name];
    return all.empty() ? DriverStatus{} : all.back();
  }
  std::vector<std::string> heard() {
    std::lock_guard lock(mutex_);
    return heard_;
  }
  bool is(const std::string& name, DriverPhase phase) { return last(name).phase == phase; }

  static void until(const std::function<bool()>& claim, const char* what) {
    const auto end = std::chrono::steady_clock::now() + 30s;
    while (!claim()) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << what;
      std::this_thread::sleep_for(1ms);
    }
  }
  void until_both_work() {
    until([this] { return is("wheels", DriverPhase::Up) && is("eyes", DriverPhase::Up); },
          "both work");
  }
  /// The other one goes on.
  static void expect_ticking(const Fate& fate) {
    const int before = fate.ticks;
    until([&] { return fate.ticks > before + 3; }, "it goes on ticking");
  }

  std::shared_ptr<Fate> wheels = std::make_shared<Fate>();
  std::shared_ptr<Fate> eyes = std::make_shared<Fate>();
  std::unique_ptr<Supervisor> supervisor;

 private:
  std::mutex mutex_;
  std::vector<std::string> heard_;
  std::map<std::string, std::vector<DriverStatus>> statuses_;
};

TEST_F(Bay, EveryDriverIsKnownInTheOrderOfThePlansBeforeOneSpeaks) {
  open();
  const std::vector<std::string> names = heard();
  ASSERT_GE(names.size(), 2U);
  EXPECT_EQ(names[0], "wheels");
  EXPECT_EQ(names[1], "eyes");
  until_both_work();
}

TEST_F(Bay, ADriverThatThrowsInATickFailsAloneAndARestartBringsItBack) {
  // Given two drivers that work,
  open();
  until_both_work();
  // when one throws,
  eyes->throw_in_tick = true;
  until([this] { return is("eyes", DriverPhase::Failed); }, "failed");
  // then it says when and why, is stopped once, and stays so;
  until([this] { return eyes->stops == 1; }, "it was stopped");
  EXPECT_EQ(last("eyes").reason,
            "failed while ticking: a value that cannot be; restart the driver to try again");
  EXPECT_EQ(eyes->made, 1);
  // the other goes on, and still takes commands;
  expect_ticking(*wheels);
  EXPECT_TRUE(is("wheels", DriverPhase::Up));
  until(
      [this] {
        supervisor->send({}, base::steady_now());
        return wheels->sent > 0;
      },
      "the base hears");
  // a restart makes it anew, and the error is remembered.
  eyes->throw_in_tick = false;
  ASSERT_TRUE(supervisor->restart("eyes"));
  until([this] { return is("eyes", DriverPhase::Up); }, "up again");
  EXPECT_EQ(eyes->made, 2);
  EXPECT_EQ(last("eyes").restarts, 1u);
  EXPECT_NE(last("eyes").last_error.find("a value that cannot be"), std::string::npos);
  EXPECT_TRUE(last("eyes").last_error_at);
  expect_ticking(*eyes);
}

TEST_F(Bay, ADriverMayThrowFromTheBeginningOrFromItsLink) {
  wheels->throw_in_make = true;
  eyes->throw_in_start = true;
  open();
  until([this] { return is("wheels", DriverPhase::Failed) && is("eyes", DriverPhase::Failed); },
        "both failed");
  EXPECT_NE(last("wheels").reason.find("while being made: no memory"), std::string::npos);
  EXPECT_NE(last("eyes").reason.find("while starting: the start went wrong"), std::string::npos);
  // Commands to a driver that is not there go nowhere.
  supervisor->send({}, base::steady_now());
  EXPECT_EQ(wheels->sent, 0);
  wheels->throw_in_make = eyes->throw_in_start = false;
  ASSERT_TRUE(supervisor->restart("wheels"));
  ASSERT_TRUE(supervisor->restart("eyes"));
  until_both_work();
  // A handler of its link throws:
  eyes->throw_in_link = true;
  until([this] { return is("eyes", DriverPhase::Failed); }, "failed again");
  EXPECT_NE(last("eyes").reason.find("while listening: broken frame"), std::string::npos);
  // Again and again: every restart counts.
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(supervisor->restart("eyes"));
    until([this] { return is("eyes", DriverPhase::Up); }, "up");
    eyes->throw_in_tick = true;
    until([this] { return is("eyes", DriverPhase::Failed); }, "failed");
    eyes->throw_in_tick = false;
  }
  EXPECT_EQ(last("eyes").restarts, 4u);
}

TEST_F(Bay, ADriverThatHangsIsToldReplacedAndLeftBehind) {
  // Given a driver that never comes back from its start,
  eyes->hang_in_start = true;
  open();
  // then it is told as failed, while the other works,
  until([this] { return is("eyes", DriverPhase::Failed); }, "told");
  EXPECT_EQ(last("eyes").reason,
            "hangs while starting: no sign of life for 3 s; restart the driver to try again");
  expect_ticking(*wheels);
  // a restart puts another one in its place at once,
  eyes->hang_in_start = false;
  ASSERT_TRUE(supervisor->restart("eyes"));
  until([this] { return is("eyes", DriverPhase::Up); }, "up");
  EXPECT_EQ(eyes->made, 2);
  // and when the old one wakes up, it neither speaks nor ticks any more.
  eyes->wake_up.set_value();
  supervisor->stop();
  EXPECT_EQ(eyes->stops, 1);
}

TEST_F(Bay, OneThatHangsDoesNotKeepTheProgramFromEnding) {
  eyes->hang_in_start = true;
  open();
  until([this] { return is("wheels", DriverPhase::Up); }, "the other works");
  supervisor->stop();
  EXPECT_EQ(wheels->stops, 1);
  supervisor.reset();
  eyes->wake_up.set_value();  // whatever it does now, nobody is there to hear
}

TEST_F(Bay, AWorkingDriverRestartsItself) {
  open();
  until_both_work();
  ASSERT_TRUE(supervisor->restart("eyes"));
  until([this] { return eyes->restarts == 1 && last("eyes").restarts == 1; }, "restarted");
  EXPECT_EQ(eyes->made, 1);
  EXPECT_EQ(supervisor->restart("ears").error().code, base::Code::NotFound);
}

TEST_F(Bay, LightsAreSetOnTheDriversThreadOrRefusedWithTheReason) {
  open();
  until_both_work();
  const auto ask = [this](int pct, base::Time not_after) {
    base::LightState lights;
    lights.front_pct = pct;
    const auto answer = std::make_shared<std::promise<base::Result<void>>>();
    supervisor->set_lights(lights, not_after,
                           [answer](base::Result<void> r) { answer->set_value(r); });
    return answer->get_future().get();
  };
  EXPECT_TRUE(ask(40, base::Time::max()));
  EXPECT_EQ(wheels->lights, 40);
  EXPECT_EQ(ask(101, base::Time::max()).error().code, base::Code::Conflict);  // could not be sent
  EXPECT_EQ(ask(7, base::Time{}).error().code, base::Code::Late);
  EXPECT_EQ(wheels->lights, 101);
  wheels->throw_in_tick = true;
  until([this] { return is("wheels", DriverPhase::Failed); }, "failed");
  EXPECT_EQ(ask(50, base::Time::max()).error().detail, "the vehicle's driver is not running");
  // Errors cannot be cleared here at all.
  base::Result<void> refused;
  supervisor->clear_errors(0, base::Time::max(),
                           [&](base::Result<void> r) { refused = std::move(r); });
  EXPECT_EQ(refused.error().detail, "this vehicle has no errors that can be cleared");
  EXPECT_TRUE(supervisor->has_lights());
  EXPECT_FALSE(supervisor->clears_errors());
}

TEST_F(Bay, ARecordingThatStopsIsPartOfTheStatus) {
  open();
  until_both_work();
  EXPECT_EQ(last("eyes").recording, base::Recording::Off);
  eyes->on_recording(base::Recording::Stopped, "No space left on device");
  until([this] { return last("eyes").recording == base::Recording::Stopped; }, "told");
  EXPECT_EQ(last("eyes").recording_problem, "No space left on device");
  EXPECT_TRUE(is("eyes", DriverPhase::Up));
}

TEST(BayOfTwoBases, IsRefused) {
  const auto fate = std::make_shared<Fate>();
  const auto made = Supervisor::make({plan_for("a", fate, true), plan_for("b", fate, true)},
                                     [](const base::Measurement&) {});
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().detail.find("drivers.a and drivers.b"), std::string::npos);
}

}  // namespace
}  // namespace roverd
