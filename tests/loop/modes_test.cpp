// Every mode against the true pose.

#include "rig.hpp"
#include "vehicle_rig.hpp"

namespace roverd::loop {
namespace {

using base::ActivityState;
using base::deg_from_rad;

RigOptions facing(double heading_deg, std::uint64_t seed = 1) {
  RigOptions o;
  o.seed = seed;
  o.heading_deg = heading_deg;
  return o;
}

robot::GoTo to(const RigBase& rig, Metres m) {
  robot::GoTo g;
  g.at = rig.place(m);
  return g;
}

bool reached(const RigBase& rig) {
  return rig.state()->activity.state == ActivityState::Reached;
}

double true_heading_deg(const RigBase& rig) {
  return base::heading_from_yaw(rig.truth().yaw_rad);
}

double off_deg(double heading_deg, double wanted_deg) {
  return std::abs(std::remainder(heading_deg - wanted_deg, 360.0));
}

/// The heading is learned by driving some metres.
void warm_up(RigBase& rig) {
  rig.arm();
  robot::MoveBy m;
  m.forward_m = 4.0;
  m.speed_mps = 0.6;
  ASSERT_TRUE(rig.ask(m));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 60.0)) << rig.state()->activity.reason;
  rig.run(1.0);
  rig.track.clear();
}

/// What the sticks ask for, held for a time.
void hold_stick(RigBase& rig, double speed_mps, double rate_radps, double seconds) {
  if (rig.state()->teleop.phase != base::TeleopPhase::Held) rig.let_go();
  for (double t = 0.0; t < seconds; t += 0.1) {
    rig.drive(speed_mps, rate_radps);
    rig.run(0.1);
  }
}

class Modes : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Loop, Modes, testing::Values(1, 2));

// ---- GUIDED ----

TEST_P(Modes, GuidedGoesToAPointAndToAPose) {
  Rig rig(facing(0.0, GetParam()));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(to(rig, {6, 8})));
  EXPECT_EQ(rig.state()->mode, Mode::Guided);
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 90.0)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({6, 8}), 0.12);
  robot::GoTo pose = to(rig, {6, 2});
  pose.yaw_rad = base::yaw_from_heading(270.0);
  ASSERT_TRUE(rig.ask(pose));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 90.0)) << rig.state()->activity.reason;
  rig.run(1.0);
  EXPECT_LT(rig.distance_to_m({6, 2}), 0.15);
  EXPECT_LT(off_deg(true_heading_deg(rig), 270.0), 4.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.state()->mode, Mode::Guided);
}

TEST(GuidedLoop, GoesToALocalPointBackwards) {
  Rig rig(facing(0.0));
  warm_up(rig);
  const base::EnuPoint here = rig.state()->pose->at;
  robot::GoTo g;
  g.local = base::EnuPoint{here.east_m, here.north_m - 5.0};
  g.reverse = true;
  ASSERT_TRUE(rig.ask(g));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 60.0)) << rig.state()->activity.reason;
  rig.run(1.0);
  EXPECT_LT(off_deg(true_heading_deg(rig), 0.0), 8.0);
  EXPECT_LT(base::distance_m(rig.state()->pose->at, *g.local), 0.15);
}

TEST(GuidedLoop, ANewGoalAheadReplacesTheOldOneWithoutAStop) {
  Rig rig(facing(0.0));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(to(rig, {0, 20})));
  rig.run(6.0);
  ASSERT_GT(rig.truth().twist.linear_mps, 0.6);
  double slowest = 10.0;
  ASSERT_TRUE(rig.ask(to(rig, {4, 22})));
  rig.run_until(
      [&] {
        slowest = std::min(slowest, rig.truth().twist.linear_mps);
        return false;
      },
      2.0);
  EXPECT_GT(slowest, 0.3);
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 60.0)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({4, 22}), 0.15);
}

TEST(GuidedLoop, AGoalBehindStopsFirstAndTurns) {
  Rig rig(facing(0.0));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(to(rig, {0, 20})));
  rig.run(6.0);
  const double north = rig.truth().local.north_m;
  ASSERT_TRUE(rig.ask(to(rig, {0, 2})));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 90.0)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({0, 2}), 0.15);
  for (const auto& t : rig.track) EXPECT_LT(t.local.north_m, north + 1.5);
}

TEST(GuidedLoop, HeadingAndSpeedStopWhenNothingNewerComes) {
  Rig rig(facing(0.0));
  warm_up(rig);
  robot::GoTo g;
  g.yaw_rad = base::yaw_from_heading(20.0);
  g.speed_mps = 0.5;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(rig.ask(g));
    rig.run(1.0);
  }
  EXPECT_NEAR(rig.truth().twist.linear_mps, 0.5, 0.08);
  EXPECT_LT(off_deg(true_heading_deg(rig), 20.0), 5.0);
  rig.run(1.5);
  EXPECT_GT(rig.truth().twist.linear_mps, 0.3);
  rig.run(2.5);
  EXPECT_TRUE(rig.stands());
  EXPECT_EQ(rig.state()->activity.state, ActivityState::Waiting);
}

TEST(GuidedLoop, AModeChangeWhileMovingStandsFirst) {
  Rig rig(facing(0.0));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(to(rig, {0, 20})));
  rig.run(6.0);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Rtl}));
  bool stood = false;
  ASSERT_TRUE(rig.run_until(
      [&] {
        stood = stood || std::abs(rig.truth().twist.linear_mps) < 0.05;
        return std::abs(rig.state()->command.twist.angular_radps) > 0.05 ||
               rig.state()->mode != Mode::Rtl;
      },
      10.0));
  EXPECT_TRUE(stood);
  EXPECT_EQ(rig.state()->mode, Mode::Rtl);
}

TEST(GuidedLoop, WaitsForAWordAfterTheRadioHadItAndGoesOn) {
  Rig rig(facing(0.0));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(to(rig, {0, 16})));
  rig.run(5.0);
  sim::Radio radio;
  radio.swb = base::Switch::Middle;
  rig.plant.set_radio(radio);
  rig.run(3.0);
  EXPECT_TRUE(rig.stands());
  radio.swb = base::Switch::Up;
  rig.plant.set_radio(radio);
  const auto stood = rig.truth().local;
  rig.run(5.0);
  EXPECT_EQ(rig.state()->activity.state, ActivityState::Held);
  EXPECT_LT(std::hypot(rig.truth().local.east_m - stood.east_m,
                       rig.truth().local.north_m - stood.north_m),
            0.02);
  ASSERT_TRUE(rig.ask(robot::ResumeActivity{}));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 90.0)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({0, 16}), 0.15);
}

// ---- single moves ----

TEST_P(Modes, MovesByMetresAndTurnsByDegrees) {
  Rig rig(facing(90.0, GetParam()));
  warm_up(rig);
  const auto from = rig.truth().local;
  robot::MoveBy move;
  move.forward_m = 2.5;
  rig.fastest_mps = 0.0;
  ASSERT_TRUE(rig.ask(move));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 60.0)) << rig.state()->activity.reason;
  rig.run(1.0);
  EXPECT_NEAR(rig.truth().local.east_m - from.east_m, 2.5, 0.1);
  EXPECT_LT(rig.fastest_mps, 0.42);
  for (const double turn_deg : {-90.0, 270.0, 180.0, -30.0}) {
    const double before = base::heading_from_yaw(rig.state()->pose->yaw_rad);
    robot::MoveBy turn;
    turn.turn_rad = -base::rad_from_deg(turn_deg);
    ASSERT_TRUE(rig.ask(turn));
    double turned = 0.0;
    double last = rig.truth().yaw_rad;
    double fastest = 0.0;
    ASSERT_TRUE(rig.run_until(
        [&] {
          turned += base::angle_diff_rad(last, rig.truth().yaw_rad);
          last = rig.truth().yaw_rad;
          fastest = std::max(fastest, std::abs(rig.truth().twist.angular_radps));
          return reached(rig);
        },
        90.0))
        << rig.state()->activity.reason;
    rig.run(1.0);
    // The angle that the estimate turned; without a gyro it learns slip only while it drives.
    EXPECT_LT(off_deg(base::heading_from_yaw(rig.state()->pose->yaw_rad), before + turn_deg), 4.0);
    EXPECT_NEAR(-deg_from_rad(turned), turn_deg, 0.08 * std::abs(turn_deg) + 4.0);
    EXPECT_LT(fastest, 0.4);
  }
  robot::MoveBy absolute;
  absolute.yaw_rad = base::yaw_from_heading(10.0);
  ASSERT_TRUE(rig.ask(absolute));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 60.0));
  EXPECT_LT(off_deg(base::heading_from_yaw(rig.state()->pose->yaw_rad), 10.0), 4.0);
  EXPECT_LT(off_deg(true_heading_deg(rig), 10.0), 12.0);
}

TEST(MoveLoop, BackwardsIsSlow) {
  Rig rig(facing(0.0));
  warm_up(rig);
  rig.fastest_mps = 0.0;
  const auto from = rig.truth().local;
  robot::MoveBy move;
  move.forward_m = -1.0;
  ASSERT_TRUE(rig.ask(move));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 60.0)) << rig.state()->activity.reason;
  EXPECT_NEAR(rig.truth().local.north_m - from.north_m, -1.0, 0.1);
  EXPECT_LT(rig.fastest_mps, 0.2);
}

// ---- RTL, SMART_RTL ----

//   home        RTL: straight            SMART_RTL: along the driven way
TEST_P(Modes, RtlDrivesStraightHomeAndHolds) {
  Rig rig(facing(0.0, GetParam()));
  rig.arm_and_start(rig.plan_of({{0, 8}, {8, 8}}));
  ASSERT_TRUE(rig.finish(90.0));
  rig.track.clear();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Rtl}));
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mode == Mode::Hold; }, 90.0));
  EXPECT_TRUE(reached(rig)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({0, 0}), 0.2);
  EXPECT_LT(rig.farthest_from_line_m({8, 8}, {0, 0}), 0.4);
  EXPECT_TRUE(rig.has_event("home_reached"));
}

TEST_P(Modes, SmartRtlDrivesBackAlongTheWay) {
  Rig rig(facing(0.0, GetParam()));
  const std::vector<Metres> way{{0, 0}, {0, 8}, {8, 8}, {8, 14}};
  rig.arm_and_start(rig.plan_of({way.begin() + 1, way.end()}));
  ASSERT_TRUE(rig.finish(120.0));
  rig.track.clear();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::SmartRtl}));
  // Interrupted half-way, it goes on from there.
  rig.run(15.0);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Hold}));
  rig.run(2.0);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::SmartRtl}));
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mode == Mode::Hold; }, 120.0));
  EXPECT_TRUE(reached(rig)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({0, 0}), 0.3);
  EXPECT_LT(rig.farthest_from_path_m(way), 0.75);
}

TEST(ReturnLoop, ConditionsThatFailAreNamed) {
  Rig rig(facing(0.0));
  rig.run(8.0);
  const auto unarmed = rig.ask(robot::SetMode{Mode::Rtl});
  ASSERT_FALSE(unarmed);
  EXPECT_EQ(unarmed.error().detail, "the robot is not armed");
  rig.arm();
  const auto no_target = rig.ask(robot::SetMode{Mode::Follow});
  ASSERT_FALSE(no_target);
  EXPECT_NE(no_target.error().detail.find("no target"), std::string::npos);
  const auto no_pose = rig.ask(robot::SetMode{Mode::Dock});
  ASSERT_FALSE(no_pose);
  EXPECT_EQ(no_pose.error().code, base::Code::Invalid);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
}

// ---- FOLLOW ----

/// A target that walks; told at 5 Hz.
struct Walker {
  RigBase& rig;
  Metres at;
  double east_mps = 0.0;
  double north_mps = 0.0;
  bool silent = false;
  double nearest_m = 1e9;
  robot::SetTarget::Offset offset = robot::SetTarget::Offset::None;
  double a_m = 0.0;
  double b_m = 0.0;

  void walk(double seconds) {
    for (double t = 0.0; t < seconds - 1e-9; t += 0.2) {
      at.east_m += east_mps * 0.2;
      at.north_m += north_mps * 0.2;
      if (!silent) tell();
      for (int i = 0; i < 10; ++i) {
        rig.tick();
        nearest_m = std::min(nearest_m, rig.distance_to_m(at));
      }
    }
  }
  void tell() {
    robot::SetTarget t;
    t.at = rig.place(at);
    t.velocity_mps = base::EnuPoint{east_mps, north_mps};
    t.asked = Time{base::from_seconds(rig.now_s())};
    t.offset = offset;
    t.a_m = a_m;
    t.b_m = b_m;
    rig.robot.request(t, Time::max(), {});
  }
};

TEST_P(Modes, FollowKeepsItsGapAndStandsWhenTheTargetStands) {
  Rig rig(facing(0.0, GetParam()));
  warm_up(rig);
  Walker w{rig, {0, 9}};
  w.tell();
  rig.tick();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Follow}));
  w.north_mps = 0.6;
  w.walk(25.0);
  EXPECT_NEAR(rig.distance_to_m(w.at), 2.0 + 0.8 * 0.6, 0.5);
  EXPECT_NEAR(rig.truth().twist.linear_mps, 0.6, 0.15);
  w.north_mps = 0.0;
  w.east_mps = 0.5;  // goes round a corner
  w.walk(20.0);
  EXPECT_NEAR(rig.distance_to_m(w.at), 2.4, 0.6);
  w.east_mps = 0.0;
  w.walk(8.0);
  EXPECT_TRUE(rig.stands());
  EXPECT_GT(w.nearest_m, 1.3);
  // It comes towards the robot, and through it: the robot never moves back, nor on.
  const auto stood = rig.truth().local;
  w.east_mps = -0.8;
  w.walk(5.0);
  EXPECT_LT(std::hypot(rig.truth().local.east_m - stood.east_m,
                       rig.truth().local.north_m - stood.north_m),
            0.5);
}

TEST(FollowLoop, ASilentTargetBrakesThenHolds) {
  Rig rig(facing(0.0));
  warm_up(rig);
  Walker w{rig, {0, 9}};
  w.north_mps = 0.6;
  w.tell();
  rig.tick();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Follow}));
  w.walk(12.0);
  ASSERT_GT(rig.truth().twist.linear_mps, 0.3);
  w.silent = true;
  w.walk(2.6);
  EXPECT_EQ(rig.state()->mode, Mode::Follow);
  EXPECT_LT(rig.truth().twist.linear_mps, 0.1);
  w.walk(1.2);
  EXPECT_EQ(rig.state()->mode, Mode::Hold);
  EXPECT_TRUE(rig.has_event("target_lost"));
}

TEST(FollowLoop, ATargetThatJumpsIsNotBelieved) {
  Rig rig(facing(0.0));
  warm_up(rig);
  Walker w{rig, {0, 9}};
  w.tell();
  rig.tick();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Follow}));
  w.walk(6.0);
  robot::SetTarget other;
  other.at = rig.place({10, 9});
  other.asked = Time{base::from_seconds(rig.now_s())};
  const auto jumped = rig.ask(other);
  ASSERT_FALSE(jumped);
  EXPECT_NE(jumped.error().detail.find("jumped by"), std::string::npos);
  other.asked += std::chrono::seconds(60);
  const auto future = rig.ask(other);
  ASSERT_FALSE(future);
  EXPECT_EQ(future.error().code, base::Code::Invalid);
  other.asked = Time{base::from_seconds(rig.now_s())};
  other.velocity_mps = base::EnuPoint{std::nan(""), 0.0};
  EXPECT_FALSE(rig.ask(other));
  w.walk(2.0);
  EXPECT_LT(std::abs(rig.truth().local.east_m), 1.2);  // the other place is 10 m to the side
}

TEST(FollowLoop, KeepsAPlaceBesideThatIsFixedToNorth) {
  Rig rig(facing(0.0));
  warm_up(rig);
  Walker w{rig, {6, 6}};
  w.offset = robot::SetTarget::Offset::North;
  w.a_m = -3.0;
  w.tell();
  rig.tick();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Follow}));
  w.north_mps = 0.5;
  w.walk(30.0);
  EXPECT_NEAR(rig.truth().local.east_m, 3.0, 0.4);
  EXPECT_NEAR(rig.truth().local.north_m, w.at.north_m, 1.2);
}

// ---- sticks ----

TEST(SticksLoop, AcroHoldsTheTurnRateDespiteSlip) {
  RigOptions o = facing(0.0);
  Rig rig(o);
  warm_up(rig);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Acro}));
  hold_stick(rig, 0.5, 0.3, 6.0);
  EXPECT_NEAR(rig.truth().twist.angular_radps, 0.3, 0.03);
  rig.run(1.5);
  EXPECT_TRUE(rig.stands());
}

TEST(SticksLoop, SteeringHoldsTheHeadingAndLimitsTheSidewaysPush) {
  Rig rig(facing(0.0));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Steering}));
  hold_stick(rig, 0.8, 0.0, 3.0);
  const double heading = true_heading_deg(rig);
  hold_stick(rig, 0.8, 0.0, 8.0);
  EXPECT_LT(off_deg(true_heading_deg(rig), heading), 1.5);
  hold_stick(rig, 0.9, 0.75, 4.0);
  const auto t = rig.truth().twist;
  EXPECT_LT(std::abs(t.linear_mps * t.angular_radps), 0.65);
}

TEST(SticksLoop, SimpleForwardIsAlwaysTheSameWay) {
  Rig rig(facing(40.0));
  warm_up(rig);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Simple}));
  const double start = true_heading_deg(rig);
  hold_stick(rig, 0.0, 0.5, 8.0);  // left of the start
  EXPECT_LT(off_deg(true_heading_deg(rig), start - 90.0), 6.0);
  hold_stick(rig, 0.6, 0.0, 8.0);  // forward again
  EXPECT_LT(off_deg(true_heading_deg(rig), start), 6.0);
  EXPECT_GT(rig.truth().twist.linear_mps, 0.3);
}

// ---- DOCK ----

TEST_P(Modes, DocksSlowlyAndStraight) {
  Rig rig(facing(0.0, GetParam()));
  warm_up(rig);
  robot::SetMode dock{Mode::Dock, to(rig, {5, 3})};
  dock.goal->yaw_rad = base::yaw_from_heading(90.0);
  ASSERT_TRUE(rig.ask(dock));
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mode == Mode::Hold; }, 120.0));
  EXPECT_TRUE(reached(rig)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({5, 3}), 0.10);
  EXPECT_LT(off_deg(true_heading_deg(rig), 90.0), 4.0);
  for (const auto& t : rig.track) {
    const bool last_metre = std::hypot(t.local.east_m - 5, t.local.north_m - 3) < 1.0;
    if (last_metre) {
      EXPECT_LT(t.twist.linear_mps, 0.3);
    }
  }
}

// ---- a steered vehicle ----

TEST(SteeredModes, ThePathModesWorkForACar) {
  CartRig rig({.vehicle = "uku", .heading_deg = 0.0});
  rig.arm();
  ASSERT_TRUE(rig.ask(to(rig, {2, 25})));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 90.0)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({2, 25}), 0.3);
  robot::GoTo pose = to(rig, {20, 40});
  pose.yaw_rad = base::yaw_from_heading(90.0);
  ASSERT_TRUE(rig.ask(pose));
  ASSERT_TRUE(rig.run_until([&] { return reached(rig); }, 90.0)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({20, 40}), 0.4);
  EXPECT_LT(off_deg(true_heading_deg(rig), 90.0), 8.0);
  robot::MoveBy turn;
  turn.turn_rad = 1.0;
  const auto refused = rig.ask(turn);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "this vehicle cannot turn on the spot");
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Rtl}));
  ASSERT_TRUE(rig.run_until([&] { return rig.state()->mode == Mode::Hold; }, 150.0));
  EXPECT_TRUE(reached(rig)) << rig.state()->activity.reason;
  EXPECT_LT(rig.distance_to_m({0, 0}), 0.6);
}

TEST(SteeredModes, SticksAndFollowWorkForACar) {
  CartRig rig({.vehicle = "uku", .heading_deg = 0.0});
  warm_up(rig);
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Steering}));
  hold_stick(rig, 0.8, 0.0, 2.0);
  const double heading = true_heading_deg(rig);
  hold_stick(rig, 0.8, 0.0, 6.0);
  EXPECT_LT(off_deg(true_heading_deg(rig), heading), 3.0);
  rig.run(2.0);
  Walker w{rig, {rig.truth().local.east_m, rig.truth().local.north_m + 6.0}};
  w.north_mps = 0.6;
  w.tell();
  rig.tick();
  ASSERT_TRUE(rig.ask(robot::SetMode{Mode::Follow}));
  w.walk(20.0);
  EXPECT_NEAR(rig.distance_to_m(w.at), 2.5, 0.7);
}

}  // namespace
}  // namespace roverd::loop
