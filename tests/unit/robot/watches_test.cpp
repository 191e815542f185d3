// What watches the base, the estimate and the position, each alone.

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "robot/loop_clock.hpp"
#include "robot/safety/base_watch.hpp"
#include "robot/safety/certainty.hpp"
#include "robot/safety/estimate_watch.hpp"
#include "robot/safety/position_watch.hpp"

namespace roverd::robot {
namespace {

using std::chrono::milliseconds;

// ---- the base ----

/// A base that is asked to stand, tick by tick.
struct Asked {
  World world;
  SafetyParams params;
  BaseWatch watch;
  bool armed = true;
  bool radio = false;
  bool listens = true;
  bool well = true;
  base::BodyTwist told{};
  base::BodyTwist does{};
  Time now{};
  int left = 0, back = 0, disobeys = 0, obeys = 0;

  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds * 50.0); ++i) {
      now += milliseconds(20);
      base::BaseStatus s;
      s.stamp = now;
      s.vehicle_state = well ? base::VehicleState::Normal : base::VehicleState::Exception;
      s.control_mode = listens ? base::ControlMode::Can : base::ControlMode::Standby;
      world.take(base::Measurement(s));
      world.take(base::Measurement(base::BaseMotion{now, does}));
      const auto news = watch.step({world, params, armed, radio, {told, true}, told}, now);
      left += news.left ? 1 : 0;
      back += news.back ? 1 : 0;
      disobeys += news.disobeys ? 1 : 0;
      obeys += news.obeys ? 1 : 0;
    }
  }
};

TEST(BaseWatch, WaitsFromTheMomentThatItDoesNotListen) {
  Asked a;
  a.listens = false;
  a.run(1.0);
  ASSERT_TRUE(a.watch.waited_since());
  EXPECT_NEAR(base::seconds(a.now - *a.watch.waited_since()), 0.98, 1e-6);
  a.listens = true;
  a.run(0.02);
  EXPECT_FALSE(a.watch.waited_since());
}

TEST(BaseWatch, NobodyWaitsWhileDisarmedOrDrivenByRadio) {
  for (const bool radio : {true, false}) {
    Asked a;
    a.listens = false;
    a.armed = radio;
    a.radio = radio;
    a.run(1.0);
    EXPECT_FALSE(a.watch.waited_since());
  }
}

TEST(BaseWatch, OneThatListenedAndStopsListeningHasLeftAndComesBack) {
  Asked a;
  a.run(1.0);
  a.listens = false;
  a.run(1.0);
  EXPECT_EQ(a.left, 1) << "told once";
  EXPECT_EQ(a.back, 0);
  a.listens = true;
  a.run(1.0);
  EXPECT_EQ(a.back, 1);
  EXPECT_EQ(a.left, 1);
}

TEST(BaseWatch, BeforeItHasSettledNothingIsConcluded) {
  Asked a;
  a.run(0.4);
  a.listens = false;
  a.run(1.0);
  EXPECT_EQ(a.left, 0);
  Asked ill;
  ill.run(1.0);
  ill.listens = ill.well = false;
  ill.run(1.0);
  EXPECT_EQ(ill.left, 0) << "an exception is another matter";
}

TEST(BaseWatch, OneThatDoesNotMoveAsToldIsNamedUntilItDoes) {
  Asked a;
  a.run(1.0);
  a.told = {0.5, 0.0};
  a.run(1.5);
  EXPECT_EQ(a.disobeys, 1);
  EXPECT_TRUE(a.watch.commands_lost());
  EXPECT_TRUE(a.watch.disobeys_now());
  a.told = {};
  a.run(1.0);
  EXPECT_TRUE(a.watch.commands_lost()) << "standing proves nothing";
  EXPECT_FALSE(a.watch.disobeys_now());
  a.told = a.does = {0.5, 0.0};
  a.run(1.0);
  EXPECT_EQ(a.obeys, 1);
  EXPECT_FALSE(a.watch.commands_lost());
}

TEST(BaseWatch, OnlyWhatTheVehicleCanDoIsExpectedOfIt) {
  Config c;
  c.vehicle.max_speed_mps = 1.0;
  c.speed.max_yaw_rate_radps = 0.5;
  const base::BodyTwist cut = possible({-3.0, 2.0}, c);
  EXPECT_EQ(cut.linear_mps, -1.0);
  EXPECT_EQ(cut.angular_radps, 0.5);
  c.vehicle.kinematics = "ackermann";
  EXPECT_EQ(possible({0.5, 2.0}, c).angular_radps, 0.0);
}

// ---- the estimate ----

struct Told {
  EstimateWatch watch;
  base::EstimatorHealth health;
  base::FixType fix = base::FixType::None;
  Time now{};
  std::vector<std::string> kinds;
  std::vector<std::string> details;

  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds * 50.0); ++i) {
      now += milliseconds(20);
      for (const auto& n : watch.step(health, fix, now)) {
        kinds.emplace_back(n.kind);
        details.push_back(n.detail);
      }
    }
  }
  std::vector<std::string> take() { return std::exchange(kinds, {}); }
};
using Kinds = std::vector<std::string>;

TEST(EstimateWatch, TellsAFixClassThatLastsForASecond) {
  Told t;
  t.run(2.0);
  EXPECT_EQ(t.take(), Kinds{});
  t.fix = base::FixType::RtkFixed;
  t.run(0.9);
  t.fix = base::FixType::RtkFloat;
  t.run(0.5);
  EXPECT_EQ(t.take(), Kinds{});
  t.run(1.0);
  EXPECT_EQ(t.take(), Kinds{"gnss_fix"});
  EXPECT_EQ(t.details.back(), "GNSS fix is rtk_float");
}

TEST(EstimateWatch, TellsResetsButNotThoseThatAnOperatorMade) {
  Told t;
  t.health.resets = 1;
  t.health.last_reset = base::EstimateReset{"position", {3.0, 4.0}, 0.0, 0.0, 0.0, {}};
  t.run(0.1);
  EXPECT_EQ(t.take(), Kinds{"estimate_reset"});
  EXPECT_EQ(t.details.back(),
            "the sensors contradicted the estimate for too long: position set anew, moved by "
            "5.0 m, turned by 0.0 deg");
  t.health.resets = 2;
  t.health.last_reset->what = "map";  // which may lie anew: then nothing contradicted it before
  t.run(0.1);
  EXPECT_EQ(t.take(), Kinds{"estimate_reset"});
  EXPECT_EQ(t.details.back(),
            "its place in the map is not where it was believed to be: the estimate set anew, "
            "moved by 5.0 m, turned by 0.0 deg");
  t.health.resets = 3;
  t.watch.moved_on_purpose(t.health);
  t.run(0.1);
  EXPECT_EQ(t.take(), Kinds{});
}

TEST(EstimateWatch, TellsGyroAndHeadingAsTheyComeAndGo) {
  Told t;
  t.health.gyro = true;
  t.health.alignment = base::Alignment::Aligned;
  t.run(0.1);
  EXPECT_EQ(t.take(), (Kinds{"gyro_back", "heading_found"}));
  t.health.gyro = false;
  t.health.alignment = base::Alignment::Aligning;
  t.run(0.1);
  EXPECT_EQ(t.take(), (Kinds{"gyro_lost", "heading_lost"}));
}

TEST(EstimateWatch, TellsRefusalsThatLastTwoSecondsAndTheirEnd) {
  Told t;
  t.health.odometry.refused_since = t.now;
  t.health.odometry.why = base::Refusal::Jump;
  t.run(1.9);
  EXPECT_EQ(t.take(), Kinds{});
  t.run(0.2);
  EXPECT_EQ(t.take(), Kinds{"input_refused"});
  EXPECT_EQ(t.details.back(),
            "distances of the base are not used: they contradict what the robot did");
  t.health.odometry.refused_since.reset();
  t.run(0.1);
  EXPECT_EQ(t.take(), Kinds{"input_used"});
}

TEST(EstimateWatch, TellsAnAnchorThatTheEstimatorDropped) {
  Told t;
  t.watch.anchored(true);
  t.health.anchor = base::Anchor{};
  t.run(0.1);
  EXPECT_FALSE(t.watch.anchor_lost());
  t.health.anchor.reset();
  t.run(0.02);
  EXPECT_TRUE(t.watch.anchor_lost());
  EXPECT_EQ(t.take(), Kinds{"anchor_dropped"});
  t.run(0.02);
  EXPECT_FALSE(t.watch.anchor_lost()) << "at that step only";
}

// ---- the position ----

TEST(PositionWatch, CountsHowLongItIsUncertainAndCatchesSpinningWheelsOnce) {
  const auto watch = std::make_unique<PositionWatch>();
  SafetyParams p;
  World world;
  std::optional<base::Pose> pose(std::in_place);
  pose->horizontal_sigma_m = p.sigma_hold_m + 0.1;
  Time now{};
  int caught = 0;
  for (int i = 0; i < 300; ++i) {
    now += milliseconds(20);
    world.take(base::Measurement(base::BaseMotion{now, {0.8, 0.0}}));
    world.take(base::Measurement(base::GnssVelocity{now, 0.0, 0.0, 0.05}));
    caught += watch->step(pose, world, p, {}, now) ? 1 : 0;
  }
  EXPECT_EQ(caught, 1);
  EXPECT_TRUE(watch->spins());
  ASSERT_TRUE(watch->uncertain_since());
  EXPECT_NEAR(base::seconds(now - *watch->uncertain_since()), 5.98, 1e-6);
  pose->horizontal_sigma_m = 0.1;
  world.take(base::Measurement(base::BaseMotion{now, {}}));
  EXPECT_FALSE(watch->step(pose, world, p, {}, now));
  EXPECT_FALSE(watch->spins());
  EXPECT_FALSE(watch->uncertain_since());
}

TEST(PositionWatch, ComparesTwoSigmaWithTheCorridorOfTheMission) {
  PositionWatch watch;
  World world;
  std::optional<base::Pose> pose(std::in_place);
  pose->horizontal_sigma_m = 0.25;
  const Time now{std::chrono::seconds(5)};
  watch.step(pose, world, {}, 0.5, now);
  EXPECT_FALSE(watch.too_wide_since());
  watch.step(pose, world, {}, 0.49, now);
  watch.step(pose, world, {}, 0.49, now + milliseconds(20));
  EXPECT_EQ(watch.too_wide_since(), now);
  watch.step(pose, world, {}, {}, now + milliseconds(40));
  EXPECT_FALSE(watch.too_wide_since());
}

// ---- the clock ----

TEST(LoopClock, MeasuresTicksWithinReasonAndTellsFaultsEveryTenSeconds) {
  LoopClock clock;
  Time now{};
  clock.begin(now, {}, {});
  EXPECT_EQ(clock.dt_s(), 0.02);
  clock.begin(now += milliseconds(30), {}, milliseconds(21));
  EXPECT_NEAR(clock.dt_s(), 0.03, 1e-9);
  EXPECT_EQ(clock.health().late_ticks, 1u);
  clock.begin(now, {}, {});
  EXPECT_EQ(clock.dt_s(), 0.001) << "the same time twice";
  clock.begin(now += std::chrono::seconds(9), {}, {});
  EXPECT_EQ(clock.dt_s(), 0.1) << "it hung";
  EXPECT_TRUE(clock.fault());
  clock.begin(now += milliseconds(9900), {}, {});
  EXPECT_FALSE(clock.fault());
  clock.begin(now += milliseconds(200), {}, {});
  EXPECT_TRUE(clock.fault());
  EXPECT_EQ(clock.health().faults, 3u);
}

TEST(Certainty, ARobotThatKnowsItsPlaceLessWellIsSlower) {
  const SafetyParams p;
  EXPECT_DOUBLE_EQ(certain_mps(1.0, {}, 1.2, 0.4, p), 1.2);
  EXPECT_NEAR(certain_mps(1.5, {}, 1.2, 0.4, p), 0.8, 1e-9);
  EXPECT_DOUBLE_EQ(certain_mps(2.5, {}, 1.2, 0.4, p), 0.4);
  // A corridor asks for more: slower from where 2 sigma fill half of it.
  EXPECT_DOUBLE_EQ(certain_mps(0.1, 0.5, 1.2, 0.4, p), 1.2);
  EXPECT_NEAR(certain_mps(0.1875, 0.5, 1.2, 0.4, p), 0.8, 1e-9);
  EXPECT_DOUBLE_EQ(certain_mps(0.25, 0.5, 1.2, 0.4, p), 0.4);
  // One that is slower anyway stays so.
  EXPECT_DOUBLE_EQ(certain_mps(2.5, {}, 0.3, 0.4, p), 0.3);
}

}  // namespace
}  // namespace roverd::robot
