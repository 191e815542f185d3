// How often a mission is driven, how it ends, and what follows when an item cannot be reached:
// against the true pose.

#include "rig.hpp"

namespace roverd::loop {
namespace {

long count_of(const RigBase& rig, const std::string& kind, const std::string& detail = {}) {
  return std::count_if(rig.events.begin(), rig.events.end(), [&](const base::Event& e) {
    return e.kind == kind && (detail.empty() || e.detail == detail);
  });
}

/// How often the true robot came within `near_m` of a place.
int visits(const RigBase& rig, Metres m, double near_m = 0.25) {
  int n = 0;
  bool there = false;
  for (const sim::Truth& t : rig.track) {
    const double far_m = std::hypot(t.local.east_m - m.east_m, t.local.north_m - m.north_m);
    if (!there && far_m < near_m) ++n;
    if (far_m < near_m) there = true;
    if (far_m > near_m + 0.5) there = false;
  }
  return n;
}

class Times : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Loop, Times, testing::Values(1, 2, 3));

//   0 ──▶ 1
//    ╲    ▼
//     ╲── 2
TEST_P(Times, ALoopIsDrivenSoOften) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 4}, {4, 4}, {4, 0}});
  plan.settings.at_end = mission::AtEnd::Repeat;
  plan.settings.times = GetParam();
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  EXPECT_EQ(visits(rig, {4, 4}), GetParam());
  EXPECT_EQ(visits(rig, {4, 0}), GetParam());
  EXPECT_EQ(count_of(rig, "mission_lap"), GetParam() - 1);
  EXPECT_LT(rig.distance_to_m({4, 0}), 0.2);
  EXPECT_TRUE(rig.stands());
}

//   1 ⇄ 2 ⇄ 3: each way counts
TEST_P(Times, AWayIsDrivenThereAndBackSoOften) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 3}, {0, 6}, {3, 6}});
  plan.settings.at_end = mission::AtEnd::BackAndForth;
  plan.settings.times = GetParam();
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  EXPECT_EQ(visits(rig, {0, 6}), GetParam());
  const bool back = GetParam() % 2 == 0;
  EXPECT_LT(rig.distance_to_m(back ? Metres{0, 3} : Metres{3, 6}), 0.2);
}

TEST(Endings, ForEverGoesOnUntilItIsStopped) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 3}, {3, 3}});
  plan.settings.at_end = mission::AtEnd::Repeat;
  plan.settings.times = 0;
  rig.arm_and_start(plan);
  rig.run_until([&] { return count_of(rig, "mission_lap") >= 4; }, 200.0);
  EXPECT_EQ(count_of(rig, "mission_lap"), 4);
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
}

/// The count outlives a power cut.
TEST(Endings, TheLapsThatWereDrivenAreKept) {
  std::optional<base::MissionPlace> place;
  sim::Truth at;
  mission::Plan plan;
  {
    Rig rig({});
    plan = rig.plan_of({{0, 4}, {4, 4}, {4, 0}});
    plan.settings.at_end = mission::AtEnd::Repeat;
    plan.settings.times = 2;
    rig.arm_and_start(plan);
    ASSERT_TRUE(rig.run_until([&] { return rig.has_event("mission_lap"); }, 100.0));
    ASSERT_TRUE(rig.run_until(
        [&] { return rig.state()->mission.current_item == 2 && rig.truth().local.east_m > 1.0; },
        60.0));
    place = rig.state()->mission.place;
    ASSERT_TRUE(rig.ask(robot::StopMission{}));
    rig.run(2.0);
    at = rig.truth();
  }
  ASSERT_TRUE(place);
  EXPECT_EQ(place->laps, 1);
  RigOptions o;
  o.heading_deg = base::heading_from_yaw(at.yaw_rad);
  Rig rig(o);
  rig.plant.place(at.at, o.heading_deg);
  rig.arm();
  const auto compiled = rig.robot.compile({"m1", 1, plan});
  ASSERT_TRUE(compiled);
  const auto resumed = rig.ask(robot::ResumeAt{*compiled, *place});
  ASSERT_TRUE(resumed) << resumed.error().detail;
  ASSERT_TRUE(rig.finish(100.0)) << rig.state()->mission.reason;
  EXPECT_FALSE(rig.has_event("mission_lap"));
  EXPECT_LT(rig.distance_to_m({4, 0}), 0.2);
}

TEST(Endings, HoldStandsAtTheLastItem) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 5}, {4, 5}}));
  ASSERT_TRUE(rig.finish(90.0));
  rig.run(5.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_LT(rig.distance_to_m({4, 5}), 0.15);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
}

TEST(Endings, AFinishedMissionIsNotGoneOnWith) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 4}}));
  ASSERT_TRUE(rig.finish(60.0));
  const auto refused = rig.ask(robot::SetMode{Mode::Auto});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, base::Code::Conflict);
  EXPECT_EQ(refused.error().detail,
            "the mission is finished: there is none to go on with; start it");
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
}

/// Jumps count anew in each lap, and one within another each time.
TEST(Endings, JumpsCountInEachLap) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 2}, {0, 4}});
  plan.items.push_back(mission::Jump{1, 1});
  plan.settings.at_end = mission::AtEnd::Repeat;
  plan.settings.times = 2;
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(300.0)) << rig.state()->mission.reason;
  EXPECT_EQ(count_of(rig, "item_reached", "item 2 reached"), 4);
}

/// The way and the time that are left fall as the robot drives, and are right at the start.
TEST(Endings, TheTimeThatIsLeftIsTheTimeThatItTakes) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 8}, {8, 8}, {8, 0}});
  std::get<mission::Waypoint>(plan.items[1]).hold_s = 10.0;
  plan.settings.at_end = mission::AtEnd::Repeat;
  plan.settings.times = 2;
  rig.arm_and_start(plan);
  rig.run(3.0);
  const double eta_s = rig.state()->mission.eta_s.value_or(0.0);
  const double left_m = rig.state()->mission.distance_left_m.value_or(0.0);
  const double from_s = rig.now_s();
  const double from_m = rig.truth().driven_m;
  ASSERT_TRUE(rig.run_until([&] { return rig.execution() == ExecutionState::Finished; }, 300.0));
  EXPECT_NEAR(eta_s, rig.now_s() - from_s, 0.12 * eta_s);
  EXPECT_NEAR(left_m, rig.truth().driven_m - from_m, 0.05 * left_m);
}

// ---- an item that cannot be reached ----

RigOptions impatient(const char* rule) {
  RigOptions o;
  o.robot.behave.unreachable = rule;
  o.robot.behave.stuck_s = 3.0;
  o.robot.safety.follow_timeout_s = 10.0;  // else the base is what is complained of
  return o;
}

/// The tracks hardly turn for a while.
void push_in_vain(RigBase& rig, double seconds) {
  const sim::Params well = rig.plant.params();
  sim::Params stuck = well;
  stuck.drive.max_linear_mps = stuck.drive.max_angular_radps = 0.03;
  rig.plant.set_params(stuck);
  rig.run(seconds);
  rig.plant.set_params(well);
}

void get_stuck_under_way(Rig& rig) {
  rig.arm_and_start(rig.plan_of({{0, 10}, {4, 2}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().local.north_m > 3.0; }, 60.0));
  push_in_vain(rig, 5.0);
}

TEST(Unreachable, StopsAndSaysWhy) {
  Rig rig(impatient("stop"));
  get_stuck_under_way(rig);
  rig.run(3.0);
  EXPECT_EQ(rig.execution(), ExecutionState::Blocked);
  EXPECT_TRUE(rig.stands());
  EXPECT_NE(rig.state()->mission.reason.find("no progress"), std::string::npos);
  ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 10}), 0.2);
}

TEST(Unreachable, OrLeavesItOut) {
  Rig rig(impatient("skip"));
  get_stuck_under_way(rig);
  ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
  EXPECT_TRUE(rig.has_event("item_missed"));
  EXPECT_GT(rig.nearest_m({0, 10}), 4.0);
  EXPECT_LT(rig.distance_to_m({4, 2}), 0.2);
}

TEST(Unreachable, OrReturnsHome) {
  Rig rig(impatient("return"));
  get_stuck_under_way(rig);
  ASSERT_TRUE(rig.run_until([&] { return rig.execution() == ExecutionState::Aborted; }, 90.0));
  rig.run(2.0);
  EXPECT_LT(rig.distance_to_m({0, 0}), 0.3);
  EXPECT_GT(rig.nearest_m({0, 10}), 4.0);
  EXPECT_NE(rig.state()->mission.reason.find("returned home"), std::string::npos);
}

}  // namespace
}  // namespace roverd::loop
