// Who drives, and what a loss does: e-stop > radio > teleoperation > autonomy.

#include <algorithm>
#include <limits>

#include "field.hpp"
#include "robot/modes/manual.hpp"
#include "robot/safety/obedience.hpp"

namespace roverd::robot {
namespace {

TEST(Arbiter, TheRadioGoesBeforeEverythingButTheEmergencyStop) {
  Field f;
  f.drive_mission();
  f.swb = base::Switch::Middle;
  f.run(0.1);
  EXPECT_EQ(f.state()->control, base::Driver::Radio);
  EXPECT_EQ(f.command, base::DriveCommand{});
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_NE(f.state()->mission.reason, "");
  EXPECT_TRUE(f.has_condition("radio_control"));
  f.run(30.0);  // as long as it likes
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  f.swb = base::Switch::Up;
  f.run(1.0);
  EXPECT_EQ(f.state()->control, base::Driver::Autonomy);
  EXPECT_TRUE(f.moves());
  f.control_mode = base::ControlMode::Radio;
  f.run(0.5);
  EXPECT_EQ(f.state()->control, base::Driver::Radio);
  ASSERT_TRUE(f.ask(Estop{}));
  EXPECT_EQ(f.state()->control, base::Driver::None);
}

TEST(Arbiter, AStopThatWasAskedForGoesOutBetweenTwoTicks) {
  Field f;
  int alerts = 0;
  f.robot.alert = [&alerts] { ++alerts; };
  f.drive_mission();
  f.run(2.0);
  ASSERT_TRUE(f.moves());
  // Given that nobody asked, nothing happens between two ticks;
  int sends = f.sends;
  f.robot.heed_stop(f.now);
  EXPECT_EQ(f.sends, sends);
  // when somebody asks, the loop is told, and what stands goes out at once, and once;
  ASSERT_TRUE(f.robot.request(Estop{"a script"}, base::Time::max(), {}));
  EXPECT_EQ(alerts, 1);
  f.robot.heed_stop(f.now + std::chrono::milliseconds(3));
  EXPECT_EQ(f.sends, ++sends);
  EXPECT_EQ(f.command, base::DriveCommand{});
  f.robot.heed_stop(f.now + std::chrono::milliseconds(4));
  EXPECT_EQ(f.sends, sends);
  // and the next tick knows of it.
  f.tick();
  EXPECT_EQ(f.command, base::DriveCommand{});
  EXPECT_TRUE(f.state()->estop);
  EXPECT_FALSE(f.state()->armed);
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  const auto told = std::ranges::find(f.events, "estop", &base::Event::kind);
  ASSERT_NE(told, f.events.end());
  EXPECT_EQ(told->detail, "emergency stop by a script");
  EXPECT_EQ(std::ranges::count(f.events, "estop", &base::Event::kind), 1);
}

/// So many stops wait that no more find room, and none of them is the emergency stop.
void flood(Field& f) {
  while (f.robot.request(Drive{{}, false}, base::Time::max(), {})) {
  }
  while (f.robot.request(SetMode{Mode::Hold}, base::Time::max(), {})) {
  }
  ASSERT_FALSE(f.robot.request(Estop{"anna"}, base::Time::max(), {}));
}

std::vector<std::string> stops_told(const Field& f) {
  std::vector<std::string> out;
  for (const base::Event& e : f.events) {
    if (e.kind == "estop" || e.kind == "estop_reset") out.push_back(e.detail);
  }
  return out;
}

using Words = std::vector<std::string>;

TEST(Arbiter, AStopWhoseCommandFoundNoRoomStopsAtOnceAndIsTold) {
  Field f;
  f.drive_mission();
  f.run(1.0);
  flood(f);
  f.tick();
  EXPECT_TRUE(f.state()->estop);
  EXPECT_EQ(stops_told(f), Words{});
  f.run(0.3);
  EXPECT_EQ(stops_told(f), Words{"emergency stop by the operator"});
}

TEST(Arbiter, AResetTellsTheStopBeforeIt) {
  Field f;
  f.drive_mission();
  f.run(1.0);
  flood(f);
  f.tick();
  ASSERT_TRUE(f.ask(ResetEstop{}));
  f.run(0.5);
  EXPECT_EQ(stops_told(f),
            (Words{"emergency stop by the operator", "emergency stop released; disarmed"}));
}

TEST(Arbiter, ALeverBetweenItsDetentsKeepsItsLastPosition) {
  Field f;
  f.drive_mission();
  f.swb = base::Switch::Unknown;
  f.run(2.0);
  EXPECT_EQ(f.state()->control, base::Driver::Autonomy);
  EXPECT_TRUE(f.moves());
}

TEST(Arbiter, ABaseThatStopsListeningHoldsTheMissionUntilAnOperatorGoesOn) {
  Field f;
  f.drive_mission();
  for (const base::ControlMode left_to : {base::ControlMode::Standby, base::ControlMode::Uart}) {
    f.control_mode = left_to;
    f.run(1.0);
    EXPECT_FALSE(f.moves());
    EXPECT_TRUE(f.command.enabled);  // the driver asks the base again
    EXPECT_TRUE(f.has_condition("base_not_ready"));
    EXPECT_TRUE(f.has_event("base_left_control"));
    EXPECT_EQ(f.execution(), ExecutionState::Paused);
    EXPECT_EQ(f.state()->mode, Mode::Hold);
    f.control_mode = base::ControlMode::Can;
    f.run(2.0);
    EXPECT_FALSE(f.moves());
    EXPECT_TRUE(f.has_event("base_back"));
    ASSERT_TRUE(f.ask(ResumeMission{}));
    f.run(2.0);
    EXPECT_TRUE(f.moves());
    f.events.clear();
  }
}

TEST(Arbiter, TheRadioMayTakeTheBaseAndGiveItBackThroughStandby) {
  Field f;
  f.drive_mission();
  // The base tells who drives only now and then; the lever is quicker.
  f.swb = base::Switch::Middle;
  f.run(0.06);
  f.control_mode = base::ControlMode::Radio;
  f.run(1.0);
  f.swb = base::Switch::Up;
  f.run(0.06);
  f.control_mode = base::ControlMode::Standby;
  f.run(0.5);
  EXPECT_FALSE(f.moves());
  f.control_mode = base::ControlMode::Can;
  f.run(2.0);
  EXPECT_TRUE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Running);
  EXPECT_FALSE(f.has_event("base_left_control"));
}

TEST(Arbiter, WhatAVehicleCannotDoIsNoSignOfALostCommand) {
  Config steered;
  steered.vehicle.kinematics = "ackermann";
  steered.vehicle.max_speed_mps = 0.3;
  Field f(steered);
  f.obeys = false;
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.let_go();
  const auto drive = [&f](base::BodyTwist twist, base::BodyTwist does) {
    f.does = does;
    for (int i = 0; i < 150; ++i) {
      f.robot.request(Drive{twist, true}, f.now + std::chrono::milliseconds(250), {});
      f.tick();
    }
  };
  drive({0.0, 0.5}, {});           // it cannot turn on the spot
  drive({1.0, 0.0}, {0.25, 0.0});  // nor go as fast as that
  EXPECT_EQ(f.state()->mode, Mode::Manual);
  EXPECT_FALSE(f.has_event("base_not_following"));
  drive({1.0, 0.0}, {});
  EXPECT_EQ(f.state()->mode, Mode::Hold);
  EXPECT_TRUE(f.has_event("base_not_following"));
  EXPECT_TRUE(f.has_condition("base_not_following"));
}

TEST(ObedienceWatch, AllowsForALagAndNamesABaseThatDoesNotMove) {
  using std::chrono::milliseconds;
  ObedienceWatch w;
  base::Time t{};
  const auto run = [&](double told_mps, double does_mps, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      t += milliseconds(20);
      w.step({told_mps, 0.0}, base::BodyTwist{does_mps, 0.0}, t, 0.3);
    }
  };
  run(0.5, 0.0, 30);  // setting off, 0.6 s late
  EXPECT_FALSE(w.lost());
  run(0.5, 0.3, 50);
  EXPECT_FALSE(w.lost());
  run(-0.5, 0.3, 30);  // reversing takes as long
  EXPECT_FALSE(w.lost());
  run(-0.5, 0.3, 10);
  EXPECT_TRUE(w.lost());
  EXPECT_TRUE(w.failing());
  run(0.0, 0.0, 100);  // nothing asked: still lost, but not failing
  EXPECT_TRUE(w.lost());
  EXPECT_FALSE(w.failing());
  run(0.5, 0.5, 30);
  EXPECT_FALSE(w.lost());
  run(0.05, 0.0, 200);  // too slow to judge
  EXPECT_FALSE(w.lost());
}

/// Uphill with a load: 0.2 m/s each second, told 1 m/s.
TEST(ObedienceWatch, ABaseThatStillGetsFasterObeysAndOneThatStaysSlowDoesNot) {
  ObedienceWatch w;
  base::Time t{};
  double does_mps = 0.0;
  const auto run = [&](double accel_mps2, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      t += std::chrono::milliseconds(20);
      does_mps += accel_mps2 * 0.02;
      w.step({1.0, 0.0}, base::BodyTwist{does_mps, 0.0}, t, 0.3);
    }
  };
  run(0.0, 20);
  run(0.2, 150);
  EXPECT_FALSE(w.lost());
  does_mps = 0.3;
  run(0.0, 60);
  EXPECT_TRUE(w.lost());
}

/// A track that is off rattles: that is no getting faster.
TEST(ObedienceWatch, RattlingIsNoProgress) {
  ObedienceWatch w;
  base::Time t{};
  for (int i = 0; i < 100; ++i) {
    t += std::chrono::milliseconds(20);
    w.step({1.0, 0.0}, base::BodyTwist{i % 2 == 0 ? 0.1 : 0.0, 0.0}, t, 0.3);
  }
  EXPECT_TRUE(w.lost());
}

TEST(ObedienceWatch, JudgesATurnOnTheSpotByItsRateAndNothingWithoutAWord) {
  ObedienceWatch w;
  base::Time t{};
  const auto run = [&](double told_radps, std::optional<base::BodyTwist> does) {
    for (int i = 0; i < 50; ++i) {
      t += std::chrono::milliseconds(20);
      w.step({0.0, told_radps}, does, t, 0.3);
    }
  };
  run(0.5, base::BodyTwist{0.0, 0.4});
  EXPECT_FALSE(w.lost());
  run(0.5, std::nullopt);
  EXPECT_FALSE(w.lost());
  run(0.5, base::BodyTwist{0.3, 0.0});
  EXPECT_TRUE(w.lost());
  w.heard();
  EXPECT_FALSE(w.lost());
}

TEST(Arbiter, EachLossStopsSaysWhyAndDoesNotGoOnByItself) {
  struct Case {
    const char* condition;
    double after_s;
    void (*lose)(Field&);
    void (*find)(Field&);
  };
  const Case cases[] = {
      {"base_lost", 0.45, [](Field& f) { f.base_speaks = false; },
       [](Field& f) { f.base_speaks = true; }},
      {"base_exception", 0.15, [](Field& f) { f.vehicle_state = base::VehicleState::Exception; },
       [](Field& f) { f.vehicle_state = base::VehicleState::Normal; }},
      {"base_exception", 0.15, [](Field& f) { f.vehicle_state = base::VehicleState::Unknown; },
       [](Field& f) { f.vehicle_state = base::VehicleState::Normal; }},
      {"radio_lost", 0.55, [](Field& f) { f.radio_speaks = false; },
       [](Field& f) { f.radio_speaks = true; }},
      {"radio_lost", 0.55, [](Field& f) { f.radio_counts = false; },
       [](Field& f) { f.radio_counts = true; }},
      {"radio_lost", 0.15, [](Field& f) { f.radio_lost = true; },
       [](Field& f) { f.radio_lost = false; }},
      {"gnss_lost", 6.3, [](Field& f) { f.gnss_speaks = false; },
       [](Field& f) { f.gnss_speaks = true; }},
      {"battery", 0.1, [](Field& f) { f.charge_pct = 5.0; }, [](Field& f) { f.charge_pct = 80.0; }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.condition);
    Field f;
    f.drive_mission();
    c.lose(f);
    f.run(c.after_s);
    EXPECT_FALSE(f.moves());
    EXPECT_EQ(f.execution(), ExecutionState::Paused);
    EXPECT_EQ(f.state()->mode, Mode::Hold);
    EXPECT_NE(f.state()->mission.reason, "");
    EXPECT_FALSE(f.ask(ResumeMission{}));
    c.find(f);
    f.run(2.0);
    EXPECT_FALSE(f.moves());
    EXPECT_EQ(f.execution(), ExecutionState::Paused);
    EXPECT_TRUE(f.ask(ResumeMission{}));
    f.run(2.0);
    EXPECT_TRUE(f.moves());
  }
}

TEST(Arbiter, TheWorstOfTwoLossesDecides) {
  Field f;
  f.drive_mission();
  f.radio_speaks = false;
  f.vehicle_state = base::VehicleState::Estop;
  f.run(1.0);
  EXPECT_TRUE(f.state()->estop);
  EXPECT_TRUE(f.has_condition("radio_lost"));
  EXPECT_TRUE(f.has_condition("base_estop"));
}

TEST(Arbiter, AFlappingLinkDoesNotLetItMoveInBetween) {
  Field f;
  f.drive_mission();
  for (int i = 0; i < 10; ++i) {
    f.radio_speaks = false;
    f.run(0.7);
    f.radio_speaks = true;
    f.run(0.7);
    EXPECT_FALSE(f.moves());
  }
}

TEST(Arbiter, HandCommandsWorkInManualOnlyAndWhileFresh) {
  Field f;
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  const auto drive = [&](double v) {
    f.robot.request(Drive{{v, 0.0}, true}, f.now + std::chrono::milliseconds(250), {});
    f.tick();
  };
  drive(0.5);
  EXPECT_FALSE(f.moves());  // HOLD
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  f.let_go();
  for (int i = 0; i < 100; ++i) drive(5.0);
  EXPECT_NEAR(f.command.twist.linear_mps, 1.0, 1e-9);  // cut to the limit
  f.run(0.48);
  EXPECT_TRUE(f.moves());
  f.run(0.06);
  EXPECT_FALSE(f.moves());
  drive(0.5);
  EXPECT_FALSE(f.moves());  // let go first
  f.robot.request(Drive{{}, false}, f.now, {});
  f.tick();
  drive(0.5);
  EXPECT_TRUE(f.moves());
  f.radio_speaks = false;
  for (int i = 0; i < 40; ++i) drive(0.5);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.state()->mode, Mode::Hold);
}

TEST(Manual, RefusesNothingButStopsOnEverythingOdd) {
  Manual m{ManualParams{}};
  const base::Time t{};
  const auto hold = [&](double speed_mps) { m.drive({{speed_mps, 0.0}, true, 1, t}, t); };
  m.drive({{}, false, 1, t}, t);
  hold(0.4);
  for (int i = 0; i < 100; ++i) m.step(t, 0.02);
  EXPECT_DOUBLE_EQ(m.step(t, 0.02).linear_mps, 0.4);
  hold(-0.4);
  EXPECT_LT(m.step(t, 0.02).linear_mps, 0.0);  // through zero at once, then with the ramp
  hold(0.0);
  EXPECT_EQ(m.step(t, 0.02), base::BodyTwist{});
}

TEST(Robot, SurvivesAnyMeasurement) {
  Field f;
  f.run(1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  auto& in = f.robot.measurements();
  for (const double x : {nan, inf, -inf, 1e300, -1e300}) {
    base::GnssFix fix;
    fix.stamp = f.now + std::chrono::milliseconds(1);
    fix.fix = base::FixType::RtkFixed;
    fix.position = base::LatLon{x, x};
    fix.hdop = x;
    fix.sigma_east_m = x;
    fix.alt_msl_m = x;
    in.put(fix);
    in.put(base::GnssVelocity{f.now, x, x, x});
    in.put(base::Heading{f.now, x, base::HeadingSource::DualAntenna});
    in.put(base::WheelTravel{f.now, x, -x});
    in.put(base::BaseMotion{f.now, {x, x}});
    in.put(base::BatteryState{f.now, x, x, x, x});
    f.run(0.5);
    ASSERT_TRUE(f.state()->pose);
    EXPECT_TRUE(std::isfinite(f.state()->pose->at.east_m));
    EXPECT_TRUE(std::isfinite(f.state()->pose->yaw_rad));
    EXPECT_TRUE(std::isfinite(f.state()->pose->speed_mps.value_or(0.0)));
  }
  EXPECT_FALSE(f.moves());
}

}  // namespace
}  // namespace roverd::robot
