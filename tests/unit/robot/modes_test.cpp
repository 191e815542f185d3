#include "field.hpp"

namespace roverd::robot {
namespace {

using std::chrono::milliseconds;

TEST(Modes, HoldPausesAMissionAndAutoGoesOnButStartsNone) {
  Field f;
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of({{0, 20}})));
  EXPECT_EQ(f.execution(), ExecutionState::Loaded);
  EXPECT_FALSE(f.ask(SetMode{Mode::Auto}));  // not armed
  ASSERT_TRUE(f.ask(Arm{}));
  const auto refused = f.ask(SetMode{Mode::Auto});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "the mission is loaded: there is none to go on with; start it");
  EXPECT_FALSE(f.moves());
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_EQ(f.state()->control, base::Driver::Autonomy);
  f.run(3.0);
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  ASSERT_TRUE(f.ask(SetMode{Mode::Auto}));
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_EQ(f.state()->mode, Mode::Manual);
}

TEST(Modes, EachSaysWhyItDoesNotBegin) {
  Field f;
  f.run(1.0);
  for (const Mode mode : {Mode::Guided, Mode::Rtl, Mode::SmartRtl, Mode::Follow, Mode::Auto}) {
    const auto refused = f.ask(SetMode{mode});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, base::Code::Conflict);
    EXPECT_FALSE(refused.error().detail.empty());
  }
  EXPECT_EQ(f.state()->mode, Mode::Hold);
}

TEST(Missions, StartIsRefusedUnlessItIsWhatIsLoaded) {
  Field f;
  f.run(8.0);
  EXPECT_EQ(f.robot.loaded(), nullptr);
  EXPECT_EQ(f.robot.preview({}).error().code, base::Code::NotFound);
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_FALSE(f.ask(StartMission{"m", 1}));  // nothing is loaded
  ASSERT_TRUE(f.load(plan_of({{0, 20}}), 3));
  EXPECT_EQ(f.robot.loaded()->revision, 3);
  const auto other = f.ask(StartMission{"m", 4});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, base::Code::Conflict);
  EXPECT_NE(other.error().detail.find("revision 3"), std::string::npos);
  EXPECT_FALSE(f.ask(StartMission{"n", 3}));
  EXPECT_TRUE(f.ask(StartMission{"m", 3}));
}

TEST(Missions, ARunningOneIsNotReplacedAPausedOneIs) {
  Field f;
  f.drive_mission();
  const auto refused = f.load(plan_of({{5, 5}}), 2);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  EXPECT_EQ(f.robot.loaded()->revision, 1);
  ASSERT_TRUE(f.ask(PauseMission{}));
  ASSERT_TRUE(f.load(plan_of({{5, 5}, {6, 6}}), 2));
  EXPECT_EQ(f.execution(), ExecutionState::Loaded);
  EXPECT_EQ(f.state()->mission.items, 2);
  EXPECT_FALSE(f.ask(ResumeMission{}));  // a new one is started, not resumed
}

TEST(Missions, ThePreviewTellsTheFirstTargetBeforeAnythingMoves) {
  Field f;
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of({{0, 20}, {20, 20}})));
  const auto p = f.robot.preview({"m", 1});
  ASSERT_TRUE(p);
  EXPECT_EQ(p->first_item, 1);
  EXPECT_NEAR(*p->distance_m, 20.0, 0.1);
  EXPECT_NEAR(std::remainder(*p->bearing_deg, 360.0), 0.0, 0.5);
  EXPECT_EQ(p->name, "field");
  StartMission third{"m", 1, StartMission::From::Item, 3};
  EXPECT_EQ(f.robot.preview(third).error().code, base::Code::Conflict);
  StartMission second{"m", 1, StartMission::From::Item, 2};
  EXPECT_EQ(f.robot.preview(second)->first_item, 2);
  EXPECT_FALSE(f.moves());
}

TEST(Missions, ThePreviewTellsWhereItJoinsItsWayAndTheStartDoesSo) {
  Field f;
  f.run(8.0);
  // Item 1 lies 2 m behind the robot, which points north.
  ASSERT_TRUE(f.load(plan_of({{0.3, -2}, {0.3, 20}, {20, 20}})));
  const auto p = f.robot.preview({"m", 1});
  ASSERT_TRUE(p);
  EXPECT_EQ(p->first_item, 2);
  EXPECT_NEAR(p->joins_after_m.value(), 2.0, 0.2);
  EXPECT_EQ(p->left_out, 1);
  const auto asked = f.robot.preview({"m", 1, StartMission::From::Item, 1});
  EXPECT_FALSE(asked->joins_after_m);
  EXPECT_EQ(asked->first_item, 1);
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(6.0);
  EXPECT_GT(f.at.north_m, 1.0);
  EXPECT_EQ(f.state()->mission.current_item, 2);
  EXPECT_TRUE(f.has_event("item_missed"));
  EXPECT_NEAR(f.state()->mission.arrival_radius_m.value(), 0.5, 1e-9);
  EXPECT_NEAR(f.state()->mission.cross_track_limit_m.value(), 3.0, 1e-9);
}

TEST(Missions, ThePreviewTellsHowFarTheSmoothWayIsFromTheItems) {
  Field f;
  f.run(8.0);
  std::vector<base::EnuPoint> points{{0, 20}, {0, 25}};
  for (int i = 1; i < 40; ++i) points.push_back({i % 2 == 0 ? 0.02 : -0.02, 25.0 + 0.3 * i});
  ASSERT_TRUE(f.load(plan_of(points)));
  const auto p = f.robot.preview({"m", 1});
  ASSERT_TRUE(p);
  ASSERT_EQ(p->smoothed.size(), 1u);
  EXPECT_EQ(p->smoothed[0].first, 2);
  EXPECT_EQ(p->smoothed[0].last, 41);
  EXPECT_NEAR(p->smoothed[0].deviation_m, 0.03, 0.015);
}

TEST(Missions, CompilingNamesTheItemThatCannotBeDriven) {
  Field f;
  f.run(1.0);
  auto plan = plan_of({{0, 20}});
  plan.items.emplace_back(mission::Landmarks{"any", 0.0});
  const auto refused = f.robot.compile({"m", 1, plan});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fields.at(0).pointer, "/items/1");
}

TEST(Missions, OneLoadedBeforeTheFirstFixIsDrivenInTheSameFrame) {
  Field f;
  f.gnss_speaks = false;
  f.run(1.0);
  ASSERT_TRUE(f.load(plan_of({{0, 20}})));
  f.gnss_speaks = true;
  f.run(8.0);
  EXPECT_EQ(f.execution(), ExecutionState::Loaded);
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_TRUE(f.ask(StartMission{"m", 1}));
}

TEST(Missions, OneOnAnotherContinentIsUnloadedAtTheFirstFix) {
  Field f;
  f.gnss_speaks = false;
  f.run(1.0);
  mission::Plan far;
  mission::Waypoint w;
  w.at = {-33.0, 151.0};
  far.items.emplace_back(w);
  ASSERT_TRUE(f.load(far));
  f.gnss_speaks = true;
  f.run(2.0);
  EXPECT_EQ(f.robot.loaded(), nullptr);
  EXPECT_EQ(f.execution(), ExecutionState::Idle);
  EXPECT_TRUE(f.has_event("mission_unloaded"));
}

TEST(Missions, StopEndsItAndTheNextStartBeginsAtTheFirstItem) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(StopMission{}));
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Aborted);
  EXPECT_FALSE(f.ask(StopMission{}));
  EXPECT_FALSE(f.ask(ResumeMission{}));
  EXPECT_TRUE(f.ask(StartMission{"m", 1}));
  EXPECT_EQ(f.state()->mission.current_item, 1);
}

TEST(Commands, ThoseThatMoveAreNeverLateThoseThatStopAlwaysWork) {
  Field f;
  f.run(8.0);
  const auto late = f.ask(Arm{}, -milliseconds(40));
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, base::Code::Late);
  EXPECT_FALSE(f.state()->armed);
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_TRUE(f.ask(SetMode{Mode::Hold}, -milliseconds(40)));
  EXPECT_TRUE(f.ask(Disarm{}, -milliseconds(40)));
  EXPECT_TRUE(f.ask(Estop{"x"}, -milliseconds(40)));
  EXPECT_TRUE(f.state()->estop);
}

TEST(Commands, NoReplyIsEverLostAndAFullQueueSaysSo) {
  Field f;
  int answers = 0;
  int accepted = 0;
  for (int i = 0; i < 100; ++i) {
    accepted += f.robot.request(Arm{}, f.now, [&](base::Result<void>) { ++answers; }) ? 1 : 0;
  }
  EXPECT_EQ(accepted, 64);
  f.tick();
  EXPECT_EQ(answers, accepted);
  EXPECT_GE(f.wakes, 1);
}

TEST(Commands, WhatStopsGetsInBesideACrowdOfOtherCommands) {
  // Given a robot on its way, and more commands than it takes
  Field f;
  f.drive_mission();
  while (f.robot.request(SkipItem{}, f.now, {})) {
  }
  // when somebody stops it, and a hundred others do,
  const std::vector<Command> stops{SetMode{Mode::Hold}, PauseMission{}, StopMission{}, Disarm{}};
  int done = 0;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(f.robot.request(stops[static_cast<std::size_t>(i) % stops.size()], f.now,
                                [&](base::Result<void> r) { done += r ? 1 : 0; }));
  }
  EXPECT_FALSE(f.robot.request(Arm{}, f.now, {}));
  // then all of them are heard at the next tick.
  f.tick();
  EXPECT_GE(done, 50);
  EXPECT_FALSE(f.state()->armed);
  EXPECT_FALSE(f.moves());
}

TEST(Commands, TheEmergencyStopWorksEvenIfNoCommandFitsIntoTheQueue) {
  Field f;
  f.drive_mission();
  while (f.robot.request(Drive{}, f.now, {})) {
  }
  EXPECT_FALSE(f.robot.request(Estop{"anna"}, f.now, {}));
  f.tick();
  EXPECT_TRUE(f.state()->estop);
  EXPECT_FALSE(f.moves());
}

TEST(Commands, HomeIsHereOrWhereTheOperatorSays) {
  Field f;
  f.run(1.0);
  EXPECT_FALSE(f.ask(SetHome{base::LatLon{91.0, 0.0}}));
  EXPECT_FALSE(f.ask(SetHome{base::LatLon{58.5, 26.8}}));  // out of the map's reach
  ASSERT_TRUE(f.ask(SetHome{base::LatLon{58.4, 26.8}}));
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_EQ(f.state()->home, (base::LatLon{58.4, 26.8}));  // arming leaves a chosen home
  ASSERT_TRUE(f.ask(SetHome{}));
  EXPECT_NEAR(f.state()->home->lat, kFrame.origin().lat, 1e-5);
}

TEST(Estop, IsLatchedDisarmsAndIsResetIntoHold) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(Estop{"anna"}));
  EXPECT_FALSE(f.moves());
  EXPECT_FALSE(f.command.enabled);
  EXPECT_FALSE(f.state()->armed);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  for (const Command& c :
       {Command{Arm{}}, Command{SetMode{Mode::Manual}}, Command{SetMode{Mode::Auto}},
        Command{ResumeMission{}}, Command{StartMission{"m", 1}}}) {
    EXPECT_FALSE(f.ask(c));
  }
  ASSERT_TRUE(f.ask(ResetEstop{}));
  EXPECT_FALSE(f.state()->estop);
  EXPECT_FALSE(f.state()->armed);
  EXPECT_TRUE(f.has_event("estop"));
  EXPECT_TRUE(f.has_event("estop_reset"));
}

TEST(Estop, TheBaseMustLetGoFirst) {
  Field f;
  f.drive_mission();
  f.vehicle_state = base::VehicleState::Estop;
  f.run(0.5);
  EXPECT_TRUE(f.state()->estop);
  const auto refused = f.ask(ResetEstop{});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("still pressed"), std::string::npos);
  f.vehicle_state = base::VehicleState::Normal;
  f.run(0.5);
  EXPECT_TRUE(f.state()->estop);  // never by itself
  EXPECT_TRUE(f.ask(ResetEstop{}));
}

TEST(Snapshot, CountsLateWakeUpsByTheirLateness) {
  Field f;
  f.now += milliseconds(20);
  f.robot.tick(f.now, {}, std::chrono::microseconds(3));
  f.now += milliseconds(20);
  f.robot.tick(f.now, {}, milliseconds(30));
  const auto loop = f.state()->loop;
  EXPECT_EQ(loop.ticks, 2u);
  EXPECT_EQ(loop.late_ticks, 1u);
  EXPECT_EQ(loop.lateness_log2_us[2], 1u);   // 2 us up to below 4 us
  EXPECT_EQ(loop.lateness_log2_us[15], 1u);  // up to below 32.8 ms
  EXPECT_DOUBLE_EQ(loop.last_lateness_s, 0.03);
}

}  // namespace
}  // namespace roverd::robot
