// Missions, goals and parameters that make no sense, or hardly any: a clear refusal or a safe stop,
// against the true pose.

#include <random>

#include "rig.hpp"

namespace roverd::loop {
namespace {

TEST(BadInput, OneItemTwoEqualOnesAndLegsOfAMillimetre) {
  {
    Rig rig({});
    rig.arm_and_start(rig.plan_of({{0, 4}}));
    ASSERT_TRUE(rig.finish(60.0)) << rig.state()->mission.reason;
    EXPECT_LT(rig.distance_to_m({0, 4}), 0.15);
  }
  {
    Rig rig({});
    rig.arm_and_start(rig.plan_of({{0, 4}, {0, 4}, {0, 4.001}, {0, 4.002}, {0, 4.001}, {3, 4}}));
    ASSERT_TRUE(rig.finish(90.0)) << rig.state()->mission.reason;
    EXPECT_LT(rig.distance_to_m({3, 4}), 0.15);
    EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 4}, {3, 4}}), 0.4);
  }
}

TEST(BadInput, AMissionWhereItStandsFinishesWithoutADrive) {
  Rig rig({});
  rig.arm();
  base::LatLon here = rig.state()->pose->global;
  mission::Plan plan;
  mission::Waypoint w;
  w.at = here;
  plan.items.assign(2, w);
  rig.load(plan);
  rig.start();
  rig.track.clear();
  rig.run(10.0);
  EXPECT_EQ(rig.execution(), ExecutionState::Finished);
  const auto first = rig.track.front().local;
  for (const sim::Truth& t : rig.track) EXPECT_LT(base::distance_m(t.local, first), 0.3);
}

TEST(BadInput, ReversalsOfHalfATurnStayOnTheLine) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 6}, {0, 2}, {0, 6}, {0, 2}}));
  ASSERT_TRUE(rig.finish(150.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 6}), 0.4);
  EXPECT_LT(rig.distance_to_m({0, 2}), 0.15);
}

/// Its way crosses and repeats itself, and the next item often lies nearer than the one in hand.
TEST(BadInput, ItemsOutOfTheOrderOfProgressAreDrivenInTheirOrder) {
  Rig rig({});
  rig.arm_and_start(rig.plan_of({{0, 8}, {0, 3}, {4, 3}, {-4, 3}, {0, 3}, {0, 8}}));
  ASSERT_TRUE(rig.finish(240.0)) << rig.state()->mission.reason;
  std::string order;
  for (const auto& e : rig.events) {
    if (e.kind == "item_reached") order += e.detail.substr(5, 1);
  }
  EXPECT_EQ(order, "123456");
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 8}, {0, 3}, {4, 3}, {-4, 3}, {0, 3}}), 0.4);
}

TEST(BadInput, ALegOfNineKilometresIsBegunAndOneOfElevenRefused) {
  Rig rig({});
  rig.arm();
  auto plan = rig.plan_of({{0, 3}, {0, 9000}});
  rig.load(plan);
  rig.start();
  rig.track.clear();
  rig.run(20.0);
  EXPECT_EQ(rig.execution(), ExecutionState::Running);
  EXPECT_LT(rig.farthest_from_line_m({0, 0}, {0, 9000}), 0.3);
  EXPECT_NEAR(*rig.state()->mission.distance_left_m, 9000 - rig.truth().local.north_m, 1.0);
  const auto far = rig.robot.compile({"m2", 1, rig.plan_of({{0, 3}, {0, 11000}})});
  ASSERT_FALSE(far);
  ASSERT_FALSE(far.error().fields.empty());
  EXPECT_EQ(far.error().fields[0].pointer, "/items/1");
}

TEST(BadInput, HomeOnTheGoalIsHomeAtOnce) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 5}});
  plan.settings.at_end = mission::AtEnd::Return;
  plan.home = mission::Home{rig.place({0, 5}), {}};
  rig.arm_and_start(plan);
  ASSERT_TRUE(rig.finish(60.0)) << rig.state()->mission.reason;
  EXPECT_LT(rig.distance_to_m({0, 5}), 0.15);
  rig.track.clear();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Rtl}));
  rig.run(15.0);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  for (const sim::Truth& t : rig.track) {
    EXPECT_LT(std::hypot(t.local.east_m, t.local.north_m - 5.0), 0.35);
  }
}

TEST(BadInput, GoalsAndTargetsThatAreNoNumbersOrOfTheFutureAreRefused) {
  Rig rig({});
  rig.arm();
  const double nan = std::nan("");
  robot::GoTo goal;
  goal.local = base::EnuPoint{nan, 1.0};
  EXPECT_FALSE(rig.ask(goal));
  goal.local = base::EnuPoint{1.0, 1.0};
  goal.yaw_rad = nan;
  EXPECT_FALSE(rig.ask(goal));
  robot::GoTo stream;
  stream.yaw_rad = 0.0;
  stream.speed_mps = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(rig.ask(stream));
  robot::MoveBy move;
  move.forward_m = nan;
  EXPECT_FALSE(rig.ask(move));
  robot::SetTarget target;
  target.at = rig.place({0, 9});
  target.asked = Time{base::from_seconds(rig.now_s() + 30.0)};
  const auto future = rig.ask(target);
  ASSERT_FALSE(future);
  EXPECT_EQ(future.error().detail, "the target's time lies in the future");
  target.asked = Time{base::from_seconds(rig.now_s())};
  target.age_s = nan;
  EXPECT_FALSE(rig.ask(target));
  EXPECT_FALSE(rig.ask(robot::Drive{{nan, 0.0}, true}));
  rig.run(3.0);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  EXPECT_TRUE(rig.stands());
}

class Extremes : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Loop, Extremes, testing::Range(1, 9));

/// Every few seconds some parameter jumps to an end of its range while a mission is driven: the
/// robot keeps near its way or stands, and never goes faster than its base may.
TEST_P(Extremes, ParametersAtTheEndsOfTheirRangesNeverMakeItDriveOff) {
  Rig rig({});
  auto plan = rig.plan_of({{0, 10}, {10, 10}, {10, 0}, {0, 0}}, 1.0);
  plan.settings.at_end = mission::AtEnd::Repeat;
  rig.arm_and_start(plan);
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  const auto all = rig.robot.parameters();
  for (int i = 0; i < 40; ++i) {
    const auto& p = all[random() % all.size()];
    const bool steers = p.section == "nav.track" || p.section == "nav.speed" ||
                        p.section == "nav.pivot" || p.section == "nav.modes";
    if (!steers || !std::holds_alternative<double>(p.info.value)) continue;
    if (!p.info.min || !p.info.max) continue;
    const double to = random() % 2 == 0 ? *p.info.min : *p.info.max;
    (void)rig.ask(robot::SetParameter{p.section + "." + p.info.name, to});
    rig.run(3.0);
  }
  rig.run(3.0);
  EXPECT_LT(rig.farthest_from_path_m({{0, 0}, {0, 10}, {10, 10}, {10, 0}, {0, 0}}), 4.5);
  EXPECT_LT(rig.fastest_mps, 1.6);
  for (const sim::Truth& t : rig.track) EXPECT_LT(std::abs(t.twist.angular_radps), 1.2);
}

}  // namespace
}  // namespace roverd::loop
