// LOITER and CIRCLE: what begins them, what they do, and what ends them.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "field.hpp"
#include "robot/radio/keys.hpp"

namespace roverd::robot {
namespace {

using base::ActivityState;
using base::EnuPoint;

/// Armed in the open; the map's origin is the robot's.
Field& ready(Field& f) {
  f.run(8.0);
  EXPECT_TRUE(f.ask(Arm{}));
  return f;
}

SetMode circle(EnuPoint centre, double radius_m, std::optional<double> turns) {
  SetMode c{Mode::Circle};
  c.goal.emplace().at = kFrame.to_global(centre);
  c.radius_m = radius_m;
  c.turns = turns;
  return c;
}

SetMode loiter(std::optional<EnuPoint> at, double radius_m = 1.0) {
  SetMode c{Mode::Loiter};
  c.goal.emplace();
  if (at) c.goal->at = kFrame.to_global(*at);
  c.radius_m = radius_m;
  return c;
}

/// How far round it goes, left positive, and how far off the circle at most once it is on it.
struct Round {
  double turned_rad = 0.0;
  double worst_m = 0.0;
};

Round go_round(Field& f, EnuPoint centre, double radius_m, double seconds) {
  Round r;
  bool on = false;
  EnuPoint last = f.at - centre;
  for (int i = 0; i < seconds * 50.0 && f.state()->mode == Mode::Circle; ++i) {
    f.tick();
    const EnuPoint now = f.at - centre;
    const double off_m = std::abs(std::hypot(now.east_m, now.north_m) - radius_m);
    on = on || off_m < 0.03;
    if (on) {
      r.worst_m = std::max(r.worst_m, off_m);
      r.turned_rad += std::atan2(last.east_m * now.north_m - last.north_m * now.east_m,
                                 last.east_m * now.east_m + last.north_m * now.north_m);
    }
    last = now;
  }
  return r;
}

TEST(CircleMode, DrivesItsTurnsAndHolds) {
  for (const bool clockwise : {false, true}) {
    Field f;
    ready(f);
    SetMode c = circle({0, 10}, 4.0, 1.5);
    c.clockwise = clockwise;
    ASSERT_TRUE(f.ask(c));
    // Told from its first moment, so that it can be drawn before anything moves.
    const base::Activity& told = f.state()->activity;
    EXPECT_EQ(told.kind, "circle");
    EXPECT_EQ(told.radius_m, 4.0);
    EXPECT_EQ(told.turns, 1.5);
    EXPECT_EQ(told.clockwise, clockwise);
    ASSERT_TRUE(told.goal);
    EXPECT_LT(base::distance_m(kFrame.to_local(*told.goal), {0, 10}), 0.01);
    const Round r = go_round(f, {0, 10}, 4.0, 120.0);
    EXPECT_EQ(f.state()->mode, Mode::Hold);
    EXPECT_EQ(f.state()->activity.state, ActivityState::Reached);
    EXPECT_NEAR(std::abs(r.turned_rad), 3.0 * base::kPi, 0.4);
    EXPECT_EQ(r.turned_rad < 0.0, clockwise);
    EXPECT_LT(r.worst_m, 0.15);
  }
}

// More turns than are laid at a time, and none: the way serves again and again.
TEST(CircleMode, GoesOnWithoutAnEndOrForAsManyTurnsAsAsked) {
  Field f;
  ready(f);
  ASSERT_TRUE(f.ask(circle({0, 5}, 1.5, {})));
  const Round endless = go_round(f, {0, 5}, 1.5, 200.0);
  EXPECT_EQ(f.state()->mode, Mode::Circle);
  EXPECT_GT(endless.turned_rad, 8.0 * 2.0 * base::kPi);
  EXPECT_LT(endless.worst_m, 0.15);
  EXPECT_FALSE(f.state()->activity.distance_m);
  EXPECT_FALSE(f.state()->activity.turns);
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));

  Field seven;
  ready(seven);
  ASSERT_TRUE(seven.ask(circle({0, 5}, 1.5, 7.25)));
  seven.run(1.0);
  EXPECT_NEAR(seven.state()->activity.distance_m.value(), 7.25 * 3.0 * base::kPi + 4.8, 1.5);
  const Round r = go_round(seven, {0, 5}, 1.5, 300.0);
  EXPECT_EQ(seven.state()->mode, Mode::Hold);
  EXPECT_NEAR(r.turned_rad, 7.25 * 2.0 * base::kPi, 0.8);
}

// The radio takes over in its middle and carries the robot 1 m away; then it goes on, from there.
TEST(CircleMode, GoesOnWhereItWasAfterTheRadioDrove) {
  Field f;
  ready(f);
  ASSERT_TRUE(f.ask(circle({0, 8}, 3.0, 2.0)));
  const Round before = go_round(f, {0, 8}, 3.0, 25.0);
  ASSERT_GT(before.turned_rad, 1.0);
  ASSERT_LT(before.turned_rad, 10.0);
  f.swb = base::Switch::Down;
  f.run(2.0);
  f.obeys = false;
  f.does = {0.5, 0.0};
  f.run(2.0);
  f.does = {};
  f.run(1.0);
  f.obeys = true;
  f.swb = base::Switch::Up;
  f.run(2.0);
  EXPECT_EQ(f.state()->activity.state, ActivityState::Held);
  EXPECT_FALSE(f.moves());
  ASSERT_TRUE(f.ask(ResumeActivity{}));
  const Round after = go_round(f, {0, 8}, 3.0, 120.0);
  EXPECT_EQ(f.state()->activity.state, ActivityState::Reached);
  EXPECT_NEAR(before.turned_rad + after.turned_rad, 4.0 * base::kPi, 1.0);
}

// "LOITER, here" on the radio, after its sticks led the robot elsewhere.
TEST(LoiterMode, HereIsWhereItStandsNowAlsoAfterTheRadioLedItAway) {
  Field f;
  ready(f);
  ASSERT_TRUE(f.ask(SetMode{Mode::Loiter}));
  f.run(1.0);
  f.swb = base::Switch::Down;
  f.run(2.0);
  f.obeys = false;
  f.does = {0.5, 0.0};
  f.run(6.0);
  f.does = {};
  f.run(1.0);
  f.obeys = true;
  f.swb = base::Switch::Up;
  f.run(2.0);
  ASSERT_EQ(f.state()->activity.state, ActivityState::Held);
  const base::EnuPoint there = f.at;
  ASSERT_TRUE(f.ask(SetMode{Mode::Loiter}));
  f.run(10.0);
  EXPECT_EQ(f.state()->mode, Mode::Loiter);
  EXPECT_LT(base::distance_m(f.at, there), 0.2);
}

TEST(CircleMode, IsRefusedWithItsReason) {
  Field f;
  f.run(8.0);
  EXPECT_FALSE(f.ask(circle({0, 8}, 3.0, 1.0))) << "not armed";
  ASSERT_TRUE(f.ask(Arm{}));
  SetMode nowhere{Mode::Circle};
  nowhere.radius_m = 3.0;
  const auto bare = f.ask(nowhere);
  ASSERT_FALSE(bare);
  EXPECT_EQ(bare.error().code, base::Code::Invalid);
  EXPECT_EQ(bare.error().fields.at(0).pointer, "/lat");
  const auto far = f.ask(circle({0, 20'000}, 3.0, 1.0));
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, base::Code::Invalid);
  EXPECT_EQ(f.state()->mode, Mode::Hold);

  Config car;
  car.vehicle.kinematics = "ackermann";
  car.vehicle.wheelbase_m = 2.0;
  car.vehicle.max_steering_deg = 30.0;
  Field c(car);
  ready(c);
  const auto narrow = c.ask(circle({0, 8}, 3.0, 1.0));
  ASSERT_FALSE(narrow);
  EXPECT_EQ(narrow.error().code, base::Code::Conflict);
  EXPECT_EQ(narrow.error().detail,
            "the circle is too narrow for this vehicle: its radius must be at least 3.8 m");
}

/// Downhill to the south, with tracks that stand.
struct Slide {
  double farthest_m = 0.0;
  bool drove = false;
  base::Mode mode = Mode::Hold;
};

Slide slide(double mps, double radius_m, double seconds) {
  Field f;
  ready(f);
  EXPECT_TRUE(f.ask(loiter({}, radius_m)));
  f.run(3.0);
  EXPECT_EQ(f.state()->mode, Mode::Loiter);
  EXPECT_EQ(f.state()->activity.state, ActivityState::Waiting);
  EXPECT_FALSE(f.moves());
  Slide s;
  const EnuPoint stood = f.at;
  for (int i = 0; i < 50 * seconds; ++i) {
    f.at.north_m -= 0.02 * mps;
    f.tick();
    s.farthest_m = std::max(s.farthest_m, base::distance_m(f.at, stood));
    s.drove = s.drove || f.moves();
  }
  s.mode = f.state()->mode;
  return s;
}

/// A slide of more than some mm/s with tracks that stand is taken for a receiver that lies: then it
/// holds, with that reason.
TEST(LoiterMode, DrivesBackWhenItSlidAway) {
  const Slide s = slide(0.005, 0.5, 300.0);
  EXPECT_TRUE(s.drove);
  EXPECT_GT(s.farthest_m, 0.45);
  EXPECT_LT(s.farthest_m, 0.7);
  EXPECT_EQ(s.mode, Mode::Loiter) << "it has no end of its own";
  const Slide fast = slide(0.03, 0.5, 60.0);
  EXPECT_FALSE(fast.drove);
  EXPECT_EQ(fast.mode, Mode::Hold);
}

TEST(LoiterMode, DrivesToAPlaceAndStaysThereUntilAnotherModeIsChosen) {
  Field f;
  ready(f);
  ASSERT_TRUE(f.ask(loiter(EnuPoint{3, 6}, 0.5)));
  EXPECT_EQ(f.state()->activity.kind, "loiter");
  f.run(40.0);
  EXPECT_LT(base::distance_m(f.at, {3, 6}), 0.3);
  EXPECT_EQ(f.state()->activity.reason, "stays here");
  ASSERT_TRUE(f.ask(SetMode{Mode::Hold}));
  f.at.north_m += 3.0;
  f.run(5.0);
  EXPECT_FALSE(f.moves());
}

/// As GUIDED: what holds a goal holds these, and nothing begins again by itself.
TEST(RoundModes, HoldWhenThePositionOrTheBaseIsLostAndStayHeld) {
  for (const bool circles : {false, true}) {
    for (const bool base_lost : {false, true}) {
      SCOPED_TRACE(std::string(circles ? "CIRCLE" : "LOITER") + (base_lost ? " base" : " gnss"));
      Field f;
      ready(f);
      ASSERT_TRUE(circles ? f.ask(circle({0, 12}, 4.0, {})) : f.ask(loiter(EnuPoint{0, 30})));
      f.run(4.0);
      ASSERT_TRUE(f.moves());
      (base_lost ? f.base_speaks : f.gnss_speaks) = false;
      f.run(30.0);
      EXPECT_EQ(f.state()->mode, Mode::Hold);
      EXPECT_FALSE(f.moves());
      f.base_speaks = f.gnss_speaks = true;
      f.run(10.0);
      EXPECT_EQ(f.state()->mode, Mode::Hold);
      EXPECT_FALSE(f.moves());
    }
  }
}

TEST(RoundModes, EndWithTheEmergencyStop) {
  Field f;
  ready(f);
  ASSERT_TRUE(f.ask(circle({0, 12}, 4.0, {})));
  f.run(4.0);
  ASSERT_TRUE(f.moves());
  ASSERT_TRUE(f.ask(Estop{}));
  f.run(1.0);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_EQ(f.state()->activity.state, ActivityState::Failed);
}

/// Through the whole robot: an item without a time goes on with the word that resumes.
TEST(RoundItems, ALoiterWithoutATimeGoesOnWhenTheMissionIsResumed) {
  Field f;
  f.run(8.0);
  mission::Plan plan = plan_of({{0, 4}});
  plan.items.emplace_back(mission::Loiter{});
  plan.items.push_back(plan_of({{0, 8}}).items.front());
  ASSERT_TRUE(f.load(plan));
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(StartMission{"m", 1}));
  f.run(40.0);
  EXPECT_EQ(f.state()->mission.current_item, 2);
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_FALSE(f.moves());
  ASSERT_TRUE(f.ask(ResumeMission{}));
  f.run(30.0);
  EXPECT_EQ(f.execution(), ExecutionState::Finished);
  EXPECT_LT(base::distance_m(f.at, {0, 8}), 0.2);
}

}  // namespace
}  // namespace roverd::robot
