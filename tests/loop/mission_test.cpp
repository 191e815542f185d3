// Whole missions against the true pose, with an RTK receiver.

#include "rig.hpp"

namespace roverd::loop {
namespace {

const std::vector<Metres> kSquare{{0, 8}, {8, 8}, {8, 0}, {0, 0}};

class Mission : public testing::TestWithParam<std::uint64_t> {
 protected:
  RigOptions options(double heading_deg = 0.0) const {
    RigOptions o;
    o.seed = GetParam();
    o.heading_deg = heading_deg;
    return o;
  }
};
INSTANTIATE_TEST_SUITE_P(Loop, Mission, testing::Values(1, 2, 3));

//   1 ──▶ 2
//   ▲     │     starts at 4, looking north
//   │     ▼
//   4 ◀── 3
TEST_P(Mission, DrivesASquareThroughEveryWaypointAndStopsAtTheEnd) {
  Rig rig(options());
  rig.arm_and_start(rig.plan_of(kSquare));
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  for (const Metres& m : kSquare) EXPECT_LT(rig.nearest_m(m), 0.2);
  EXPECT_LT(rig.distance_to_m(kSquare.back()), 0.2);
  EXPECT_TRUE(rig.stands());
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 8}, {8, 8}, {8, 0}, {0, 0}}), 0.4);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  EXPECT_TRUE(rig.state()->armed);
}

//   ▲ starts looking north; the waypoint lies 10 m south
TEST_P(Mission, TurnsOnTheSpotWhenTheFirstWaypointIsBehind) {
  Rig rig(options());
  rig.arm_and_start(rig.plan_of({{0, -10}}));
  ASSERT_TRUE(rig.finish(90.0));
  EXPECT_LT(rig.nearest_m({0, -10}), 0.2);
  EXPECT_LT(rig.distance_to_m({0, -10}), 0.2);
  // No wide arc: a turn on the spot, then close to the line.
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, -10}), 0.7);
}

class EveryBias : public testing::TestWithParam<std::tuple<double, std::uint64_t>> {};
INSTANTIATE_TEST_SUITE_P(Loop, EveryBias,
                         testing::Combine(testing::Values(-20.0, 20.0),
                                          testing::Values(1ull, 2ull)));

TEST_P(EveryBias, ACompassThatIsFarOffCausesNoSwerve) {
  RigOptions o;
  o.plant.compass.bias_deg = std::get<0>(GetParam());
  o.seed = std::get<1>(GetParam());
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 15}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 5.0; }, 60.0));
  EXPECT_LT(std::abs(rig.yaw_error_deg()), 2.0);
  ASSERT_TRUE(rig.finish(90.0));
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 15}), 0.5);
  EXPECT_LT(rig.distance_to_m({0, 15}), 0.2);
}

TEST_P(Mission, FindsItsHeadingWithoutAnyCompass) {
  RigOptions o = options();
  o.plant.compass.fitted = false;
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{10, 0}, {10, 10}}));
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({10, 0}), 0.3);
  EXPECT_LT(rig.distance_to_m({10, 10}), 0.2);
}

TEST_P(Mission, RecoversFromACompassThatPointsTheOtherWay) {
  RigOptions o = options();
  o.plant.compass.bias_deg = 180.0;
  Rig rig(o);
  rig.arm_and_start(rig.plan_of({{0, 12}}));
  ASSERT_TRUE(rig.holds_until_a_person_looked(90.0)) << rig.state()->mission.reason;
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({0, 12}), 0.2);
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 12}), 2.5);
}

TEST_P(Mission, KeepsTheLineOfGentleBendsWithoutStopping) {
  Rig rig(options());
  const std::vector<Metres> way{{0, 0}, {0, 8}, {3, 15}, {3, 23}};
  rig.arm_and_start(rig.plan_of({way.begin() + 1, way.end()}));
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mission.current_item == 2; }, 60.0));
  const double s = rig.now_s();
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mission.current_item == 3; }, 60.0));
  EXPECT_LT(rig.now_s() - s, 20.0);
  EXPECT_GT(rig.truth().twist.linear_mps, 0.3);  // 23 deg: passed while driving
  ASSERT_TRUE(rig.finish(60.0));
  for (const Metres& m : way) EXPECT_LT(rig.nearest_m(m), 0.3);
  EXPECT_LT(rig.farthest_from_path_m(way), 0.4);
}

//   3 ◀── 2      arc: every corner is driven round, none pivoted
//         ▲
//   0 ──▶ 1
TEST_P(Mission, DrivesRoundSharpCornersWhenTheItemSaysArc) {
  Rig rig(options(90.0));
  auto plan = rig.plan_of({{8, 0}, {8, 8}, {0, 8}});
  for (auto& item : plan.items) std::get<mission::Waypoint>(item).turn = mission::Turn::Arc;
  rig.arm_and_start(plan);
  bool pivoted = false;
  ASSERT_TRUE(rig.run_until(
      [&] {
        pivoted |= rig.truth().driven_m > 12.0 && rig.state()->speed_reason == "pivot";
        return rig.execution() == ExecutionState::Finished;
      },
      120.0));
  EXPECT_FALSE(pivoted);
  for (const Metres m : {Metres{8, 0}, Metres{8, 8}, Metres{0, 8}}) {
    EXPECT_LT(rig.nearest_m(m), 0.5);
  }
}

TEST_P(Mission, ReversesWhenTheItemSaysSo) {
  Rig rig(options());
  auto plan = rig.plan_of({{0, 6}, {0, 1}});
  std::get<mission::Waypoint>(plan.items[1]).reverse = true;
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({0, 1}), 0.2);
  EXPECT_LT(std::abs(base::angle_diff_rad(rig.truth().yaw_rad, base::kPi / 2.0)), 0.2);
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 1}), 0.4);
}

TEST_P(Mission, DrivesBackAndForthUntilItIsStopped) {
  Rig rig(options());
  auto plan = rig.plan_of({{0, 6}, {6, 6}});
  plan.settings.at_end = mission::AtEnd::BackAndForth;
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.run_until([&] { return rig.distance_to_m({6, 6}) < 0.2; }, 90.0));
  ASSERT_TRUE(rig.run_until([&] { return rig.distance_to_m({0, 6}) < 0.2; }, 90.0));
  ASSERT_TRUE(rig.run_until([&] { return rig.distance_to_m({6, 6}) < 0.2; }, 90.0));
  ASSERT_TRUE(rig.ask(robot::StopMission{}));
  rig.run(2.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.execution(), ExecutionState::Aborted);
}

TEST_P(Mission, ReturnsHomeAtTheEnd) {
  Rig rig(options());
  auto plan = rig.plan_of({{0, 6}});
  plan.settings.at_end = mission::AtEnd::Return;
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(120.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.nearest_m({0, 6}), 0.2);
  EXPECT_LT(rig.distance_to_m({0, 0}), 0.25);
}

TEST(MissionOnce, RepeatsAJumpAsOftenAsItSays) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 3}, {0, 5}});
  plan.items.push_back(mission::Jump{1, 2});
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(240.0)) << rig.state()->mission.reason;
  const auto reached = std::count_if(rig.events.begin(), rig.events.end(), [](const auto& e) {
    return e.kind == "item_reached" && e.detail == "item 2 reached";
  });
  EXPECT_EQ(reached, 3);
  EXPECT_LT(rig.distance_to_m({0, 5}), 0.2);
}

TEST(MissionOnce, WaitsAndHoldsWhereTheMissionSays) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 3}, {0, 6}});
  std::get<mission::Waypoint>(plan.items[0]).hold_s = 3.0;
  plan.items.push_back(mission::Wait{4.0});
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.run_until([&] { return rig.has_event("item_reached"); }, 60.0));
  rig.run(2.5);
  EXPECT_LT(rig.distance_to_m({0, 3}), 0.2);
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mission.current_item == 3; }, 60.0));
  const double s = rig.now_s();
  ASSERT_TRUE(rig.finish(60.0));
  EXPECT_NEAR(rig.now_s() - s - 2.0, 4.0, 0.2);
}

TEST(MissionOnce, AFinishedMissionCanBeStartedAgain) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 4}, {4, 4}}));
  ASSERT_TRUE(rig.finish(90.0));
  rig.start();
  ASSERT_TRUE(rig.run_until([&] { return rig.distance_to_m({0, 4}) < 0.2; }, 60.0));
  ASSERT_TRUE(rig.finish(90.0));
  EXPECT_LT(rig.distance_to_m({4, 4}), 0.2);
}

TEST(MissionOnce, PausesAndGoesOnFromTheSamePlace) {
  Rig rig({});
  const std::vector<Metres> way{{0, 0}, {0, 8}, {8, 8}};
  rig.arm_and_start(rig.plan_of({{0, 8}, {8, 8}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 4.0; }, 60.0));
  ASSERT_TRUE(rig.ask(robot::PauseMission{}));
  const auto at = rig.truth().local;
  rig.run(5.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_LT(base::distance_m(at, rig.truth().local), 0.6);
  EXPECT_EQ(rig.execution(), ExecutionState::Paused);
  ASSERT_TRUE(rig.ask(robot::ResumeMission{}));
  ASSERT_TRUE(rig.finish(90.0));
  EXPECT_LT(rig.farthest_from_path_m(way), 0.4);
  EXPECT_LT(rig.nearest_m({0, 8}), 0.2);
}

TEST(MissionOnce, SkipsToAnotherItem) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 20}, {5, 0}}));
  ASSERT_TRUE(rig.run_until([&] { return rig.truth().driven_m > 1.0; }, 60.0));
  ASSERT_TRUE(rig.ask(robot::SkipItem{0}));
  ASSERT_TRUE(rig.finish(90.0));
  EXPECT_LT(rig.distance_to_m({5, 0}), 0.2);
  EXPECT_GT(rig.nearest_m({0, 20}), 15.0);
}

}  // namespace
}  // namespace roverd::loop
