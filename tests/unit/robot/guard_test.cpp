// What stands in the way is not driven against, whoever drives: the guard in the whole robot.

#include "robot/guard/guard.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "field.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Known;

/// The ground around the robot: all seen and free, but what a test puts there.
class Seeing : public ::testing::Test {
 protected:
  Seeing() {
    field.robot.guard_by({});
    field.more = [this] { look(); };
  }

  /// A wall across the way, so far ahead of where the robot was at the begin; 1 m thick.
  void wall_at(double north_m) { wall_m = north_m; }

  void look() {
    std::vector<nav::sense::Odometry> moved;
    field.robot.odometry().take(moved);
    for (const auto& o : moved) pose = o.pose;
    if (!sees) return;
    auto s = std::make_shared<Surroundings>();
    s->patch.stamp = field.now;
    s->patch.side = 280;
    s->patch.x0 = static_cast<std::int32_t>(std::floor(pose.x_m / 0.05)) - 140;
    s->patch.y0 = static_cast<std::int32_t>(std::floor(pose.y_m / 0.05)) - 140;
    s->patch.cells.assign(280 * 280, {seen, 0, 0});
    if (wall_m) {
      for (std::int32_t y = 0; y < 280; ++y) {
        for (std::int32_t x = 0; x < 280; ++x) {
          const double ahead_m = (s->patch.x0 + x) * 0.05;
          if (ahead_m < *wall_m || ahead_m > *wall_m + 1.0) continue;
          s->patch.cells[std::size_t(y * 280 + x)].known = Known::Occupied;
        }
      }
    }
    base::SensorState state;
    state.name = "front";
    state.kind = "velodyne";
    state.health = health;
    state.reason = "the glass is blocked";
    if (!heard) state.health = base::SensorHealth::Silent;
    if (heard) state.seen = s->seen = field.now;
    s->sensors = std::make_shared<const std::vector<base::SensorState>>(1, state);
    field.robot.surroundings().put(std::move(s));
  }

  /// From the origin of the body to the wall, less half of the body.
  double gap_m() const { return *wall_m - 0.5 * VehicleLength - driven_m(); }
  double driven_m() const { return field.at.north_m; }

  static constexpr double VehicleLength = 1.023;
  Field field;
  bool sees = true;
  bool heard = true;
  Known seen = Known::Free;
  base::SensorHealth health = base::SensorHealth::Good;
  std::optional<double> wall_m;
  nav::sense::Pose2 pose;
};

TEST_F(Seeing, AMissionStopsBeforeAWallAndGoesOnWhenItIsGone) {
  // Given a mission straight through a place where a wall stands,
  field.drive_mission();
  wall_at(driven_m() + 5.0);
  // when it is driven,
  field.run(20.0);
  // then it stands before it, says why, and the mission waits as it is.
  EXPECT_FALSE(field.moves());
  EXPECT_GT(gap_m(), 0.05);
  EXPECT_LT(gap_m(), 0.45);
  EXPECT_TRUE(field.has_condition("obstacle"));
  ASSERT_TRUE(field.state()->obstacle);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Stop);
  EXPECT_EQ(field.state()->obstacle->sensor, "front");
  EXPECT_NEAR(field.state()->obstacle->bearing_rad, 0.0, 0.9);
  EXPECT_EQ(field.execution(), ExecutionState::Running);
  EXPECT_TRUE(field.has_event("obstacle"));
  // And when the wall is gone, it goes on after a while, by itself.
  wall_m.reset();
  field.run(0.5);
  EXPECT_FALSE(field.moves());
  field.run(3.0);
  EXPECT_TRUE(field.moves());
  EXPECT_TRUE(field.has_event("obstacle_gone"));
  field.run(40.0);
  EXPECT_EQ(field.execution(), ExecutionState::Finished);
}

TEST_F(Seeing, ItSlowsDownBeforeItStops) {
  field.drive_mission();
  wall_at(driven_m() + 4.0);
  double fastest_near = 0.0;
  double slowest = 1.0;
  for (int i = 0; i < 1000 && field.moves(); ++i) {
    field.tick();
    if (gap_m() < 0.6) fastest_near = std::max(fastest_near, field.command.twist.linear_mps);
    if (field.moves()) slowest = std::min(slowest, field.command.twist.linear_mps);
  }
  EXPECT_LT(fastest_near, 0.6);
  EXPECT_LT(slowest, 0.2);
}

TEST_F(Seeing, TheSticksAreStoppedTooAndMayDriveAway) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  wall_at(2.0);
  field.let_go();
  const auto hold = [&](double v, double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      field.robot.request(Drive{{v, 0.0}, true}, field.now + std::chrono::seconds(1), {});
      field.tick();
    }
  };
  hold(0.8, 10.0);
  EXPECT_FALSE(field.moves());
  EXPECT_GT(gap_m(), 0.05);
  EXPECT_LT(gap_m(), 0.45);
  const double stood_m = driven_m();
  hold(-0.3, 2.0);
  EXPECT_LT(driven_m(), stood_m - 0.3);
}

TEST_F(Seeing, AStickThatWasStoppedKeepsNoMissionFromGoingTheOtherWay) {
  // Given a robot that was driven by hand against a wall in the south, and stopped,
  field.run(8.0);
  ASSERT_TRUE(field.load(plan_of({{0, 6}})));
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  wall_m = -2.5;  // of 1 m, behind it
  for (int i = 0; i < 400; ++i) {
    field.robot.request(Drive{{-0.4, 0.0}, true}, field.now + std::chrono::seconds(1), {});
    field.tick();
  }
  ASSERT_FALSE(field.moves());
  // when a mission to the north begins,
  field.let_go();
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  field.run(3.0);
  // then it drives.
  EXPECT_GT(field.command.twist.linear_mps, 0.2);
}

TEST_F(Seeing, AMissionThatIsSentElsewhereWhileItWaitsGoesThere) {
  // Given a mission that stands before a wall that stays,
  field.run(8.0);
  ASSERT_TRUE(field.load(plan_of({{0, 20}, {0, -6}})));
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  wall_at(5.0);
  field.run(20.0);
  ASSERT_FALSE(field.moves());
  // when it is told to skip to the item behind it,
  ASSERT_TRUE(field.ask(SkipItem{2}));
  field.run(30.0);
  // then it turns round and goes there.
  EXPECT_LT(driven_m(), 1.0);
}

TEST_F(Seeing, WhatNoSensorSawIsCreptIntoByHand) {
  seen = Known::Unknown;
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  for (const double v : {0.8, -0.5}) {
    for (int i = 0; i < 100; ++i) {
      field.robot.request(Drive{{v, 0.0}, true}, field.now + std::chrono::seconds(1), {});
      field.tick();
    }
    const double creep = nav::sense::ProtectParams{}.creep_mps;
    EXPECT_NEAR(field.command.twist.linear_mps, std::copysign(creep, v), 0.02);
  }
}

TEST_F(Seeing, ByItselfItDoesNotReverseIntoWhatNoSensorSaw) {
  seen = Known::Unknown;
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Guided}));
  ASSERT_TRUE(field.ask(MoveBy{-2.0, {}, {}, {}}));
  field.run(4.0);
  EXPECT_FALSE(field.moves());
  ASSERT_TRUE(field.state()->obstacle);
  EXPECT_NE(field.state()->obstacle->reason.find("by hand"), std::string::npos);
}

TEST_F(Seeing, ARequiredSensorThatFallsSilentStopsTheMission) {
  field.drive_mission();
  heard = false;
  field.run(0.4);
  EXPECT_TRUE(field.has_condition("blind"));
  EXPECT_EQ(field.state()->mode, Mode::Hold);
}

TEST_F(Seeing, ABlockedGlassStopsItToo) {
  field.drive_mission();
  health = base::SensorHealth::Blind;
  field.run(0.1);
  EXPECT_FALSE(field.has_condition("blind")) << "one piece of no use is none";
  field.run(0.2);
  EXPECT_TRUE(field.has_condition("blind"));
  field.run(3.0);
  EXPECT_FALSE(field.moves());
}

TEST_F(Seeing, APictureThatIsTooOldIsNotBelieved) {
  field.drive_mission();
  sees = false;
  field.run(0.7);
  EXPECT_TRUE(field.has_condition("blind"));
  field.run(3.0);
  EXPECT_FALSE(field.moves());
}

TEST_F(Seeing, WhatIsWrittenInTheGapIsKeptAlsoWhereItIsWide) {
  nav::sense::ProtectParams wide;
  wide.gap_m = 1.5;
  field.robot.guard_by(wide);
  field.drive_mission();
  wall_at(driven_m() + 6.0);
  field.run(30.0);
  EXPECT_FALSE(field.moves());
  EXPECT_GT(gap_m(), 1.3);
  EXPECT_LT(gap_m(), 1.8);
}

TEST_F(Seeing, WithBrakesThatAreKnownToBeWeakItStopsInTime) {
  Config config;
  config.fence.decel_mps2 = 0.2;
  Guard guard;
  guard.set({}, config.vehicle, true);
  guard.brake_by(0.2);
  wall_m = 2.5;
  field.more = nullptr;
  look();
  std::vector<std::shared_ptr<const Surroundings>> made;
  field.robot.surroundings().take(made);
  (void)guard.take(made.back());
  (void)guard.move({}, field.now);
  // 1 m/s needs 2.5 m and the delay's way; 1.7 are left.
  EXPECT_LT(guard.judge({1.0, 0.0}, false, field.now).linear_mps, 0.85);
  guard.brake_by(5.0);  // more than was set does not count
  EXPECT_GT(guard.judge({1.0, 0.0}, false, field.now).linear_mps, 0.95);
}

TEST_F(Seeing, ADriveThatHasNothingLeftToDoIsNotHeldByWhatStoppedItOnce) {
  field.run(8.0);
  mission::Plan plan = plan_of({{0, 20}});
  plan.items.emplace_back(mission::Wait{5.0});
  ASSERT_TRUE(field.load(plan));
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(StartMission{"m", 1}));
  wall_at(5.0);
  field.run(20.0);
  ASSERT_FALSE(field.moves());
  ASSERT_TRUE(field.ask(SkipItem{2}));
  field.run(15.0);
  EXPECT_EQ(field.execution(), ExecutionState::Finished);
}

// ---- blocked ----

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

// ---- overridden by a hand ----

class Overriding : public Seeing {
 protected:
  /// In MANUAL before a wall that stopped it.
  void stand_before_wall() {
    field.run(8.0);
    ASSERT_TRUE(field.ask(Arm{}));
    ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
    wall_at(2.0);
    field.let_go();
    push(0.5, 0.0, 10.0, false);
    ASSERT_FALSE(field.moves());
  }

  void push(double v, double w, double seconds, bool held_off) {
    Drive d{{v, w}, true};
    d.override_guard = held_off;
    if (held_off) d.who = "anna";
    for (int i = 0; i < seconds * 50.0; ++i) {
      field.robot.request(d, field.now + std::chrono::seconds(1), {});
      field.tick();
    }
  }

  int told(const std::string& kind) const {
    return int(std::count_if(field.events.begin(), field.events.end(),
                             [&](const auto& e) { return e.kind == kind; }));
  }
};

TEST_F(Overriding, ItCreepsTowardsWhatStopsItAndSaysWho) {
  stand_before_wall();
  const double stood_m = driven_m();
  // When the guard is held off,
  push(0.8, 0.0, 1.0, true);
  // then it creeps, tells who did it, and what it does.
  EXPECT_NEAR(field.command.twist.linear_mps, nav::sense::ProtectParams{}.override_mps, 1e-9);
  EXPECT_GT(driven_m(), stood_m + 0.08);
  ASSERT_TRUE(field.state()->obstacle);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Overridden);
  EXPECT_EQ(told("guard_overridden"), 1);
  const auto event = std::find_if(field.events.begin(), field.events.end(),
                                  [](const auto& e) { return e.kind == "guard_overridden"; });
  EXPECT_NE(event->detail.find("by anna: something stands"), std::string::npos) << event->detail;
  // And without that it stands at once, and that is told.
  push(0.8, 0.0, 0.1, false);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 1);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Stop);
}

TEST_F(Overriding, ItTurnsSlowlyBesideAWall) {
  stand_before_wall();
  push(0.6, 0.0, 2.0, true);  // so near that its corners need the room of the wall
  push(0.0, 0.8, 0.5, false);
  ASSERT_FALSE(field.moves());
  push(0.0, 0.8, 0.5, true);
  const double corner_mps = std::abs(field.command.twist.angular_radps) * std::hypot(0.5115, 0.389);
  EXPECT_NEAR(corner_mps, 0.15, 0.005);
}

TEST_F(Overriding, WhereNothingIsInTheWayItChangesNothing) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  push(0.6, 0.0, 3.0, true);
  EXPECT_NEAR(field.command.twist.linear_mps, 0.6, 0.01);
  EXPECT_EQ(told("guard_overridden"), 0);
}

TEST_F(Overriding, ItEndsWithTheHandTheRadioAndTheEmergencyStop) {
  stand_before_wall();
  // A hand that falls silent.
  push(0.8, 0.0, 0.3, true);
  field.run(0.7);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 1);
  // The radio.
  field.let_go();
  push(0.8, 0.0, 0.3, true);
  ASSERT_TRUE(field.moves());
  field.swb = base::Switch::Middle;
  push(0.8, 0.0, 0.3, true);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 2);
  field.swb = base::Switch::Up;
  field.run(1.0);
  // The emergency stop.
  field.let_go();
  push(0.8, 0.0, 0.3, true);
  ASSERT_TRUE(field.moves());
  ASSERT_TRUE(field.ask(Estop{"a test"}));
  push(0.8, 0.0, 0.3, true);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_kept"), 3);
}

TEST_F(Overriding, WhatDrivesByItselfOverridesNothing) {
  field.drive_mission();
  wall_at(driven_m() + 3.0);
  push(0.5, 0.0, 15.0, true);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(told("guard_overridden"), 0);
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Stop);
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

TEST(Guard, WithoutSensorsEverythingPasses) {
  Guard guard;
  const base::BodyTwist fast{1.2, 0.5};
  EXPECT_EQ(guard.judge(fast, true, base::Time{}), fast);
  EXPECT_EQ(guard.obstacle().action, base::GuardAction::None);
}

TEST(Guard, ItsOdometryFollowsAnArcExactly) {
  Guard guard;
  base::Time now{};
  (void)guard.move({}, now);
  for (int i = 0; i < 500; ++i) {
    now += std::chrono::milliseconds(20);
    (void)guard.move({1.0, 0.5}, now);
  }
  // 10 s at 1 m/s on a circle of 2 m.
  const auto& o = guard.move({}, now);
  EXPECT_NEAR(o.pose.x_m, 2.0 * std::sin(5.0), 1e-6);
  EXPECT_NEAR(o.pose.y_m, 2.0 * (1.0 - std::cos(5.0)), 1e-6);
}

}  // namespace
}  // namespace roverd::robot
