// A drive by itself that something has stopped for too long.

#include "robot/guard/blocked.hpp"

#include <algorithm>

#include "seeing.hpp"

namespace roverd::robot {
namespace {

TEST(Blocked, WhatIsChosenWhileItIsBlockedIsToldAtOnce) {
  const auto at = [](double s) { return base::Time{} + base::from_seconds(s); };
  BlockedParams params;
  Blocked b;
  b.set(params);
  EXPECT_FALSE(b.step(true, true, {}, at(0.0)));
  EXPECT_EQ(b.step(true, true, {}, at(11.0)), Then::Wait);
  EXPECT_FALSE(b.step(true, true, {}, at(12.0)));
  params.clear_s = 2.0;
  b.set(params);
  EXPECT_FALSE(b.step(true, true, {}, at(13.0))) << "nothing that follows has changed";
  params.then = "return";
  b.set(params);
  EXPECT_EQ(b.step(true, true, {}, at(14.0)), Then::Return);
  EXPECT_FALSE(b.step(true, true, {}, at(15.0)));
}

TEST_F(Seeing, AMissionThatWaitsSaysWhyWhereItIsLookedFor) {
  field.drive_mission();
  wall_at(driven_m() + 5.0);
  field.run(14.0);
  ASSERT_FALSE(field.moves());
  EXPECT_NE(field.state()->mission.reason.find("something stands in the way"), std::string::npos);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
  // And it is silent about it when it drives again.
  wall_m.reset();
  field.run(4.0);
  EXPECT_EQ(field.state()->mission.reason, "");
}

TEST_F(Seeing, AGoalThatWaitsSaysSoToo) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Guided}));
  ASSERT_TRUE(field.ask(MoveBy{10.0, {}, {}, {}}));
  wall_at(4.0);
  field.run(15.0);
  ASSERT_FALSE(field.moves());
  EXPECT_EQ(field.state()->activity.state, base::ActivityState::Waiting);
  EXPECT_NE(field.state()->activity.reason.find("something stands"), std::string::npos);
  wall_m.reset();
  field.run(30.0);
  EXPECT_EQ(field.state()->activity.state, base::ActivityState::Reached);
}

TEST_F(Seeing, WhatStandsTooLongBlocksAndIsToldOnce) {
  // Given a mission that stands before a wall that stays,
  field.drive_mission();
  wall_at(driven_m() + 3.0);
  while (field.moves()) field.tick();
  field.run(9.0);
  EXPECT_FALSE(field.has_event("blocked"));
  ASSERT_TRUE(field.state()->obstacle);
  EXPECT_FALSE(field.state()->obstacle->blocked);
  EXPECT_EQ(field.state()->obstacle->then, "wait");
  ASSERT_TRUE(field.state()->obstacle->decides_at);
  EXPECT_NEAR(base::seconds(*field.state()->obstacle->decides_at - field.now), 1.0, 0.3);
  // when ten seconds have passed,
  field.run(1.3);
  // then it is blocked, once, and says what, who saw it and what follows,
  field.run(30.0);
  EXPECT_EQ(std::count_if(field.events.begin(), field.events.end(),
                          [](const auto& e) { return e.kind == "blocked"; }),
            1);
  const auto told = std::find_if(field.events.begin(), field.events.end(),
                                 [](const auto& e) { return e.kind == "blocked"; });
  EXPECT_EQ(told->level, base::Severity::Warning);
  EXPECT_NE(told->detail.find("seen by front"), std::string::npos) << told->detail;
  EXPECT_NE(told->detail.find("it waits"), std::string::npos) << told->detail;
  EXPECT_TRUE(field.state()->obstacle->blocked);
  EXPECT_FALSE(field.state()->obstacle->decides_at);
  EXPECT_TRUE(field.state()->mission.reason.starts_with("blocked: "));
  // and still goes on by itself when the way is clear.
  wall_m.reset();
  field.run(5.0);
  EXPECT_TRUE(field.moves());
}

TEST_F(Seeing, BlockedItReturnsWhereThatIsChosen) {
  BlockedParams blocked;
  blocked.after_s = 5.0;
  blocked.then = "return";
  field.robot.guard_by({}, true, blocked);
  field.drive_mission();
  const double begin_m = driven_m();
  wall_at(begin_m + 4.0);
  field.run(20.0);
  EXPECT_EQ(field.state()->mode, Mode::Rtl);
  EXPECT_EQ(field.execution(), ExecutionState::Paused);
  EXPECT_TRUE(field.has_event("returns"));
  field.run(60.0);
  EXPECT_TRUE(field.has_event("home_reached"));
  EXPECT_LT(driven_m(), 1.0);
}

TEST_F(Seeing, OnTheWayHomeItWaitsWhateverWasChosen) {
  BlockedParams blocked;
  blocked.after_s = 5.0;
  blocked.then = "return";
  field.robot.guard_by({}, true, blocked);
  field.drive_mission();
  field.run(8.0);
  wall_m = -0.5;  // of 1 m, between it and home
  ASSERT_TRUE(field.ask(SetMode{Mode::Rtl}));
  field.run(60.0);
  EXPECT_EQ(field.state()->mode, Mode::Rtl);
  EXPECT_TRUE(field.has_event("blocked"));
  EXPECT_EQ(field.state()->activity.state, base::ActivityState::Waiting);
}

TEST_F(Seeing, BlockedTheMissionEndsWhereThatIsChosen) {
  BlockedParams blocked;
  blocked.after_s = 5.0;
  blocked.then = "abort";
  field.robot.guard_by({}, true, blocked);
  field.drive_mission();
  wall_at(driven_m() + 4.0);
  field.run(20.0);
  EXPECT_EQ(field.execution(), ExecutionState::Aborted);
  EXPECT_EQ(field.state()->mode, Mode::Hold);
  EXPECT_NE(field.state()->mission.reason.find("something stands in the way"), std::string::npos);
  EXPECT_TRUE(field.has_event("mission_aborted"));
  // A goal of GUIDED fails alike.
  ASSERT_TRUE(field.ask(SetMode{Mode::Guided}));
  ASSERT_TRUE(field.ask(MoveBy{5.0, {}, {}, {}}));
  field.run(12.0);
  EXPECT_EQ(field.state()->mode, Mode::Hold);
  EXPECT_EQ(field.state()->activity.state, base::ActivityState::Failed);
  EXPECT_NE(field.state()->activity.reason.find("blocked"), std::string::npos);
}

TEST_F(Seeing, AHandIsStoppedAndNeverBlocked) {
  BlockedParams blocked;
  blocked.after_s = 1.0;
  blocked.then = "abort";
  field.robot.guard_by({}, true, blocked);
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  wall_at(2.0);
  field.let_go();
  for (int i = 0; i < 600; ++i) {
    field.robot.request(Drive{{0.5, 0.0}, true}, field.now + std::chrono::seconds(1), {});
    field.tick();
  }
  EXPECT_FALSE(field.moves());
  EXPECT_FALSE(field.has_event("blocked"));
  ASSERT_TRUE(field.state()->obstacle);
  EXPECT_EQ(field.state()->obstacle->then, "");
  EXPECT_GT(base::seconds(field.now - *field.state()->obstacle->since), 5.0);
  EXPECT_EQ(field.state()->mode, Mode::Manual);
}

/// The diagram of blocked.hpp.
class BlockedFor : public ::testing::Test {
 protected:
  void set(const char* then, bool at_once = false) {
    BlockedParams p;
    p.then = then;
    p.around_at_once = at_once;
    blocked.set(p);
  }
  /// @return what it decided within that time
  std::optional<Then> pass(double seconds, bool stops, bool solid = true) {
    std::optional<Then> out;
    for (int i = 0; i < seconds * 50.0 + 0.5; ++i) {
      now += std::chrono::milliseconds(20);
      if (const auto then = blocked.step(stops, solid, at, now)) out = then;
    }
    return out;
  }

  Blocked blocked;
  nav::sense::Pose2 at;
  base::Time now{};
};

TEST_F(BlockedFor, AWayThatIsClearForAMomentEndsNothing) {
  set("return");
  EXPECT_FALSE(pass(6.0, true));
  EXPECT_FALSE(pass(1.5, false));
  EXPECT_FALSE(blocked.decides_at());
  EXPECT_EQ(pass(3.0, true), Then::Return);
  EXPECT_TRUE(blocked.blocked());
  // Longer, and it begins anew; so it does where the robot came farther.
  EXPECT_FALSE(pass(4.0, false));
  EXPECT_FALSE(pass(9.0, true));
  at.x_m = 0.5;
  EXPECT_FALSE(pass(9.0, true));
  EXPECT_EQ(pass(1.5, true), Then::Return);
}

TEST_F(BlockedFor, AWayAroundIsAskedForWhereThatIsChosen) {
  set("wait");
  (void)pass(20.0, true);
  EXPECT_FALSE(blocked.wants_around());
  set("around");
  blocked.forget();
  (void)pass(5.0, true);
  EXPECT_FALSE(blocked.wants_around());
  EXPECT_EQ(pass(6.0, true), Then::Around);
  EXPECT_TRUE(blocked.wants_around());
  (void)pass(0.1, true, false);
  EXPECT_FALSE(blocked.wants_around()) << "what nobody has seen is not gone around";
  (void)pass(0.1, false);
  EXPECT_FALSE(blocked.wants_around());
  set("around", true);
  blocked.forget();
  (void)pass(0.1, true);
  EXPECT_TRUE(blocked.wants_around()) << "at once";
}

}  // namespace
}  // namespace roverd::robot
