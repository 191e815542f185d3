// A hand on the speed of what drives by itself.

#include "robot/modes/auto_hand.hpp"

#include <cmath>
#include <limits>

#include "field.hpp"

namespace roverd::robot {
namespace {

using std::chrono::milliseconds;

constexpr double kTimeout_s = 0.5;

struct HandTold {
  AutoHand hand;
  base::Time now{};

  bool holds(double share, std::uint64_t who = 1) { return hand.say({share, true, who}, now); }
  void frees(std::uint64_t who = 1) { (void)hand.say({0.0, false, who}, now); }
  void leaves(std::uint64_t who = 1) { (void)hand.say({0.0, false, who, true}, now); }
  bool later(int ms) {
    now += milliseconds(ms);
    return hand.step(now, kTimeout_s);
  }
};

TEST(AutoHand, NobodyThatUsesItSlowsNothing) {
  HandTold t;
  EXPECT_FALSE(t.later(60'000));
  EXPECT_EQ(t.hand.share(), 1.0);
  EXPECT_FALSE(t.hand.used());
  t.frees();
  t.leaves();
  EXPECT_EQ(t.hand.share(), 1.0);
  EXPECT_EQ(t.hand.why(), "");
}

TEST(AutoHand, ItsShareCountsWhileItIsHeldAndNothingWhenItIsLetGo) {
  HandTold t;
  ASSERT_TRUE(t.holds(0.4));
  EXPECT_EQ(t.hand.share(), 0.4);
  EXPECT_NE(t.hand.why(), "");
  ASSERT_TRUE(t.holds(1.0));
  EXPECT_EQ(t.hand.share(), 1.0);
  EXPECT_EQ(t.hand.why(), "");
  t.frees();
  EXPECT_EQ(t.hand.share(), 0.0);
  EXPECT_TRUE(t.hand.stands());
  EXPECT_FALSE(t.later(10'000));  // let go is not lost
  ASSERT_TRUE(t.holds(0.7));
  EXPECT_EQ(t.hand.share(), 0.7);
}

TEST(AutoHand, SilenceLosesItOnceAndOnlyAFreshGripTakesItAgain) {
  HandTold t;
  ASSERT_TRUE(t.holds(1.0));
  EXPECT_FALSE(t.later(500));
  EXPECT_EQ(t.hand.share(), 1.0);
  EXPECT_TRUE(t.later(20));
  EXPECT_FALSE(t.later(20));  // told once
  EXPECT_EQ(t.hand.share(), 0.0);
  EXPECT_FALSE(t.holds(1.0));
  EXPECT_EQ(t.hand.share(), 0.0);
  EXPECT_NE(t.hand.why_not().find("let go of the speed first"), std::string::npos);
  t.frees();
  EXPECT_TRUE(t.holds(1.0));
  EXPECT_EQ(t.hand.share(), 1.0);
}

TEST(AutoHand, WhoLeavesWhileHeHoldsItIsLostAndAnotherOneIsRefusedUntilHeLetGo) {
  HandTold t;
  ASSERT_TRUE(t.holds(0.5, 1));
  EXPECT_FALSE(t.holds(1.0, 2));
  EXPECT_EQ(t.hand.share(), 0.5);
  t.frees(2);
  t.leaves(2);
  EXPECT_EQ(t.hand.phase(), AutoHand::Phase::Held);
  t.leaves(1);
  EXPECT_EQ(t.hand.phase(), AutoHand::Phase::Lost);
  EXPECT_TRUE(t.later(20));
  EXPECT_FALSE(t.holds(1.0, 2));
  t.frees(2);
  EXPECT_TRUE(t.holds(1.0, 2));
  // One that was let go and then left is lost, too: nobody is there to hold it again.
  t.frees(2);
  t.leaves(2);
  EXPECT_EQ(t.hand.phase(), AutoHand::Phase::Lost);
}

TEST(AutoHand, OnlyAPersonsWordEndsItsUseAndNotWhileItIsHeld) {
  HandTold t;
  ASSERT_TRUE(t.holds(0.5));
  t.hand.begin();
  EXPECT_EQ(t.hand.share(), 0.5);
  t.frees();
  t.hand.begin();
  EXPECT_EQ(t.hand.share(), 1.0);
  EXPECT_FALSE(t.hand.used());
}

class UnderHand : public Field {
 public:
  void hold(double share, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.1) {
      robot.request(Throttle{share, true}, now + milliseconds(250), {});
      run(0.1);
    }
  }
  double speed() const { return command.twist.linear_mps; }
  std::string told() const {
    for (const auto& c : state()->safety) {
      if (c.id == "auto_hand") return c.detail;
    }
    return "";
  }
};

TEST(UnderHand, AMissionIsDrivenAtItsShareAndNeverFaster) {
  UnderHand f;
  f.drive_mission();
  const double own_mps = f.speed();
  EXPECT_FALSE(f.state()->teleop.auto_share);
  f.hold(0.5, 3.0);
  EXPECT_NEAR(f.speed(), 0.5 * own_mps, 0.03);
  EXPECT_EQ(f.state()->speed_reason, "hand");
  EXPECT_EQ(f.state()->teleop.auto_share, 0.5);
  EXPECT_EQ(f.told(), "");  // a hand that asks for less is no fault
  f.hold(1.0, 4.0);
  EXPECT_NEAR(f.speed(), own_mps, 0.02);
  EXPECT_EQ(f.told(), "");
}

TEST(UnderHand, SilenceStopsTheMissionWhichGoesOnOnlyAfterAFreshGrip) {
  UnderHand f;
  f.drive_mission();
  f.hold(1.0, 1.0);
  const double before = f.speed();
  // When the pad is lost, it slows from the time-out on, and not at once;
  f.run(0.42);
  EXPECT_NEAR(f.speed(), before, 0.05);
  double fastest_fall = 0.0;
  double last = f.speed();
  for (int i = 0; i < 200; ++i) {
    f.tick();
    fastest_fall = std::max(fastest_fall, last - f.speed());
    last = f.speed();
  }
  EXPECT_LT(fastest_fall, 0.13);  // to standing from the slowest that tracks go
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.has_event("hand_lost"));
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_EQ(f.state()->teleop.auto_share, 0.0);
  EXPECT_NE(f.told().find("is silent"), std::string::npos);
  // then it stands, whatever is said by a hand that never let go;
  f.hold(1.0, 2.0);
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.ask(Throttle{0.0, false}));
  f.hold(1.0, 3.0);
  EXPECT_GT(f.speed(), 0.3);
}

TEST(UnderHand, WithoutAHandItGoesOnOnlyWhenAPersonSaysSo) {
  UnderHand f;
  f.drive_mission();
  f.hold(1.0, 1.0);
  ASSERT_TRUE(f.ask(Throttle{0.0, false}));
  f.run(5.0);
  EXPECT_FALSE(f.moves());
  EXPECT_NE(f.told().find("was let go"), std::string::npos);
  ASSERT_TRUE(f.ask(PauseMission{}));
  f.run(2.0);
  EXPECT_EQ(f.state()->teleop.auto_share, 0.0);  // nobody has said that it is not used any more
  ASSERT_TRUE(f.ask(ResumeMission{}));
  f.run(4.0);
  EXPECT_GT(f.speed(), 0.3);
  EXPECT_FALSE(f.state()->teleop.auto_share);
}

TEST(UnderHand, ATurnOnTheSpotStopsToo) {
  UnderHand f;
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of({{0, -20}})));
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(1.5);
  ASSERT_GT(std::abs(f.command.twist.angular_radps), 0.1);
  f.hold(0.0, 1.0);
  EXPECT_FALSE(f.moves());
  f.hold(1.0, 1.0);
  EXPECT_GT(std::abs(f.command.twist.angular_radps), 0.1);
}

TEST(UnderHand, AGoalIsDrivenUnderItAndHandsAreNot) {
  UnderHand f;
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  GoTo g;
  g.at = kFrame.to_global({0, 20});
  ASSERT_TRUE(f.ask(g));
  f.run(4.0);
  ASSERT_GT(f.speed(), 0.3);
  f.hold(0.0, 4.0);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Guided);
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.let_go();
  for (int i = 0; i < 20; ++i) {
    f.robot.request(Drive{{0.5, 0.0}, true}, f.now + milliseconds(250), {});
    f.hold(0.0, 0.1);
  }
  EXPECT_NEAR(f.speed(), 0.5, 0.01);
}

TEST(UnderHand, WhatIsNoShareOrComesTooLateIsRefusedAndChangesNothing) {
  UnderHand f;
  f.drive_mission();
  for (const double bad : {-0.01, 1.01, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    const auto done = f.ask(Throttle{bad, true});
    ASSERT_FALSE(done) << bad;
    EXPECT_EQ(done.error().code, base::Code::Invalid);
  }
  const auto late = f.ask(Throttle{0.2, true}, milliseconds(-1));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, base::Code::Late);
  EXPECT_FALSE(f.state()->teleop.auto_share);
  f.run(1.0);
  EXPECT_GT(f.speed(), 0.3);
}

}  // namespace
}  // namespace roverd::robot
