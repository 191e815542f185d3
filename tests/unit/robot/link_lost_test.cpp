// The operator's link is lost while the robot drives by itself: by choice it goes on, holds, or
// returns.

#include "field.hpp"

namespace roverd::robot {
namespace {

class LinkLost : public testing::Test {
 protected:
  static Config config(const char* follows) {
    Config c;
    c.safety.link_lost = follows;
    c.safety.link_timeout_s = 3.0;
    return c;
  }

  /// Someone is there, until `heard` says no more; a mission of 20 m northwards runs.
  void drive(Field& f) {
    f.more = [this, &f] {
      if (heard) f.robot.measurements().put(base::OperatorLink{f.now, 1});
    };
    f.drive_mission();
  }

  bool heard = true;
};

TEST_F(LinkLost, AsDeliveredTheMissionGoesOnAndNothingIsShown) {
  Field f;
  drive(f);
  heard = false;
  f.run(8.0);
  EXPECT_FALSE(f.has_condition("link_lost"));
  EXPECT_EQ(f.execution(), ExecutionState::Running);
}

TEST_F(LinkLost, ItHoldsAfterTheTimeAndGoesOnOnlyWhenAnOperatorIsBackAndSaysSo) {
  Field f(config("hold"));
  drive(f);
  heard = false;
  f.run(2.9);
  EXPECT_TRUE(f.moves());
  f.run(0.3);
  EXPECT_FALSE(f.moves());
  EXPECT_TRUE(f.has_condition("link_lost"));
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_EQ(f.state()->mission.reason, "no operator has been heard for 3 s");
  EXPECT_FALSE(f.ask(ResumeMission{})) << "nobody watches";
  heard = true;
  f.run(5.0);
  EXPECT_FALSE(f.moves()) << "not by itself";
  EXPECT_FALSE(f.has_condition("link_lost"));
  ASSERT_TRUE(f.ask(ResumeMission{}));
  f.run(2.0);
  EXPECT_TRUE(f.moves());
}

TEST_F(LinkLost, ItReturnsHomeAndStandsThere) {
  Field f(config("return"));
  drive(f);
  ASSERT_GT(f.at.north_m, 1.5);
  heard = false;
  f.run(3.2);
  EXPECT_EQ(f.state()->mode, Mode::Rtl);
  EXPECT_TRUE(f.has_event("returns"));
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_EQ(f.state()->mission.reason, "no operator has been heard for 3 s");
  f.run(60.0);
  EXPECT_LT(std::hypot(f.at.east_m, f.at.north_m), 0.5);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  const auto refused = f.ask(ResumeMission{});
  ASSERT_FALSE(refused) << "it would be led home again";
  EXPECT_EQ(refused.error().detail.substr(0, 30), "no operator has been heard for");
}

TEST_F(LinkLost, WhereNoWayLeadsHomeItHoldsAndSaysBoth) {
  Field f(config("return"));
  drive(f);
  mission::Fence fence;
  fence.name = "strip";
  mission::FencePolygon p;
  for (const base::EnuPoint c :
       {base::EnuPoint{-6.0, f.at.north_m - 1.5}, base::EnuPoint{6.0, f.at.north_m - 1.5},
        base::EnuPoint{6.0, 60.0}, base::EnuPoint{-6.0, 60.0}}) {
    p.points.push_back(kFrame.to_global(c));
  }
  fence.areas.push_back({mission::AreaKind::Inclusion, p});
  ASSERT_TRUE(f.ask(SetFence{f.robot.lay_fence(std::make_shared<mission::Fence>(fence))}));
  heard = false;
  f.run(4.0);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_FALSE(f.moves());
  EXPECT_NE(f.state()->mission.reason.find(
                "no operator has been heard for 3 s, and there is no way home: "),
            std::string::npos)
      << f.state()->mission.reason;
}

TEST_F(LinkLost, OnItsWayHomeAndByHandItIsShownAndNothingFollows) {
  Field f(config("return"));
  drive(f);
  ASSERT_TRUE(f.ask(SetMode{Mode::SmartRtl}));
  heard = false;
  f.run(3.5);
  EXPECT_EQ(f.state()->mode, Mode::SmartRtl) << "it stays the way that was chosen";
  EXPECT_TRUE(f.has_condition("link_lost"));
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.run(1.0);
  EXPECT_EQ(f.state()->mode, Mode::Manual);
  EXPECT_TRUE(f.has_condition("link_lost"));
  EXPECT_EQ(f.state()->autonomy_refusal, "") << "the way home is open";
  const auto home = f.robot.way_home(Mode::Rtl);
  ASSERT_TRUE(home);
  EXPECT_TRUE(home->possible) << home->reason;
}

TEST_F(LinkLost, AReturnGivesWayToAHoldAndIsNotSlow) {
  Field f(config("return"));
  drive(f);
  f.run(6.0);
  heard = false;
  f.run(3.5);
  double fastest_mps = 0.0;
  for (int i = 0; i < 750 && fastest_mps < 0.6; ++i) {
    f.tick();
    fastest_mps = std::max(fastest_mps, f.command.twist.linear_mps);
  }
  ASSERT_EQ(f.state()->mode, Mode::Rtl);
  EXPECT_GE(fastest_mps, 0.6) << "it does not creep";
  f.radio_speaks = false;
  f.run(1.0);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_FALSE(f.moves());
}

TEST_F(LinkLost, WhoMustBeWatchedDoesNotStartAloneWhereItIsDemanded) {
  Field f(config("hold"));
  f.run(8.0);
  ASSERT_TRUE(f.load(plan_of({{0, 20}})));
  ASSERT_TRUE(f.ask(Arm{}));
  const auto refused = f.ask(StartMission{"m", 1});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "no operator has been heard yet");
  f.robot.measurements().put(base::OperatorLink{f.now, 1});
  f.tick();
  EXPECT_TRUE(f.ask(StartMission{"m", 1}));
}

}  // namespace
}  // namespace roverd::robot
