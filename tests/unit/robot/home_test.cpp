// Home moves only on purpose, the driven way goes on over a stop, and both say where they lead.

#include "robot/modes/home.hpp"

#include "field.hpp"
#include "robot/modes/way_home.hpp"

namespace roverd::robot {
namespace {

const base::LatLon kHere{58.0, 26.0};
const base::LatLon kThere{58.001, 26.0};
const base::LatLon kElse{58.002, 26.0};

TEST(HomePlace, TheFirstPositionIsAssumedAndTheFirstArmingSetsIt) {
  HomePlace home;
  EXPECT_FALSE(home.at());
  home.assume(kHere);
  home.assume(kThere);
  EXPECT_EQ(home.at(), kHere);
  EXPECT_TRUE(home.arm(kThere, HomeAtArm::Keep));
  EXPECT_EQ(home.at(), kThere);
  EXPECT_FALSE(home.arm(kElse, HomeAtArm::Keep));
  EXPECT_EQ(home.at(), kThere);
}

TEST(HomePlace, WhatArmingDoesToItAfterwardsIsChosen) {
  struct Row {
    HomeAtArm rule;
    bool chosen;
    bool moves;
  };
  for (const Row& row :
       {Row{HomeAtArm::Keep, false, false}, Row{HomeAtArm::Keep, true, false},
        Row{HomeAtArm::UnlessChosen, false, true}, Row{HomeAtArm::UnlessChosen, true, false},
        Row{HomeAtArm::Here, false, true}, Row{HomeAtArm::Here, true, true}}) {
    HomePlace home;
    home.arm(kHere, row.rule);
    if (row.chosen) home.choose(kHere);
    EXPECT_EQ(home.arm(kThere, row.rule), row.moves);
    EXPECT_EQ(home.at(), row.moves ? kThere : kHere);
  }
}

TEST(HomePlace, OneThatWasChosenBeforeTheFirstArmingStays) {
  HomePlace home;
  home.choose(kElse);
  home.assume(kHere);
  EXPECT_FALSE(home.arm(kThere, HomeAtArm::Keep));
  EXPECT_EQ(home.at(), kElse);
}

TEST(HomePlace, TheRuleHasThreeWords) {
  EXPECT_EQ(home_at_arm_from("keep"), HomeAtArm::Keep);
  EXPECT_EQ(home_at_arm_from("unless_chosen"), HomeAtArm::UnlessChosen);
  EXPECT_EQ(home_at_arm_from("here"), HomeAtArm::Here);
  EXPECT_FALSE(home_at_arm_from("Keep"));
  EXPECT_FALSE(home_at_arm_from(""));
}

WayHomeFacts at_the_end() {
  WayHomeFacts f;
  f.here = {10.0, 10.0};
  f.home = base::EnuPoint{0.0, 0.0};
  return f;
}

TEST(WayHome, StraightItGoesToHomeAndSaysHowFar) {
  const WayHome way = straight_home(at_the_end());
  EXPECT_TRUE(way.refusal.empty());
  EXPECT_EQ(way.end, HomeEnd::Home);
  ASSERT_EQ(way.way.size(), 1u);
  EXPECT_NEAR(way.length_m({10.0, 10.0}), std::sqrt(200.0), 1e-9);
}

TEST(WayHome, WithoutAHomeThereIsNoWay) {
  WayHomeFacts f = at_the_end();
  f.home.reset();
  EXPECT_EQ(straight_home(f).refusal, "there is no home to return to");
  EXPECT_TRUE(straight_home(f).way.empty());
}

//   home
//    0 ──────── 10 m north, then 10 m east to the robot
TEST(WayHome, DrivenItGoesBackAlongTheWay) {
  DrivenWay driven;
  driven.back = {{10.0, 10.0}, {0.0, 10.0}, {0.0, 0.4}};
  const WayHome way = driven_home(at_the_end(), driven);
  EXPECT_TRUE(way.refusal.empty());
  EXPECT_EQ(way.end, HomeEnd::Home);
  EXPECT_EQ(way.way.back(), (base::EnuPoint{0.0, 0.0})) << "so near, home is meant";
  EXPECT_NEAR(way.length_m({10.0, 10.0}), 20.0, 1e-9);
  driven.back.back() = {0.0, 4.0};
  EXPECT_EQ(driven_home(at_the_end(), driven).end, HomeEnd::Begin);
  EXPECT_EQ(driven_home(at_the_end(), driven).way.back(), (base::EnuPoint{0.0, 4.0}));
}

TEST(WayHome, AWayThatWasNotSeenIsNotDriven) {
  DrivenWay driven;
  EXPECT_NE(driven_home(at_the_end(), driven).refusal.find("is not known"), std::string::npos);
  driven.back = {{10.0, 10.0}, {0.0, 0.0}};
  driven.longest_gap_m = 5.0;
  EXPECT_TRUE(driven_home(at_the_end(), driven).refusal.empty());
  driven.longest_gap_m = 7.6;
  const WayHome way = driven_home(at_the_end(), driven);
  EXPECT_EQ(way.refusal, "the driven way is not known over 8 m");
  EXPECT_EQ(way.way.size(), 2u) << "whoever looks is shown it";
}

// ---- the robot ----

double metres_from_start(const base::LatLon& at) {
  return base::distance_bearing(kFrame.origin(), at).distance_m;
}

/// Eight metres north of where it was armed.
void drive_away(Field& f) {
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  GoTo g;
  g.at = kFrame.to_global({0.0, 8.0});
  ASSERT_TRUE(f.ask(g));
  f.run(25.0);
  ASSERT_EQ(f.state()->activity.state, base::ActivityState::Reached);
}

TEST(Home, StaysOverAStopAndArmingAgainAndSoDoesTheWayBack) {
  for (const bool estop : {false, true}) {
    Field f;
    drive_away(f);
    ASSERT_LT(metres_from_start(*f.state()->home), 0.3);
    if (estop) {
      ASSERT_TRUE(f.ask(Estop{"x"}));
      ASSERT_TRUE(f.ask(ResetEstop{}));
    } else {
      ASSERT_TRUE(f.ask(Disarm{}));
    }
    f.run(1.0);
    ASSERT_TRUE(f.ask(Arm{}));
    EXPECT_LT(metres_from_start(*f.state()->home), 0.3);
    f.run(1.1);
    for (const Mode mode : {Mode::Rtl, Mode::SmartRtl}) {
      const auto way = f.robot.way_home(mode);
      ASSERT_TRUE(way);
      EXPECT_TRUE(way->possible) << way->reason;
      EXPECT_NEAR(*way->distance_m, 8.0, 0.5);
      EXPECT_LT(metres_from_start(*way->target), 0.7);
      EXPECT_EQ(way->end, "home");
    }
    ASSERT_TRUE(f.ask(SetMode{Mode::SmartRtl}));
    EXPECT_NEAR(*f.state()->activity.distance_m, 8.0, 0.6) << "told with the answer";
    f.run(40.0);
    EXPECT_LT(std::hypot(f.at.east_m, f.at.north_m), 0.7);
  }
}

TEST(Home, IsSetAnewByEachArmingWhereTheParameterSaysSo) {
  Config config;
  config.robot.home_at_arm = "here";
  Field f(config);
  drive_away(f);
  ASSERT_TRUE(f.ask(Disarm{}));
  f.run(1.0);
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_NEAR(metres_from_start(*f.state()->home), 8.0, 0.5);
  f.run(1.1);
  const auto way = f.robot.way_home(Mode::SmartRtl);
  ASSERT_TRUE(way);
  EXPECT_LT(*way->distance_m, 0.5) << "the way began anew with home";
  // A change of the parameter acts at the next arming.
  ASSERT_TRUE(f.ask(SetParameter{"robot.home_at_arm", base::ParamValue(std::string("keep"))}));
  ASSERT_TRUE(f.ask(Disarm{}));
  GoTo g;
  g.at = kFrame.to_global({0.0, 16.0});
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(g));
  f.run(25.0);
  ASSERT_TRUE(f.ask(Disarm{}));
  ASSERT_TRUE(f.ask(Arm{}));
  EXPECT_NEAR(metres_from_start(*f.state()->home), 8.0, 0.5);
  EXPECT_FALSE(f.ask(SetParameter{"robot.home_at_arm", base::ParamValue(std::string("there"))}));
}

TEST(Home, AWayThatWasDrivenByRadioWhileDisarmedIsKnownTooButNotOneThatWasCarried) {
  Field f;
  drive_away(f);
  ASSERT_TRUE(f.ask(Disarm{}));
  f.swb = base::Switch::Middle;
  f.obeys = false;
  f.does = {0.5, 0.0};
  f.run(8.0);  // four metres on
  f.does = {};
  f.run(1.0);
  f.swb = base::Switch::Up;
  f.obeys = true;
  f.run(2.0);
  ASSERT_TRUE(f.ask(Arm{}));
  f.run(1.1);
  const auto driven = f.robot.way_home(Mode::SmartRtl);
  ASSERT_TRUE(driven);
  EXPECT_TRUE(driven->possible) << driven->reason;
  EXPECT_NEAR(*driven->distance_m, 12.0, 0.7);
  ASSERT_TRUE(f.ask(Disarm{}));
  f.at.north_m += 30.0;
  f.run(25.0);  // until it is believed
  EXPECT_EQ(f.check("estimate").severity, base::Severity::Warning);
  EXPECT_NE(f.check("estimate").detail.find("while it was disarmed"), std::string::npos);
  ASSERT_TRUE(f.ask(Arm{}));
  f.run(1.1);
  const auto carried = f.robot.way_home(Mode::SmartRtl);
  ASSERT_TRUE(carried);
  EXPECT_FALSE(carried->possible);
  EXPECT_EQ(carried->reason.find("the driven way is not known over "), 0u) << carried->reason;
  const auto straight = f.robot.way_home(Mode::Rtl);
  EXPECT_TRUE(straight->possible) << straight->reason;
  EXPECT_NEAR(*straight->distance_m, 42.0, 1.5);
}

TEST(Home, ThePreviewSaysWhyNothingWouldHappen) {
  Field f;
  EXPECT_FALSE(f.robot.way_home(Mode::Auto));
  EXPECT_EQ(f.robot.way_home(Mode::Rtl)->reason, "the position is not known");
  drive_away(f);
  ASSERT_TRUE(f.ask(Disarm{}));
  f.run(1.1);
  const auto way = f.robot.way_home(Mode::Rtl);
  ASSERT_TRUE(way);
  EXPECT_FALSE(way->possible);
  EXPECT_EQ(way->reason, "the robot is not armed");
  EXPECT_NEAR(*way->distance_m, 8.0, 0.3) << "where it would go is shown all the same";
  ASSERT_EQ(way->line.size(), 2u);
  EXPECT_EQ(way->line.back(), *way->target);
  f.swb = base::Switch::Middle;
  f.run(1.0);
  EXPECT_FALSE(f.robot.way_home(Mode::SmartRtl)->possible);
  // What the preview says the command says.
  f.swb = base::Switch::Up;
  f.run(1.0);
  const auto refused = f.ask(SetMode{Mode::Rtl});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, f.robot.way_home(Mode::Rtl)->reason);
}

TEST(Home, AnItemThatSetsItBeginsTheWayAnew) {
  Field f;
  f.run(8.0);
  auto plan = plan_of({{0, 6}});
  mission::Action set_home;
  set_home.name = "set_home";
  plan.items.emplace_back(set_home);
  ASSERT_TRUE(f.load(plan));
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(30.0);
  ASSERT_EQ(f.execution(), ExecutionState::Finished);
  EXPECT_NEAR(metres_from_start(*f.state()->home), 6.0, 0.4);
  EXPECT_LT(*f.robot.way_home(Mode::SmartRtl)->distance_m, 0.6);
}

}  // namespace
}  // namespace roverd::robot
