// A stop overtakes what was clicked before it and comes after it.

#include "robot/safety/last_stop.hpp"

#include <atomic>
#include <future>
#include <thread>
#include <utility>

#include "field.hpp"

namespace roverd::robot {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(LastStop, RefusesWhatWasSeenBeforeItAndNothingElse) {
  const Time stop = Time{} + milliseconds(5000) + microseconds(400);
  LastStop last;
  EXPECT_TRUE(last.permits(Time{}));
  last.take(stop);
  const auto before = last.permits(Time{} + milliseconds(4999));
  ASSERT_FALSE(before);
  EXPECT_EQ(before.error().code, base::Code::Late);
  EXPECT_EQ(before.error().detail,
            "the robot was stopped after this was clicked, so it was not carried out: look, then "
            "click again");
  // The answer to the stop tells 5.000 s.
  EXPECT_TRUE(last.permits(Time{} + milliseconds(5000)));
  EXPECT_TRUE(last.permits(Time::max()));
}

class Overtaken : public testing::Test {
 protected:
  /// Ready, armed where asked, with a mission of 20 m loaded; somebody looks.
  void SetUp() override {
    f.run(8.0);
    ASSERT_TRUE(f.load(plan_of({{0, 20}})));
    ASSERT_TRUE(f.ask(Arm{}));
    f.run(0.5);
    looked = f.now;
    f.run(0.1);
  }

  /// Comes now, and was clicked when somebody had seen what was `seen`.
  base::Result<void> late(Command command, Time seen) {
    base::Result<void> answer = base::fail(base::Code::Unavailable, "no answer came");
    EXPECT_TRUE(f.robot.request(std::move(command), Validity{seen + std::chrono::seconds(1), seen},
                                [&answer](base::Result<void> r) { answer = std::move(r); }));
    f.tick();
    return answer;
  }

  void expect_overtaken(Command command) {
    const auto done = late(std::move(command), looked);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, base::Code::Late) << done.error().detail;
    EXPECT_NE(done.error().detail.find("after this was clicked"), std::string::npos);
  }

  Field f;
  Time looked{};
};

TEST_F(Overtaken, AHoldOfARobotThatStandsRefusesTheStartThatWasUnderWay) {
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));
  expect_overtaken(StartMission{"m", 1});
  f.run(3.0);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Loaded);
  // Clicked again by somebody who saw that it holds.
  ASSERT_TRUE(late(StartMission{"m", 1}, f.now));
  f.run(3.0);
  EXPECT_TRUE(f.moves());
}

TEST_F(Overtaken, WithoutAStopTheSameIsInTime) {
  EXPECT_TRUE(late(StartMission{"m", 1}, looked));
  f.run(3.0);
  EXPECT_TRUE(f.moves());
}

TEST_F(Overtaken, EveryWordThatStopsCountsEvenWhereThereIsNothingToStop) {
  const std::vector<Command> stops{SetMode{Mode::Hold}, PauseMission{}, StopMission{}, Disarm{},
                                   Estop{"anna"}};
  for (const Command& stop : stops) {
    looked = f.now;
    f.run(0.1);
    (void)f.ask(stop);
    expect_overtaken(Arm{});
    expect_overtaken(StartMission{"m", 1});
  }
}

TEST_F(Overtaken, WhateverMovesIsRefused) {
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));
  GoTo goal;
  goal.at = kFrame.to_global({0, 5});
  MoveBy move;
  move.forward_m = 1.0;
  SetTarget target;
  target.at = goal.at;
  target.asked = f.now;
  const std::vector<Command> all{Arm{},
                                 SetMode{Mode::Manual},
                                 SetMode{Mode::Auto},
                                 SetMode{Mode::Rtl},
                                 goal,
                                 move,
                                 target,
                                 StartMission{"m", 1},
                                 SkipItem{},
                                 ResumeMission{},
                                 ResumeActivity{},
                                 ResetEstop{},
                                 Drive{{0.4, 0.0}, true}};
  for (const Command& one : all) expect_overtaken(one);
  f.run(1.0);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Hold);
}

TEST_F(Overtaken, AResetThatWasClickedBeforeTheStopDoesNotUndoIt) {
  ASSERT_TRUE(f.ask(Estop{"anna"}));
  f.run(0.1);
  looked = f.now;
  f.run(0.1);
  ASSERT_TRUE(f.ask(Estop{"anna, once more"}));
  expect_overtaken(ResetEstop{});
  EXPECT_TRUE(f.state()->estop);
  EXPECT_TRUE(late(ResetEstop{}, f.now));
  EXPECT_FALSE(f.state()->estop);
}

/// Where in a tick the stop comes is chance: it may be carried out before it was seen to be asked.
TEST_F(Overtaken, WhoWasAnsweredThatItIsStoppedMayResetAtOnce) {
  constexpr int kTimes = 10000;
  std::atomic<int> refused{0};
  std::atomic<bool> done{false};
  std::thread web([&] {
    const auto asked = [this](Command command, Validity validity) {
      std::promise<std::pair<bool, Time>> answered;
      f.robot.request(std::move(command), validity, [&](base::Result<void> r) {
        answered.set_value({r.has_value(), f.now});  // on the thread of the ticks
      });
      return answered.get_future().get();
    };
    for (int i = 0; i < kTimes; ++i) {
      const Time seen = asked(Estop{"a script"}, Time::max()).second;
      if (!asked(ResetEstop{}, Validity{Time::max(), seen}).first) ++refused;
    }
    done = true;
  });
  while (!done) f.tick();
  web.join();
  EXPECT_EQ(refused, 0);
}

TEST_F(Overtaken, TheStopBetweenTwoTicksCounts) {
  f.now += milliseconds(5);
  base::Result<void> answer{};
  ASSERT_TRUE(f.robot.request(Estop{"anna"}, Time::max(), {}));
  f.robot.heed_stop(f.now);
  f.tick();
  expect_overtaken(ResetEstop{});
  EXPECT_TRUE(f.state()->estop);
}

TEST_F(Overtaken, WhatMovesNothingIsTakenAndToLetGoOfAStickIsNoStop) {
  ASSERT_TRUE(late(Drive{{}, false}, looked));
  EXPECT_TRUE(late(Arm{}, looked));
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));
  EXPECT_TRUE(f.ask(SetParameter{"nav.speed.max_mps", 0.5}));
  EXPECT_TRUE(f.load(plan_of({{0, 10}}), 2));
}

TEST_F(Overtaken, ARadioThatTookControlAndGaveItBackMeanwhileIsAWordToo) {
  f.swb = base::Switch::Middle;
  f.run(0.1);
  f.swb = base::Switch::Up;
  f.run(0.3);
  const auto done = late(StartMission{"m", 1}, looked);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().detail,
            "the radio took control after this was clicked, so it was not carried out: look, then "
            "click again");
}

TEST_F(Overtaken, ALeverThatStopsCountsAsTheClickDoes) {
  f.swd = base::Switch::Down;
  f.run(0.3);
  f.swd = base::Switch::Up;  // disarms
  f.run(0.3);
  ASSERT_FALSE(f.state()->armed);
  expect_overtaken(Arm{});
}

}  // namespace
}  // namespace roverd::robot
