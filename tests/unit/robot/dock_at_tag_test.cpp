// DOCK at a tag by the whole robot: what is asked for, what is refused, where it stands in truth.

#include "scenes.hpp"
#include "tag_scenes.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Pose2;

constexpr double kStandOff_m = 0.8;

class DockAtTag : public ::testing::Test {
 protected:
  Field f;
  Pose2 tag{0.6, 4.0, base::kPi / 2.0 - 0.15};
  std::shared_ptr<TagWall> wall;

  void begin() {
    wall = hang_tags(f, {{5, tag}});
    f.run(8.0);
    const auto armed = f.ask(Arm{});
    ASSERT_TRUE(armed) << armed.error().detail;
  }
  void run_until_over(double seconds) {
    for (int i = 0; i < seconds && f.state()->activity.state == base::ActivityState::Driving; ++i) {
      f.run(1.0);
    }
  }
  std::string last(const std::string& kind) const {
    std::string out;
    for (const auto& e : f.events) {
      if (e.kind == kind) out = e.detail;
    }
    return out;
  }
};

TEST_F(DockAtTag, StandsBeforeItWithinTwoCentimetresAndADegree) {
  begin();
  const auto asked = f.ask(dock_at(5));
  ASSERT_TRUE(asked) << asked.error().detail;
  EXPECT_EQ(f.state()->mode, Mode::Dock);
  EXPECT_EQ(f.state()->activity.tag, 5);
  run_until_over(120.0);
  EXPECT_EQ(last("docked"), "docked at tag 5") << f.state()->activity.reason;
  f.run(1.0);
  const Pose2 off = off_dock(f, tag, kStandOff_m);
  EXPECT_LT(std::hypot(off.x_m, off.y_m), 0.02);
  EXPECT_LT(std::abs(base::deg_from_rad(off.yaw_rad)), 1.0);
  EXPECT_EQ(f.state()->mode, Mode::Hold) << "and holds";
}

TEST_F(DockAtTag, NeedsNoSatellitesOnceItKnewWhereItWas) {
  begin();
  f.gnss_speaks = false;
  ASSERT_TRUE(f.ask(dock_at(5)));
  run_until_over(120.0);
  EXPECT_EQ(last("docked"), "docked at tag 5") << last("dock_failed");
}

TEST_F(DockAtTag, WithoutACameraThatReadsTagsItIsRefused) {
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  const auto asked = f.ask(dock_at(5));
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, base::Code::Conflict);
  EXPECT_EQ(asked.error().detail, "no camera that reads tags is configured");
  EXPECT_NE(f.state()->mode, Mode::Dock);
}

TEST_F(DockAtTag, ATagThatIsNotThereIsToldAndNothingMoves) {
  begin();
  const base::EnuPoint before = f.at;
  ASSERT_TRUE(f.ask(dock_at(6)));
  run_until_over(20.0);
  EXPECT_EQ(last("dock_failed"), "not docked at tag 6: the tag is not seen");
  EXPECT_EQ(f.at.north_m, before.north_m);
}

TEST_F(DockAtTag, CoveredOnTheWayItStopsAndSaysSo) {
  begin();
  ASSERT_TRUE(f.ask(dock_at(5)));
  f.run(2.0);
  wall->covered = true;
  run_until_over(120.0);
  EXPECT_EQ(last("dock_failed"), "not docked at tag 5: the tag is not seen any more");
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(last("docked"), "");
}

TEST_F(DockAtTag, APlaceInTheTagItselfIsRefused) {
  begin();
  SetMode to = dock_at(5);
  to.stand_off_m = 0.4;
  const auto asked = f.ask(to);
  ASSERT_FALSE(asked);
  EXPECT_EQ(asked.error().code, base::Code::Invalid);
  EXPECT_EQ(asked.error().fields.at(0).pointer, "/stand_off_m");
}

TEST_F(DockAtTag, AnItemOfAMissionDocksAndTheMissionGoesOn) {
  begin();
  mission::Plan plan;
  plan.name = "to the tag";
  plan.items.emplace_back(mission::Dock{5, {}});
  plan.items.emplace_back(mission::Move{-0.5});
  ASSERT_TRUE(f.load(plan));
  const auto started = f.ask(StartMission{"m", 1});
  ASSERT_TRUE(started) << started.error().detail;
  for (int i = 0; i < 120 && f.execution() == ExecutionState::Running; ++i) f.run(1.0);
  EXPECT_EQ(f.execution(), ExecutionState::Finished) << f.state()->mission.reason;
  const Pose2 off = off_dock(f, tag, kStandOff_m + 0.5);
  EXPECT_NEAR(off.x_m, 0.0, 0.06) << "half a metre back from the tag";
  EXPECT_NEAR(off.y_m, 0.0, 0.03);
}

TEST_F(DockAtTag, AnItemWhoseTagIsNotThereBlocksTheMissionWithTheReason) {
  begin();
  mission::Plan plan;
  plan.name = "to no tag";
  plan.items.emplace_back(mission::Dock{6, {}});
  ASSERT_TRUE(f.load(plan));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(6.0);
  EXPECT_EQ(f.execution(), ExecutionState::Blocked);
  EXPECT_EQ(last("blocked"), "item 1: not docked at tag 6: the tag is not seen");
}

TEST_F(DockAtTag, WhatIsSeenIsToldFromWhereTheRobotIsNow) {
  tag.y_m = 2.2;  // near enough for its direction to be known
  begin();
  const auto tags = f.state()->tags;
  ASSERT_TRUE(tags);
  ASSERT_EQ(tags->size(), 1U);
  const base::TagState& seen = tags->front();
  const Pose2 truth = nav::sense::inverse(Pose2{f.at.east_m, f.at.north_m, f.yaw_rad}) * tag;
  EXPECT_EQ(seen.id, 5);
  EXPECT_NEAR(seen.ahead_m, truth.x_m, 0.02);
  EXPECT_NEAR(seen.left_m, truth.y_m, 0.02);
  ASSERT_TRUE(seen.yaw_rad);
  EXPECT_NEAR(*seen.yaw_rad, truth.yaw_rad, 0.1);
  EXPECT_LT(base::seconds(f.now - seen.seen_at), 0.3);
}

}  // namespace
}  // namespace roverd::robot
