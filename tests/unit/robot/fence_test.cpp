// The fence has the last word, whoever drives.

#include "field.hpp"

namespace roverd::robot {
namespace {

/// A square of 2·half metres around the field's origin.
std::shared_ptr<mission::Fence> square(double half_m) {
  auto fence = std::make_shared<mission::Fence>();
  fence->name = "yard";
  mission::FencePolygon p;
  for (const base::EnuPoint c : {base::EnuPoint{-half_m, -half_m}, base::EnuPoint{half_m, -half_m},
                                 base::EnuPoint{half_m, half_m}, base::EnuPoint{-half_m, half_m}}) {
    p.points.push_back(kFrame.to_global(c));
  }
  fence->areas.push_back({mission::AreaKind::Inclusion, p});
  return fence;
}

struct Fenced : Field {
  explicit Fenced(std::shared_ptr<const mission::Fence> fence, const Config& config = {})
      : Field(config) {
    run(8.0);
    EXPECT_TRUE(ask(SetFence{robot.lay_fence(std::move(fence))}));
    EXPECT_TRUE(ask(Arm{}));
  }
  GoTo to(base::EnuPoint p) const {
    GoTo g;
    g.at = kFrame.to_global(p);
    return g;
  }
  /// By hand, with the handle held.
  void stick(double speed_mps, double seconds) {
    let_go();
    for (double t = 0.0; t < seconds; t += 0.1) {
      robot.request(Drive{{speed_mps, 0.0}, true}, now + std::chrono::milliseconds(250), {});
      run(0.1);
    }
  }
};

//   ┌─────────┐
//   │    ▲ stops before the limit, whoever drives
//   │    │    │
//   └─────────┘
TEST(Fence, ByHandItStopsInsideAndTheWayBackIsOpen) {
  Fenced f(square(6.0));
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.stick(1.0, 12.0);
  EXPECT_LT(f.at.north_m, 5.6);
  EXPECT_GT(f.at.north_m, 3.5);
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.has_condition("fence"));
  EXPECT_TRUE(f.has_event("fence"));
  EXPECT_EQ(f.state()->mode, Mode::Manual);
  ASSERT_TRUE(f.state()->fence);
  EXPECT_TRUE(f.state()->fence->inside);
  EXPECT_NEAR(*f.state()->fence->distance_m, 6.0 - f.at.north_m, 0.2);
  const double stopped_m = f.at.north_m;
  f.stick(-0.5, 4.0);
  EXPECT_LT(f.at.north_m, stopped_m - 0.8);
}

TEST(Fence, AGoalOrHomeOutsideIsRefusedBeforeAnythingMoves) {
  Fenced f(square(6.0));
  const auto refused = f.ask(f.to({0, 9}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "the way there leaves the fence");
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_TRUE(f.ask(f.to({0, 4})));
  ASSERT_TRUE(f.ask(SetHome{kFrame.to_global({20, 0})}));
  const auto home = f.ask(SetMode{Mode::Rtl});
  ASSERT_FALSE(home);
  EXPECT_EQ(home.error().detail,
            "neither home nor a rally point can be reached straight inside the fence");
}

TEST(Fence, RtlGoesToTheNearestPlaceThatCanBeReached) {
  auto fence = square(8.0);
  fence->rally.push_back({kFrame.to_global({-5, 5}), {}});
  fence->rally.push_back({kFrame.to_global({30, 0}), {}});  // outside
  Fenced f(fence);
  ASSERT_TRUE(f.ask(SetHome{kFrame.to_global({7, -7})}));
  f.run(0.1);
  ASSERT_TRUE(f.ask(SetMode{Mode::Rtl}));
  f.run(40.0);
  EXPECT_NEAR(f.at.east_m, -5.0, 0.3);
  EXPECT_NEAR(f.at.north_m, 5.0, 0.3);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_TRUE(f.has_event("home_reached"));
}

TEST(Fence, AMissionThatLeavesItIsRefusedWithTheItem) {
  Fenced f(square(10.0));
  ASSERT_TRUE(f.load(plan_of({{0, 5}, {5, 5}, {5, 14}, {5, 0}})));
  const auto refused = f.ask(StartMission{"m", 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "item 3 lies outside the fence");
  // The same when the fence comes after the mission.
  ASSERT_TRUE(f.ask(SetFence{}));
  ASSERT_TRUE(f.ask(SetFence{f.robot.lay_fence(square(4.0))}));
  const auto later = f.ask(StartMission{"m", 1});
  ASSERT_FALSE(later);
  EXPECT_EQ(later.error().detail, "item 1 lies outside the fence");
}

TEST(Fence, TheWayHomeAtTheEndCountsToo) {
  Fenced f(square(10.0));
  auto plan = plan_of({{0, 5}});
  plan.settings.at_end = mission::AtEnd::Return;
  plan.home = mission::Home{kFrame.to_global({0, -20}), {}};
  ASSERT_TRUE(f.load(plan));
  const auto refused = f.ask(StartMission{"m", 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "the mission's way home leaves the fence");
}

/// Before anything is armed: what the list says is what the start says then.
std::string objection(Fenced& f, const mission::Plan& plan) {
  EXPECT_TRUE(f.load(plan));
  const auto found = f.robot.objections(StartMission{"m", 1});
  const auto refused = f.ask(StartMission{"m", 1});
  if (found.empty()) {
    EXPECT_TRUE(refused);
    EXPECT_TRUE(f.ask(StopMission{}));
    return {};
  }
  EXPECT_FALSE(refused);
  if (refused) return "started";
  EXPECT_EQ(refused.error().detail, mission::sentence(found.front()));
  EXPECT_EQ(refused.error().fields.front().pointer, found.front().pointer);
  return found.front().code + " " + found.front().pointer;
}

//      ┌──┐ 3      the robot stands below a hole; items lie round it
//   2  │  │
//      └──┘
//      1 ▲
TEST(Fence, WhatAStartRefusesIsListedBeforeWithItsItem) {
  auto fence = square(14.0);
  mission::FencePolygon hole;
  for (const base::EnuPoint c :
       {base::EnuPoint{-1, 4}, base::EnuPoint{1, 4}, base::EnuPoint{1, 8}, base::EnuPoint{-1, 8}}) {
    hole.points.push_back(kFrame.to_global(c));
  }
  fence->areas.push_back({mission::AreaKind::Exclusion, hole});
  Fenced f(fence);
  EXPECT_EQ(objection(f, plan_of({{0, 12}, {5, 12}})), "approach_outside_fence /items/0");
  const auto round = plan_of({{-6, 2}, {-6, 11}, {0, 11}});
  EXPECT_EQ(objection(f, round), "");
  auto home = round;
  home.settings.at_end = mission::AtEnd::Return;
  EXPECT_EQ(objection(f, home), "outside_fence /settings/at_end");
  auto item = round;
  item.items.push_back(mission::ReturnHome{});
  EXPECT_EQ(objection(f, item), "outside_fence /items/3");
  auto jump = plan_of({{0, 1}, {-6, 1}, {-6, 11}, {0, 11}});
  jump.items.push_back(mission::Jump{1, 2});
  EXPECT_EQ(objection(f, jump), "outside_fence /items/4");
  auto laps = plan_of({{0, 1}, {-6, 1}, {-6, 11}, {0, 11}});
  laps.settings.at_end = mission::AtEnd::Repeat;
  EXPECT_EQ(objection(f, laps), "outside_fence /settings/at_end");
  EXPECT_EQ(objection(f, plan_of({{-6, 2}, {-6, 20}})), "outside_fence /items/1");
}

TEST(Fence, AFirstItemTooFarAwayIsListedAlsoWithoutAFence) {
  Fenced f(nullptr);
  EXPECT_EQ(objection(f, plan_of({{0, 70}, {0, 80}})), "start_too_far /items/0");
}

TEST(Fence, OutsideOnlyTheWayBackByHandIsOpen) {
  Fenced f(nullptr);
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.stick(1.0, 12.0);
  ASSERT_GT(f.at.north_m, 8.0);
  ASSERT_TRUE(f.ask(SetFence{f.robot.lay_fence(square(6.0))}));
  const auto refused = f.ask(f.to({0, 0}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "the robot stands outside of the fence: drive it back by hand");
  const double there_m = f.at.north_m;
  f.stick(0.5, 1.0);
  EXPECT_NEAR(f.at.north_m, there_m, 0.05);
  f.stick(-1.0, 12.0);
  EXPECT_LT(f.at.north_m, 5.0);
}

TEST(Fence, OneThatContainsNothingLetsNothingDrive) {
  auto fence = square(6.0);
  fence->areas.push_back({mission::AreaKind::Exclusion, square(9.0)->areas[0].shape});
  Fenced f(fence);
  EXPECT_FALSE(f.ask(f.to({0, 1})));
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.stick(1.0, 3.0);
  EXPECT_NEAR(f.at.north_m, 0.0, 0.05);
}

TEST(Fence, AMissionStopsWhereAFenceAppears) {
  Field f;
  f.drive_mission();
  ASSERT_TRUE(f.ask(SetFence{f.robot.lay_fence(square(9.0))}));
  f.run(15.0);
  EXPECT_LT(f.at.north_m, 8.6);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
}

}  // namespace
}  // namespace roverd::robot
