// The modes that drive by themselves, without a robot around them: every arrow of their machine.

#include "robot/modes/self_driving.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "robot/world.hpp"

namespace roverd::robot {
namespace {

using base::ActivityState;
using base::Mode;
using base::Time;

const base::LocalFrame kMap{3, {58.378, 26.729}};

/// A vehicle that does at once what it is told.
class Ideal {
 public:
  explicit Ideal(Mode of) : mode(of) {}

  ParameterSet set{Config{}};
  SelfDriving drive{set};
  Mode mode;
  base::EnuPoint at{};
  double yaw_rad = base::kPi / 2.0;
  base::BodyTwist does{};
  Time now{};
  SelfDriving::Step last;
  std::vector<SelfDriving::Ending> endings;

  nav::Vehicle vehicle() const {
    nav::Vehicle v;
    v.at = at;
    v.yaw_rad = yaw_rad;
    v.yaw_sigma_rad = 0.01;
    v.speed_mps = does.linear_mps;
    v.yaw_rate_radps = does.angular_radps;
    return v;
  }

  void step() {
    now += std::chrono::milliseconds(20);
    last = drive.step({mode, vehicle(), kMap, 1.0, now, 0.02});
    does = last.twist;
    at.east_m += does.linear_mps * 0.02 * std::cos(yaw_rad);
    at.north_m += does.linear_mps * 0.02 * std::sin(yaw_rad);
    yaw_rad = base::wrap_rad(yaw_rad + does.angular_radps * 0.02);
    if (last.ending) endings.push_back(*last.ending);
  }
  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds * 50.0); ++i) step();
  }
  ActivityState state() const { return drive.activity().state; }
  bool moves() const { return does != base::BodyTwist{}; }
};

nav::GuidedGoal point(double east_m, double north_m) {
  nav::GuidedGoal g;
  g.at = {east_m, north_m};
  return g;
}

TEST(SelfDriving, DoesNothingAtFirst) {
  Ideal v(Mode::Guided);
  EXPECT_EQ(v.state(), ActivityState::None);
  EXPECT_EQ(v.drive.activity().id, 0u);
  EXPECT_FALSE(v.drive.hold(Mode::Guided));
}

TEST(SelfDriving, AGoalIsDrivenToAndReachedOnce) {
  Ideal v(Mode::Guided);
  v.drive.go(point(0.0, 5.0), "goto", v.vehicle());
  EXPECT_EQ(v.state(), ActivityState::Driving);
  EXPECT_EQ(v.drive.activity().id, 1u);
  v.run(2.0);
  EXPECT_TRUE(v.last.drives);
  ASSERT_TRUE(v.drive.activity().distance_m);
  EXPECT_NEAR(*v.drive.activity().distance_m, 5.0 - v.at.north_m, 0.3);
  v.run(20.0);
  EXPECT_EQ(v.state(), ActivityState::Reached);
  ASSERT_EQ(v.endings.size(), 1u);
  EXPECT_STREQ(v.endings[0].kind, "goal_reached");
  EXPECT_EQ(v.endings[0].detail, "the goal of this goto is reached");
  EXPECT_FALSE(v.last.drives);
  EXPECT_FALSE(v.drive.activity().distance_m);
  EXPECT_NEAR(v.at.north_m, 5.0, 0.15);
  v.drive.go(point(0.0, 8.0), "goto", v.vehicle());
  EXPECT_EQ(v.state(), ActivityState::Driving);
  EXPECT_EQ(v.drive.activity().id, 2u);
}

TEST(SelfDriving, HomeIsToldWithItsDistanceBeforeItMoves) {
  Ideal v(Mode::SmartRtl);
  const base::LatLon home = kMap.to_global({0.0, 6.0});
  v.drive.go_home({{0.0, 3.0}, {0.0, 6.0}}, true, v.vehicle(), home, 6.0);
  EXPECT_EQ(v.drive.activity().kind, "retrace");
  EXPECT_EQ(v.drive.activity().goal, home);
  EXPECT_EQ(v.drive.activity().distance_m, 6.0);
  v.run(20.0);
  ASSERT_EQ(v.endings.size(), 1u);
  EXPECT_STREQ(v.endings[0].kind, "home_reached");
}

TEST(SelfDriving, TheRadioHoldsWhatIsUnderWayUntilItIsResumed) {
  Ideal v(Mode::Rtl);
  v.drive.go_home({{0.0, 9.0}}, false, v.vehicle(), kMap.to_global({0.0, 9.0}), 9.0);
  v.run(1.0);
  ASSERT_TRUE(v.moves());
  EXPECT_TRUE(v.drive.hold(Mode::Rtl));
  EXPECT_FALSE(v.drive.hold(Mode::Rtl)) << "told once";
  v.drive.interrupt();
  v.run(2.0);
  EXPECT_EQ(v.state(), ActivityState::Held);
  EXPECT_EQ(v.last.reason, "held");
  EXPECT_FALSE(v.moves());
  v.drive.go_on();
  v.run(1.0);
  EXPECT_EQ(v.state(), ActivityState::Driving);
  EXPECT_EQ(v.drive.activity().reason, "");
  EXPECT_TRUE(v.moves());
}

TEST(SelfDriving, WithoutAGoalThereIsNothingToHold) {
  Ideal v(Mode::Guided);
  v.drive.wait_for_goal();
  EXPECT_EQ(v.state(), ActivityState::Waiting);
  EXPECT_EQ(v.drive.activity().reason, "no goal yet");
  EXPECT_FALSE(v.drive.hold(Mode::Guided));
  v.run(0.2);
  EXPECT_EQ(v.state(), ActivityState::Waiting);
}

TEST(SelfDriving, RollingItStandsFirst) {
  Ideal v(Mode::Guided);
  v.does = {0.8, 0.0};
  v.drive.leave(Mode::Guided, "by the operator", true);
  v.drive.go(point(0.0, 5.0), "goto", v.vehicle());
  v.step();
  EXPECT_EQ(v.last.reason, "stopping");
  EXPECT_FALSE(v.moves());
  v.run(0.3);
  EXPECT_NE(v.last.reason, "stopping");
}

TEST(SelfDriving, AnotherModeEndsItWithTheReasonAndWhatIsOverStaysSo) {
  Ideal v(Mode::Guided);
  v.drive.go(point(0.0, 5.0), "move", v.vehicle());
  v.drive.leave(Mode::Hold, "by the operator", false);
  EXPECT_EQ(v.state(), ActivityState::Failed);
  EXPECT_EQ(v.drive.activity().reason, "ended by mode HOLD: by the operator");
  v.drive.go(point(0.0, 0.05), "move", v.vehicle());
  v.run(5.0);
  ASSERT_EQ(v.state(), ActivityState::Reached);
  v.drive.leave(Mode::Hold, "by the operator", false);
  EXPECT_EQ(v.state(), ActivityState::Reached);
}

TEST(SelfDriving, HeldItEndsWithAnotherModeToo) {
  Ideal v(Mode::Rtl);
  v.drive.go_home({{0.0, 9.0}}, false, v.vehicle(), kMap.to_global({0.0, 9.0}), 9.0);
  ASSERT_TRUE(v.drive.hold(Mode::Rtl));
  v.drive.leave(Mode::Hold, "emergency stop", false);
  EXPECT_EQ(v.state(), ActivityState::Failed);
  EXPECT_FALSE(v.drive.held().waits());
}

TEST(SelfDriving, ATargetIsNeededBeforeItIsFollowedAndItsLossIsTold) {
  Ideal v(Mode::Follow);
  EXPECT_NE(v.drive.follow_refusal(v.at, v.now), "");
  EXPECT_EQ(v.drive.take({{0.0, 12.0}, {}, v.now}, {}), "");
  EXPECT_EQ(v.drive.follow_refusal(v.at, v.now), "");
  v.drive.follow();
  v.run(0.9);
  EXPECT_EQ(v.state(), ActivityState::Driving);
  EXPECT_TRUE(v.drive.activity().target);
  v.run(0.5);
  EXPECT_EQ(v.state(), ActivityState::Waiting);
  EXPECT_EQ(v.drive.activity().reason, "the target is silent");
  v.run(4.0);
  EXPECT_EQ(v.state(), ActivityState::Failed);
  ASSERT_EQ(v.endings.size(), 1u);
  EXPECT_STREQ(v.endings[0].kind, "target_lost");
}

TEST(SelfDriving, DocksInThePose) {
  Ideal v(Mode::Dock);
  v.drive.dock({{0.0, 6.0}, base::kPi / 2.0, false}, v.vehicle());
  v.run(60.0);
  EXPECT_EQ(v.state(), ActivityState::Reached) << v.drive.activity().reason;
  EXPECT_NEAR(v.at.north_m, 6.0, 0.1);
  ASSERT_EQ(v.endings.size(), 1u);
  EXPECT_STREQ(v.endings[0].kind, "docked");
}

}  // namespace
}  // namespace roverd::robot
