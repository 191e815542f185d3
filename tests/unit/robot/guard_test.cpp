// What stands in the way is not driven against, whoever drives: the guard in the whole robot.

#include "robot/guard/guard.hpp"

#include <cmath>
#include <memory>
#include <string>

#include "seeing.hpp"

namespace roverd::robot {
namespace {

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

TEST_F(Seeing, WhoCrossesIsWaitedForAndTheMissionGoesOn) {
  field.drive_mission();
  field.run(3.0);
  // He comes to its way, 4 m ahead, when it would be there.
  nav::sense::Mover him;
  him.at = {pose.x_m + 4.0, pose.y_m - 4.0};
  him.v_mps = {0.0, 1.0};
  him.seen = field.now;
  walker = him;
  bool slowed = false;
  bool said = false;
  for (double t = 0.0; t < 9.0; t += 0.02) {
    field.run(0.02);
    const double y_m = him.at.y + base::seconds(field.now - him.seen);
    const bool in_way = std::abs(y_m - pose.y_m) < 0.4;
    if (in_way) {
      EXPECT_LT(pose.x_m + 0.5 * VehicleLength, him.at.x - him.radius_m) << "at " << t;
    }
    const auto& o = field.robot.snapshot()->obstacle;
    slowed = slowed || (o && o->moves && o->action != base::GuardAction::None);
    if (said || !o || !o->reason.starts_with("somebody comes into the way")) continue;
    said = true;
    // The room is to his nearest edge, not to his middle; he is ahead, to the right.
    const double ahead_m = him.at.x - pose.x_m - 0.5 * VehicleLength;
    const double aside_m = std::max(0.0, pose.y_m - y_m - 0.5 * VehicleWidth);
    const double room_m = std::max(0.0, std::hypot(ahead_m, aside_m) - him.radius_m);
    const std::string words = "somebody comes into the way, ";
    EXPECT_NEAR(std::stod(o->reason.substr(words.size())), room_m, 0.1) << o->reason;
  }
  EXPECT_TRUE(slowed);
  EXPECT_TRUE(said);
  field.run(8.0);
  EXPECT_GT(pose.x_m, him.at.x + 1.0) << "it went on";
}

TEST_F(Seeing, WhoStepsOutOfAHandsWayMayStepBack) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  const auto hold = [&](double v, double w, double seconds) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      field.robot.request(Drive{{v, w}, true}, field.now + std::chrono::seconds(1), {});
      field.tick();
    }
  };
  // Given a hand that holds on before something,
  wall_at(driven_m() + 1.2);
  hold(0.5, 0.0, 6.0);
  ASSERT_FALSE(field.moves());
  // when that leaves for a moment,
  wall_m.reset();
  hold(0.5, 0.02, 0.7);
  EXPECT_FALSE(field.moves());
  EXPECT_EQ(field.state()->obstacle->action, base::GuardAction::Stop);
  wall_at(driven_m() + 0.5 * VehicleLength + 0.2);
  hold(0.5, 0.0, 0.5);
  EXPECT_FALSE(field.moves());
  // then it is waited for anew; and when it has been gone for a second, the hand drives on.
  wall_m.reset();
  hold(0.5, 0.0, 0.9);
  EXPECT_FALSE(field.moves());
  hold(0.5, 0.0, 0.6);
  EXPECT_TRUE(field.moves());
  // One that draws back, or turns away, does not wait.
  for (const auto& [v, w] : {std::pair{-0.4, 0.0}, std::pair{0.0, 0.6}}) {
    wall_at(driven_m() + 1.2);
    hold(0.5, 0.0, 6.0);
    ASSERT_FALSE(field.moves());
    hold(v, w, 0.3);
    EXPECT_TRUE(field.moves()) << v << " " << w;
    hold(-0.4, 0.0, 1.0);
    hold(0.0, -0.6, w > 0.0 ? 0.3 : 0.0);
  }
}

TEST_F(Seeing, BesideWhoeverMightTurnItStandsAndAHandMayCreepAway) {
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  field.let_go();
  nav::sense::Mover him;
  him.v_mps = {1.2, 0.0};
  const auto hold = [&](double v, double seconds, double ahead_m) {
    for (int i = 0; i < seconds * 50.0; ++i) {
      // Abreast, or a little behind, as he goes along.
      him.at = {pose.x_m + ahead_m, pose.y_m + 0.5 * VehicleWidth + him.radius_m + 0.5};
      him.seen = field.now;
      walker = him;
      field.robot.request(Drive{{v, 0.0}, true}, field.now + std::chrono::seconds(1), {});
      field.tick();
    }
  };
  hold(0.5, 2.0, 0.0);
  EXPECT_FALSE(field.moves());
  const auto& o = field.robot.snapshot()->obstacle;
  ASSERT_TRUE(o);
  EXPECT_TRUE(o->reason.starts_with("somebody near may turn this way, 0.5 m to the left"))
      << o->reason;
  EXPECT_NE(o->reason.find("sense.protect.turn_part"), std::string::npos) << o->reason;
  EXPECT_NEAR(o->distance_m, 0.5, 0.05);
  hold(0.5, 3.0, -0.5 * VehicleLength - 0.2);
  EXPECT_TRUE(field.moves());
  EXPECT_LT(field.command.twist.linear_mps, 0.3);
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

TEST_F(Seeing, DownhillItBrakesEarlierAndUphillItDoesNot) {
  // Room before the wall when the guard begins to slow a stick that asks for 0.8 m/s ahead.
  const auto slowed_at_m = [&](double pitch_rad) {
    field.let_go();
    wall_m = driven_m() + 4.0;
    field.more = [this, pitch_rad] {
      field.robot.measurements().put(base::Attitude{field.now, 0.0, pitch_rad});
      look();
    };
    field.run(1.0);
    for (int i = 0; i < 400; ++i) {
      field.robot.request(Drive{{0.8, 0.0}, true}, field.now + std::chrono::seconds(1), {});
      field.tick();
      const double sent_mps = field.robot.snapshot()->command.twist.linear_mps;
      const bool slower = i > 100 && sent_mps < 0.77;
      if (slower) return gap_m();
    }
    return 0.0;
  };
  field.run(8.0);
  ASSERT_TRUE(field.ask(Arm{}));
  ASSERT_TRUE(field.ask(SetMode{Mode::Manual}));
  const double level_m = slowed_at_m(0.0);
  EXPECT_GT(level_m, 0.5);
  // 0.5 m/s2 less 0.3 g sin 5 deg are 0.24 m/s2.
  const double down_m = slowed_at_m(base::rad_from_deg(-5.0));
  EXPECT_NEAR(down_m - level_m, 0.8 * 0.8 / 2.0 * (1.0 / 0.2435 - 1.0 / 0.5), 0.15);
  EXPECT_NEAR(slowed_at_m(base::rad_from_deg(5.0)), level_m, 0.06);
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
  EXPECT_NE(field.state()->obstacle->reason.find("(sense.protect.creep_back_mps)"),
            std::string::npos);
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

//   Half a turn on the spot about a place 5 cm ahead of its origin: that ends 10 cm ahead.
TEST(Guard, ItsOdometryGoesAsideAsWell) {
  Guard guard;
  base::Time now{};
  (void)guard.move({}, now);
  for (int i = 0; i < 500; ++i) {
    now += std::chrono::milliseconds(20);
    (void)guard.move({0.0, 0.1 * base::kPi}, now, {}, -0.05 * 0.1 * base::kPi);
  }
  EXPECT_NEAR(guard.odometry().pose.x_m, 0.10, 1e-5);
  EXPECT_NEAR(guard.odometry().pose.y_m, 0.0, 1e-5);
  const double x_m = guard.odometry().pose.x_m;
  now += std::chrono::milliseconds(20);
  EXPECT_EQ(guard.move({}, now, {}, std::nan("")).pose.x_m, x_m);
}

TEST(Guard, ItsOdometryStaysWhereCellsCanBeCountedWhateverIsMeasured) {
  Guard guard;
  base::Time now{};
  const base::Attitude lean{now, 0.0, -0.5};
  (void)guard.move({}, now, lean);
  now += std::chrono::milliseconds(20);
  const auto& o = guard.move({1e300, -1e300}, now, lean);
  EXPECT_LE(std::hypot(o.pose.x_m, o.pose.y_m), 1.0);
  EXPECT_LE(std::abs(o.pose.yaw_rad), 1.0);
  EXPECT_LE(std::abs(o.lie.z_m), 1.0);
}

//   Ten metres up a slope of 6 degrees; then nothing tells how it leans any more: the height stays.
TEST(Guard, ItsOdometryClimbsAsTheBodyLeans) {
  Guard guard;
  base::Time now{};
  const auto lean = [&] { return base::Attitude{now, 0.05, base::rad_from_deg(6.0)}; };
  (void)guard.move({}, now, lean());
  for (int i = 0; i < 500; ++i) {
    now += std::chrono::milliseconds(20);
    (void)guard.move({1.0, 0.0}, now, lean());
  }
  const double up_m = 10.0 * std::sin(base::rad_from_deg(6.0));
  EXPECT_NEAR(guard.odometry().lie.z_m, up_m, 1e-6);
  EXPECT_EQ(guard.odometry().lie.roll_rad, 0.05);
  now += std::chrono::milliseconds(20);
  const auto& o = guard.move({1.0, 0.0}, now);
  EXPECT_NEAR(o.lie.z_m, up_m, 1e-6);
  EXPECT_EQ(o.lie.pitch_rad, 0.0);
}

//   The last word of an attitude that fell silent is kept for a moment; heights reckoned by it are
//   no longer compared.
TEST(Guard, ALeanOfLongAgoIsNotToldAnyMore) {
  Guard guard;
  base::Time now{};
  EXPECT_FALSE(guard.move({}, now).lie.told);
  const base::Attitude last{now, 0.0, 0.1};
  now += std::chrono::milliseconds(140);
  EXPECT_TRUE(guard.move({}, now, last).lie.told);
  now += std::chrono::milliseconds(20);
  EXPECT_FALSE(guard.move({}, now, last).lie.told);
  EXPECT_EQ(guard.odometry().lie.pitch_rad, 0.1);
}

}  // namespace
}  // namespace roverd::robot
