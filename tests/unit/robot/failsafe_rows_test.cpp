// Rows of the table of failsafes through a whole robot: a lean, drivers that fall, motors and a
// battery that warn, a charge that does not bring it home.

#include "field.hpp"
#include "robot/safety/battery_use.hpp"
#include "robot/safety/driver_falls.hpp"
#include "robot/safety/lean.hpp"

namespace roverd::robot {
namespace {

const std::string& told(const Field& f, const std::string& id) {
  const auto& all = f.state()->safety;
  const auto at = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.id == id; });
  static const std::string nothing;
  return at == all.end() ? nothing : at->detail;
}

// ---- leaning ----

TEST(Lean, IsTheAngleToTheVerticalWhicheverWay) {
  const auto of = [](double roll_deg, double pitch_deg) {
    return lean_deg({{}, base::rad_from_deg(roll_deg), base::rad_from_deg(pitch_deg)});
  };
  EXPECT_NEAR(of(0, 0), 0.0, 1e-6);
  EXPECT_NEAR(of(-25, 0), 25.0, 1e-6);
  EXPECT_NEAR(of(0, 25), 25.0, 1e-6);
  EXPECT_NEAR(of(20, 20), 27.99, 0.01);
  EXPECT_NEAR(of(180, 0), 180.0, 1e-6);
}

struct Leaning : Field {
  double roll_deg = 0.0;
  explicit Leaning(const Config& config = {}) : Field(config) {
    more = [this] {
      robot.measurements().put(base::Attitude{now, base::rad_from_deg(roll_deg), 0.0});
    };
  }
};

TEST(Tilt, WarnsFirstAndHoldsBeforeItRollsOver) {
  Leaning f;
  f.drive_mission();
  EXPECT_FALSE(f.has_condition("tilt"));
  f.roll_deg = -22.0;
  f.run(1.0);
  EXPECT_EQ(told(f, "tilt"), "the robot leans by 22 deg");
  EXPECT_TRUE(f.moves());
  f.roll_deg = -31.0;
  f.run(0.2);
  EXPECT_TRUE(f.moves()) << "a stone under a track is no slope";
  f.run(0.3);
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
  EXPECT_EQ(f.state()->mission.reason, "the robot leans by 31 deg");
  f.roll_deg = 0.0;
  f.run(3.0);
  EXPECT_FALSE(f.moves()) << "not by itself";
  EXPECT_TRUE(f.ask(ResumeMission{}));
}

TEST(Tilt, WhatTipsOverEarlierHoldsEarlierAndToASideOnly) {
  Config config;
  config.vehicle.support_width_m = 0.6;
  config.vehicle.mass_height_m = 0.5;  // a tank on top: tips over at 31 deg, holds at 18.6
  Leaning f(config);
  f.drive_mission();
  f.roll_deg = 18.0;
  f.run(1.0);
  EXPECT_FALSE(f.has_condition("roll_over"));
  EXPECT_EQ(f.state()->speed_reason, "slope");
  f.roll_deg = -19.0;
  f.run(1.0);
  EXPECT_EQ(told(f, "roll_over"), "the robot leans to a side by 19 deg; it may by 19 deg");
  EXPECT_FALSE(f.moves());
  EXPECT_EQ(f.execution(), ExecutionState::Paused);
}

TEST(Tilt, HoldsByHandTooAndABlowDoesNot) {
  Leaning f;
  f.run(8.0);
  ASSERT_TRUE(f.ask(Arm{}));
  ASSERT_TRUE(f.ask(SetMode{Mode::Manual}));
  for (int i = 0; i < 40; ++i) {
    f.roll_deg = i % 10 < 5 ? 40.0 : 0.0;
    f.run(0.05);
  }
  EXPECT_EQ(f.state()->mode, Mode::Manual);
  f.roll_deg = 40.0;
  f.run(0.5);
  EXPECT_EQ(f.state()->mode, Mode::Hold);
}

TEST(Tilt, WhereNothingTellsHowItLeansNothingIsSaid) {
  Leaning f;
  f.roll_deg = 40.0;
  f.run(1.0);
  EXPECT_TRUE(f.has_condition("tilt"));
  f.more = nullptr;
  f.run(2.0);
  EXPECT_FALSE(f.has_condition("tilt"));
}

// ---- the radio ----

TEST(RadioLost, WhileItDrivesTheMissionIsHeldAndDoesNotGoOnWhenTheBaseDropsBack) {
  for (const bool frozen : {false, true}) {
    Field f;
    f.drive_mission();
    f.control_mode = base::ControlMode::Radio;
    f.swb = base::Switch::Down;
    f.run(2.0);
    EXPECT_EQ(f.execution(), ExecutionState::Running) << "it waits for the radio";
    EXPECT_FALSE(f.has_condition("radio_lost"));
    (frozen ? f.radio_counts : f.radio_speaks) = false;
    f.run(1.0);
    EXPECT_TRUE(f.has_condition("radio_lost"));
    EXPECT_EQ(f.execution(), ExecutionState::Paused);
    f.control_mode = base::ControlMode::Can;
    f.radio_counts = f.radio_speaks = true;
    f.swb = base::Switch::Up;
    f.run(3.0);
    EXPECT_FALSE(f.moves()) << "only an operator's word goes on";
    EXPECT_TRUE(f.ask(ResumeMission{}));
  }
}

// ---- the gyro ----

TEST(GyroLost, IsShownFromItsSilenceToItsReturn) {
  Field f;
  f.run(2.0);
  EXPECT_FALSE(f.has_condition("gyro_lost")) << "there never was one";
  const auto spin = [&f] {
    base::Inertial m;
    m.stamp = f.now;
    m.rate_radps = base::BodyVector{};
    f.robot.measurements().put(m);
  };
  f.more = spin;
  f.run(2.0);
  EXPECT_FALSE(f.has_condition("gyro_lost"));
  f.more = nullptr;
  f.run(1.0);
  EXPECT_TRUE(f.has_condition("gyro_lost"));
  f.more = spin;
  f.run(1.0);
  EXPECT_FALSE(f.has_condition("gyro_lost"));
}

// ---- drivers ----

base::DriverStatus status(Time at, base::DriverPhase phase, const char* name = "gnss") {
  base::DriverStatus s;
  s.stamp = at;
  s.name = name;
  s.phase = phase;
  return s;
}

TEST(DriverFalls, CountsFallsOfTheLastMinuteAndNamesTheWorst) {
  using Phase = base::DriverPhase;
  DriverFalls falls;
  Time now{};
  EXPECT_EQ(falls.worst(now).falls, 0);
  for (int i = 0; i < 3; ++i) {
    for (const Phase p : {Phase::Opening, Phase::Up, Phase::Faulty, Phase::Down}) {
      falls.take(status(now += std::chrono::seconds(1), p));
    }
  }
  falls.take(status(now, Phase::Up, "imu"));
  falls.take(status(now, Phase::Failed, "imu"));
  EXPECT_EQ(falls.worst(now).name, "gnss");
  EXPECT_EQ(falls.worst(now).falls, 3);
  EXPECT_EQ(falls.worst(now + std::chrono::seconds(56)).falls, 1)
      << "the first ones are a minute old";
  EXPECT_EQ(falls.worst(now + std::chrono::seconds(61)).falls, 0);
}

TEST(DriverFalls, OneThatNeverComesUpDoesNotFall) {
  using Phase = base::DriverPhase;
  DriverFalls falls;
  Time now{};
  for (int i = 0; i < 10; ++i) {
    falls.take(status(now += std::chrono::seconds(1), Phase::Opening));
    falls.take(status(now, Phase::Faulty));
  }
  EXPECT_EQ(falls.worst(now).falls, 0);
}

TEST(DriverFalls, AreShownAndTheRobotDrivesOn) {
  Field f;
  f.drive_mission();
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(f.has_condition("driver_falls")) << i;
    f.robot.measurements().put(status(f.now, base::DriverPhase::Up));
    f.run(0.5);
    f.robot.measurements().put(status(f.now, base::DriverPhase::Faulty));
    f.run(0.5);
  }
  EXPECT_EQ(told(f, "driver_falls"), "the driver gnss fell 3 times within a minute");
  EXPECT_TRUE(f.moves());
}

// ---- motors and battery ----

TEST(MotorFault, IsShownWithItsMotorUntilItIsGone) {
  Field f;
  f.run(1.0);
  base::MotorState m;
  m.stamp = f.now;
  m.motor = 2;
  m.faults = {"over-current", "motor too hot"};
  f.robot.measurements().put(m);
  f.run(0.1);
  EXPECT_EQ(told(f, "motor_fault"), "motor 2: over-current, motor too hot");
  m.faults.clear();
  f.robot.measurements().put(m);
  f.run(0.1);
  EXPECT_FALSE(f.has_condition("motor_fault"));
}

TEST(BatteryAlarm, IsShown) {
  Field f;
  f.run(1.0);
  f.robot.measurements().put(base::BatteryState{f.now, 80.0, 50.0, {}, {}, {"warning 1: 0x04"}});
  f.run(0.1);
  EXPECT_EQ(told(f, "battery_alarm"), "the battery warns: warning 1: 0x04");
}

struct Used {
  BatteryUse use;
  void drive(double metres, double charge_pct) {
    base::BatteryState b;
    b.charge_pct = charge_pct;
    use.step(b, -1.0, metres);  // backwards counts as well
  }
};

TEST(BatteryUse, IsKnownAfterThreePercentAndTwoHundredMetres) {
  Used u;
  u.use.step(std::nullopt, 1.0, 1000.0);
  u.drive(0.0, 80.0);
  u.drive(150.0, 70.0);
  EXPECT_FALSE(u.use.pct_per_m()) << "too short a way";
  u.drive(50.0, 70.0);
  ASSERT_TRUE(u.use.pct_per_m());
  EXPECT_NEAR(*u.use.pct_per_m(), 0.05, 1e-9);
  u.drive(200.0, 60.0);
  EXPECT_NEAR(*u.use.pct_per_m(), 0.05, 1e-9);
}

TEST(BatteryUse, BeginsAnewWhenItWasChargedAndKeepsWhatItKnew) {
  Used u;
  u.drive(0.0, 80.0);
  u.drive(400.0, 60.0);
  EXPECT_NEAR(*u.use.pct_per_m(), 0.05, 1e-9);
  u.drive(0.0, 61.0);  // noise
  u.drive(100.0, 55.0);
  EXPECT_NEAR(*u.use.pct_per_m(), 0.05, 1e-9);
  u.drive(0.0, 100.0);
  EXPECT_NEAR(*u.use.pct_per_m(), 0.05, 1e-9);
  u.drive(300.0, 97.0);
  EXPECT_NEAR(*u.use.pct_per_m(), 0.01, 1e-9) << "on a better ground";
}

/// A robot that was seen to use 10 % for about 240 m, on its way from home.
struct FarFromHome : Field {
  explicit FarFromHome(const char* follows) : Field(config(follows)) {
    charge_pct = 80.0;
    run(1.0);
    more = [this] { robot.measurements().put(base::BaseMotion{now, {60.0, 0.0}}); };
    run(4.0);
    charge_pct = 70.0;
    run(0.2);
    more = nullptr;
    run(8.0);
    drive_mission();
    run(2.0);
  }
  static Config config(const char* follows) {
    Config c;
    c.safety.battery_home = follows;
    return c;
  }
};

TEST(BatteryHome, WarnsWhereTheChargeAboveTheLimitDoesNotBringItHome) {
  FarFromHome f("warn");
  EXPECT_FALSE(f.has_condition("battery_home"));
  f.charge_pct = 8.1;
  f.run(0.2);
  EXPECT_TRUE(f.has_condition("battery_home"));
  EXPECT_TRUE(told(f, "battery_home").starts_with("charge is 8 %, and home is "))
      << told(f, "battery_home");
  EXPECT_TRUE(f.moves());
  EXPECT_FALSE(f.has_condition("battery")) << "not empty yet";
}

TEST(BatteryHome, ReturnsOrHoldsWhereThatIsChosen) {
  FarFromHome home("return");
  home.charge_pct = 8.1;
  home.run(0.2);
  EXPECT_EQ(home.state()->mode, Mode::Rtl);
  EXPECT_EQ(home.execution(), ExecutionState::Paused);
  home.run(60.0);
  EXPECT_LT(std::hypot(home.at.east_m, home.at.north_m), 0.5);
  FarFromHome here("hold");
  here.charge_pct = 8.1;
  here.run(0.2);
  EXPECT_EQ(here.state()->mode, Mode::Hold);
  EXPECT_FALSE(here.moves());
}

}  // namespace
}  // namespace roverd::robot
