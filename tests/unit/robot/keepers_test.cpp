// Who keeps the mission, the fence and the driven way, each alone.

#include <cmath>

#include <gtest/gtest.h>

#include "field.hpp"
#include "robot/delivered.hpp"
#include "robot/mission_keeper.hpp"
#include "robot/modes/driven_way.hpp"
#include "robot/safety/fence_keep.hpp"

namespace roverd::robot {
namespace {

std::shared_ptr<const CompiledMission> compiled(const std::vector<base::EnuPoint>& points,
                                                std::int64_t revision = 1,
                                                const std::string& id = "m") {
  static std::uint64_t made = 100;
  MissionCopy copy{id, revision, plan_of(points)};
  auto route = nav::lay_route(copy.plan, kFrame, Config{}.path());
  EXPECT_TRUE(route);
  return std::make_shared<const CompiledMission>(
      CompiledMission{++made, std::move(copy), kFrame, std::move(*route)});
}

ReviseMission revision_of(const CompiledMission& from, EditKind kind, int item,
                          std::shared_ptr<const CompiledMission> to) {
  return {kind, item, from.copy.id, from.copy.revision, std::move(to)};
}

TEST(MissionKeeper, KeepsNothingAtFirst) {
  const ParameterSet set{Config{}};
  MissionKeeper keeper{set};
  EXPECT_FALSE(keeper);
  EXPECT_FALSE(keeper.in_hand());
  EXPECT_EQ(keeper.progress({}, {}, false).mission_id, "");
}

TEST(MissionKeeper, HandsBackWhatItReplaces) {
  const ParameterSet set{Config{}};
  MissionKeeper keeper{set};
  const auto first = compiled({{0, 20}});
  EXPECT_EQ(keeper.load(first), nullptr);
  EXPECT_EQ(keeper.executor.state(), ExecutionState::Loaded);
  EXPECT_EQ(keeper.name(), "mission \"field\" revision 1");
  EXPECT_EQ(keeper.load(compiled({{0, 5}}, 2)), first);
  EXPECT_EQ(keeper.unload()->copy.revision, 2);
  EXPECT_EQ(keeper.executor.state(), ExecutionState::Idle);
}

TEST(MissionKeeper, ARevisionNeedsTheOneItWasMadeFrom) {
  const ParameterSet set{Config{}};
  MissionKeeper keeper{set};
  const auto first = compiled({{0, 20}});
  const auto second = compiled({{0, 20}, {5, 20}}, 2);
  ReviseMission r = revision_of(*first, EditKind::AddWaypoint, 2, second);
  EXPECT_FALSE(keeper.may_revise(r)) << "nothing is loaded";
  keeper.load(first);
  EXPECT_TRUE(keeper.may_revise(r));
  r.from_revision = 7;
  EXPECT_EQ(keeper.may_revise(r).error().code, base::Code::Conflict);
}

TEST(MissionKeeper, ARevisionGoesOnAndOneToNothingEnds) {
  const ParameterSet set{Config{}};
  MissionKeeper keeper{set};
  const auto first = compiled({{0, 20}});
  keeper.load(first);
  ASSERT_TRUE(keeper.executor.start({}, {0, 0}, {}));
  EXPECT_TRUE(keeper.in_hand());
  EXPECT_FALSE(keeper.waits());
  const auto second = compiled({{0, 20}, {5, 20}}, 2);
  EXPECT_EQ(keeper.revise(revision_of(*first, EditKind::AddWaypoint, 2, second)), first);
  EXPECT_TRUE(keeper.executor.running());
  EXPECT_EQ(keeper.progress({}, {}, false).items, 2);
  keeper.executor.pause("x");
  EXPECT_TRUE(keeper.waits());
  EXPECT_EQ(keeper.revise(revision_of(*second, EditKind::Clear, 0, nullptr)), second);
  EXPECT_FALSE(keeper);
  EXPECT_EQ(keeper.executor.state(), ExecutionState::Idle);
}

TEST(MissionKeeper, SaysThatItGoesOnAfterTheRadio) {
  const ParameterSet set{Config{}};
  MissionKeeper keeper{set};
  keeper.load(compiled({{0, 20}}));
  ASSERT_TRUE(keeper.executor.start({}, {0, 0}, {}));
  EXPECT_EQ(keeper.progress({}, {}, false).reason, "");
  EXPECT_EQ(keeper.progress({}, {}, true).reason,
            "the radio drives; the mission goes on when it gives control back");
}

TEST(MissionKeeper, TriesAPlaceBeforeItTakesIt) {
  const ParameterSet set{Config{}};
  MissionKeeper keeper{set};
  const auto left = compiled({{0, 20}, {20, 20}});
  base::MissionPlace place;
  place.step = 99;
  EXPECT_FALSE(keeper.may_restore({left, place}, set, {0, 10}));
  place.step = 1;
  ASSERT_TRUE(keeper.may_restore({left, place}, set, {0, 20}));
  EXPECT_FALSE(keeper) << "it was only asked";
  keeper.load(left);
  keeper.restore(place);
  EXPECT_TRUE(keeper.waits());
  EXPECT_EQ(keeper.progress({}, {}, false).current_item, 2);
}

//   ●──────────────○~~~~~○      kept here, and 0.8 m later it stands
TEST(MissionKeeper, CountsHowFarItRolledOnAlongARowOrAWall) {
  mission::Plan plan;
  plan.items = {mission::Wall{mission::Side::Left, 0.9}, mission::Move{2.0}};
  const auto route = nav::lay_route(plan, kFrame, Config{}.path());
  ASSERT_TRUE(route) << route.error().detail;
  base::MissionPlace kept;
  kept.left = 3.0;
  kept.driving = true;
  kept.at = kFrame.to_global({1.0, 1.0});
  base::Pose pose;
  pose.global = kFrame.to_global({1.0, 1.8});
  pose.horizontal_sigma_m = 0.02;
  EXPECT_NEAR(rolled_on(*route, kept, pose).left, 3.8, 0.01);
  pose.horizontal_sigma_m = 0.6;
  EXPECT_EQ(rolled_on(*route, kept, pose).left, 3.0) << "nobody knows how far";
  pose.horizontal_sigma_m = 0.02;
  pose.global = kFrame.to_global({1.0, 5.0});
  EXPECT_EQ(rolled_on(*route, kept, pose).left, 3.0) << "it was carried";
  pose.global = kFrame.to_global({1.0, 1.8});
  kept.driving = false;
  EXPECT_EQ(rolled_on(*route, kept, pose).left, 3.0);
  kept.step = 99;
  EXPECT_EQ(rolled_on(*route, kept, pose).left, 3.0);
}

//        ╭~~○      kept at the dot: what it rolled on is not driven once more
//       ●
//      ╱
TEST(MissionKeeper, CountsHowFarItRolledOnAlongAnArcOrAMove) {
  mission::Plan plan;
  plan.items = {mission::TurnBy{90.0, std::nullopt, 1.25}, mission::Move{-2.0},
                mission::TurnBy{90.0, std::nullopt}, mission::Wait{1.0}};
  const auto route = nav::lay_route(plan, kFrame, Config{}.path());
  ASSERT_TRUE(route) << route.error().detail;
  base::Pose pose;
  pose.global = kFrame.to_global({1.0, 1.5});
  pose.horizontal_sigma_m = 0.02;
  const auto left = [&](int step, double kept_left) {
    base::MissionPlace kept;
    kept.step = step;
    kept.left = kept_left;
    kept.driving = true;
    kept.at = kFrame.to_global({1.0, 1.0});
    return rolled_on(*route, kept, pose).left;
  };
  // half a metre from end to end is an arc of 23 degrees
  const double rolled_rad = 2.0 * std::asin(0.25 / 1.25);
  EXPECT_NEAR(left(0, -1.2), -1.2 + rolled_rad, 1e-3);
  EXPECT_NEAR(left(0, 1.2), 1.2 - rolled_rad, 1e-3);
  EXPECT_NEAR(left(0, -0.2), -0.001, 1e-9) << "none would be all of it";
  EXPECT_EQ(left(0, 0.0), 0.0) << "it had not begun";
  EXPECT_NEAR(left(1, -1.5), -1.0, 1e-3);
  EXPECT_NEAR(left(1, -0.3), -0.01, 1e-9);
  EXPECT_EQ(left(2, -1.2), -1.2) << "on the spot";
}

// ---- the fence ----

//  10 ┌────────┐
//     │        │   an inclusion of 20 m
// −10 └────────┘
std::shared_ptr<LaidFence> yard(std::uint64_t id) {
  auto laid = std::make_shared<LaidFence>();
  mission::Fence fence;
  fence.name = "yard";
  mission::FencePolygon square;
  for (const base::EnuPoint p : {base::EnuPoint{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}) {
    square.points.push_back(kFrame.to_global(p));
  }
  fence.areas.push_back({mission::AreaKind::Inclusion, square});
  laid->id = id;
  laid->frame_id = kFrame.id();
  laid->limits = mission::CompiledFence(fence, kFrame);
  laid->fence = std::make_shared<const mission::Fence>(std::move(fence));
  return laid;
}

base::Pose standing_at(base::EnuPoint at) {
  base::Pose p;
  p.at = at;
  p.yaw_rad = base::kPi / 2.0;
  p.horizontal_sigma_m = 0.02;
  return p;
}

TEST(FenceKeep, NoneForbidsNothing) {
  FenceKeep keep;
  EXPECT_TRUE(keep.laid(std::nullopt));
  EXPECT_TRUE(keep.inside({0, 0}, {999, 0}, 1.0));
  EXPECT_TRUE(keep.may_begin({0, 0}, std::nullopt));
  EXPECT_FALSE(keep.judge({1.0, 0.0}, standing_at({0, 0}), kFrame, false, {}).stops);
}

TEST(FenceKeep, OneThatIsNotLaidInThisFrameForbidsAllButHands) {
  FenceKeep keep;
  keep.set(yard(1));
  const base::LocalFrame other{77, kFrame.origin()};
  EXPECT_FALSE(keep.may_begin({0, 0}, other));
  EXPECT_FALSE(keep.may_begin({0, 0}, std::nullopt));
  EXPECT_FALSE(keep.judge({0.5, 0.0}, standing_at({0, 0}), other, true, {}).stops);
  const auto verdict = keep.judge({0.5, 0.0}, standing_at({0, 0}), other, false, {});
  EXPECT_TRUE(verdict.stops);
  EXPECT_EQ(verdict.why, "the fence is not laid out in the robot's map");
}

TEST(FenceKeep, StopsAtItsLimitTellsItOnceAndLetsBack) {
  FenceKeep keep;
  keep.set(yard(1));
  EXPECT_TRUE(keep.may_begin({0, 0}, kFrame));
  EXPECT_FALSE(keep.may_begin({0, 11}, kFrame)) << "outside";
  EXPECT_TRUE(keep.inside({0, 0}, {0, 9}, 0.5));
  EXPECT_FALSE(keep.inside({0, 0}, {0, 9.8}, 0.5));
  FenceParams p;
  const auto pose = standing_at({0, 9.8});
  const auto first = keep.judge({0.5, 0.0}, pose, kFrame, true, p);
  EXPECT_TRUE(first.stops && first.newly);
  EXPECT_FALSE(keep.judge({0.5, 0.0}, pose, kFrame, true, p).newly);
  EXPECT_FALSE(keep.judge({0.0, 0.4}, pose, kFrame, true, p).stops) << "turning it may";
  EXPECT_FALSE(keep.judge({-0.5, 0.0}, pose, kFrame, true, p).stops) << "back it may";
  EXPECT_TRUE(keep.judge({0.5, 0.0}, pose, kFrame, true, p).newly) << "told anew";
}

TEST(FenceKeep, AMissionIsComparedBeforeItStarts) {
  FenceKeep keep;
  const auto mission = compiled({{0, 5}});
  const nav::PathParams path;
  const nav::BehaveParams behave;
  const FenceKeep::Start from{{{0, 0}}, base::EnuPoint{0, 0}, 0.5, path, behave};
  EXPECT_TRUE(keep.may_start(*mission, {}, from)) << "no fence";
  auto laid = yard(1);
  keep.set(laid);
  EXPECT_FALSE(keep.compared(mission.get(), from.margin_m));
  EXPECT_NE(keep.may_start(*mission, {}, from).error().detail.find("being compared"),
            std::string::npos);
  laid = yard(2);
  laid->mission_id = mission->id;
  laid->margin_m = from.margin_m;
  EXPECT_EQ(keep.set(laid)->id, 1u);
  EXPECT_TRUE(keep.compared(mission.get(), from.margin_m));
  EXPECT_TRUE(keep.may_start(*mission, {}, from));
  const FenceKeep::Start outside{{{0, 30}}, base::EnuPoint{0, 0}, 0.5, path, behave};
  EXPECT_FALSE(keep.may_start(*mission, {}, outside)) << "the way to the first point";
  laid = yard(3);
  laid->mission_id = mission->id;
  laid->margin_m = from.margin_m;
  laid->objection =
      mission::Finding{mission::Severity::Error, "outside_fence", "/items/0", 1, "lies outside"};
  keep.set(laid);
  EXPECT_EQ(keep.may_start(*mission, {}, from).error().detail, "item 1 lies outside");
}

TEST(FenceKeep, SaysHowNearItIs) {
  FenceKeep keep;
  keep.set(yard(1));
  const auto state = keep.state(standing_at({0, 7}), kFrame, nullptr, 0.5);
  EXPECT_EQ(state.name, "yard");
  EXPECT_TRUE(state.inside);
  EXPECT_NEAR(*state.distance_m, 3.0, 0.01);
  EXPECT_FALSE(keep.state(standing_at({0, 12}), kFrame, nullptr, 0.5).inside);
  EXPECT_FALSE(keep.state(std::nullopt, kFrame, nullptr, 0.5).distance_m);
}

// ---- the driven way ----

TEST(DrivenWayKeeper, BeginsWithArmingAndGoesOnWhileTheWheelsTurn) {
  DrivenWayKeeper keeper(0.5);
  const auto go = [&](double from_m, double to_m, bool armed, bool turning) {
    for (double x = from_m; x <= to_m; x += 0.1) {
      keeper.lay(standing_at({x, 0}), armed, turning, 0, nullptr);
    }
  };
  go(0, 3, false, true);
  EXPECT_TRUE(keeper.way(1).back.empty()) << "never armed";
  go(3, 6, true, true);
  go(6, 9, false, true);
  const DrivenWay known = keeper.way(1);
  EXPECT_NEAR(known.back.back().east_m, 3.0, 0.01);
  EXPECT_NEAR(known.back.front().east_m, 9.0, 0.6);
  EXPECT_LT(known.longest_gap_m, 0.01);
  go(9, 15, false, false);  // carried
  go(15, 17, true, true);
  EXPECT_NEAR(keeper.way(1).longest_gap_m, 6.2, 0.8);
  keeper.begin_anew(0.5);
  EXPECT_TRUE(keeper.way(1).back.empty());
}

TEST(DrivenWayKeeper, TellsNewsOnce) {
  DrivenWayKeeper keeper(0.5);
  std::uint64_t told = 0;
  EXPECT_EQ(keeper.news(told, 4), nullptr);
  keeper.lay(standing_at({0, 0}), true, false, 0, nullptr);
  const auto news = keeper.news(told, 4);
  ASSERT_NE(news, nullptr);
  EXPECT_EQ(news->frame_id, 4u);
  EXPECT_EQ(news->crumbs.size(), 1u);
  EXPECT_EQ(keeper.news(told, 4), nullptr);
}

// ---- values that must arrive ----

TEST(Delivered, ArrivesAlsoIfItIsNullAndTheNewestOneCounts) {
  Delivered<int> value;
  EXPECT_TRUE(value.deliver()) << "nothing is due";
  EXPECT_EQ(value.get(), nullptr);
  value.set(std::make_shared<const int>(1));
  value.set(std::make_shared<const int>(2));
  EXPECT_EQ(value.get(), nullptr) << "not before it is delivered";
  EXPECT_TRUE(value.deliver());
  EXPECT_EQ(*value.get(), 2);
  value.set(nullptr);
  EXPECT_TRUE(value.deliver());
  EXPECT_EQ(value.get(), nullptr);
}

}  // namespace
}  // namespace roverd::robot
