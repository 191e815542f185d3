// What follows from what is judged, in the order of a tick: events by name, modes, the pose that is
// shown.

#include "field.hpp"

namespace roverd::robot {
namespace {

std::optional<base::Event> event_of(const Field& f, const std::string& kind) {
  const auto at = std::find_if(f.events.begin(), f.events.end(),
                               [&](const base::Event& e) { return e.kind == kind; });
  return at == f.events.end() ? std::nullopt : std::optional(*at);
}

TEST(Decide, AHoldOfAMissionIsAPauseAndAnyOtherAStop) {
  // Given a mission that a silent radio pauses,
  Field mission;
  mission.drive_mission();
  mission.radio_speaks = false;
  mission.run(1.0);
  EXPECT_EQ(mission.state()->mode, Mode::Hold);
  ASSERT_TRUE(mission.has_event("mission_paused"));
  EXPECT_FALSE(mission.has_event("stopped"));
  // and a goal that the same stops
  Field goal;
  goal.run(8.0);
  ASSERT_TRUE(goal.ask(Arm{}));
  GoTo ahead;
  ahead.at = kFrame.to_global({0, 20});
  ASSERT_TRUE(goal.ask(ahead));
  goal.run(4.0);
  goal.radio_speaks = false;
  goal.run(1.0);
  EXPECT_EQ(goal.state()->mode, Mode::Hold);
  ASSERT_TRUE(goal.has_event("stopped"));
  EXPECT_FALSE(goal.has_event("mission_paused"));
  // then the event says why, as the pause does.
  EXPECT_EQ(event_of(mission, "mission_paused")->detail, mission.state()->mission.reason);
}

TEST(Decide, AMissionsCorridorCountsWhileItRunsAndOnlyThen) {
  Field f;
  f.fix_sigma_m = 0.3;
  f.run(8.0);
  auto plan = plan_of({{0, 20}});
  plan.settings.corridor_m = 0.1;
  ASSERT_TRUE(f.load(plan));
  ASSERT_TRUE(f.ask(Arm{}));
  f.run(1.0);
  EXPECT_FALSE(f.has_condition("corridor"));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.tick();
  EXPECT_TRUE(f.has_condition("corridor"));
  f.run(3.0);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  f.run(0.1);
  EXPECT_FALSE(f.has_condition("corridor"));
}

TEST(Decide, InAnotherMapItIsToldAnewThatThePlaceIsFound) {
  Field f;
  const auto see = [&f](const std::string& map, base::PlacePhase phase) {
    base::PlaceState place;
    place.stamp = f.now;
    place.phase = phase;
    place.map = map;
    f.robot.measurements().put(place);
    f.tick();
  };
  const auto found = [&f] {
    return std::count_if(f.events.begin(), f.events.end(),
                         [](const base::Event& e) { return e.kind == "place_known"; });
  };
  see("hall", base::PlacePhase::Searching);
  EXPECT_EQ(found(), 0);
  see("hall", base::PlacePhase::Known);
  see("hall", base::PlacePhase::Known);
  EXPECT_EQ(found(), 1);
  see("shed", base::PlacePhase::Searching);
  see("shed", base::PlacePhase::Known);
  EXPECT_EQ(found(), 2);
  see("", base::PlacePhase::Off);
  see("shed", base::PlacePhase::Known);
  EXPECT_EQ(found(), 3);
}

TEST(Decide, AnAnchorThatIsDroppedHoldsTheMission) {
  // Given a mission driven by a position that an operator anchored,
  Field f;
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of({{0, 20}})));
  SetAnchor anchor;
  anchor.at = kFrame.to_global({0.5, 0});
  const auto anchored = f.ask(anchor);
  ASSERT_TRUE(anchored) << anchored.error().detail;
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(4.0);
  ASSERT_EQ(f.execution(), ExecutionState::Running);
  // when the fix changes its class, then the robot holds, and says why.
  f.fix = base::FixType::Single;
  for (int i = 0; i < 1000 && !f.has_event("anchor_dropped"); ++i) f.tick();
  f.tick();
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  ASSERT_TRUE(f.has_event("mission_paused"));
  EXPECT_EQ(event_of(f, "mission_paused")->detail, "the anchor was dropped: the fix class changed");
}

TEST(Decide, WhatChangedAboutTheReceiverIsAnEvent) {
  Field f;
  f.run(8.0);
  f.fix = base::FixType::Single;
  f.run(6.0);
  ASSERT_TRUE(f.has_event("gnss_fix"));
  EXPECT_EQ(f.events.back().level, base::Severity::Warning);
}

TEST(Decide, FromTheTickOfAResetOnNothingIsClaimedThatIsNotKnown) {
  Field f;
  f.drive_mission();
  f.receiver_off = {60.0, 0.0};
  for (int i = 0; i < 1500 && !f.has_event("estimate_latched"); ++i) f.tick();
  ASSERT_TRUE(f.has_event("estimate_latched"));
  EXPECT_GT(f.state()->pose->horizontal_sigma_m, 2.0);
}

}  // namespace
}  // namespace roverd::robot
