// The guided calibration drive by the plant of the simulator: tracks and a car, without bus,
// receiver or estimator. What was measured is compared with what the plant is made of.

#include <cmath>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "nav/calibrate/calibrate.hpp"
#include "sim/car.hpp"
#include "sim/tracks.hpp"

namespace roverd::nav {
namespace {

using base::CalibrationKind;
using base::Quantity;
using State = Calibrate::State;

constexpr double kPace_s = 0.02;

/// A vehicle under its calibration. The heirs move it.
class Course {
 public:
  virtual ~Course() = default;

  void begin(CalibrationKind kind) {
    CalibrationBefore before;
    before.delay_s = set.track.delay_s;
    before.braking_mps2 = set.speed.decel_mps2;
    space = calibration_space(kind, set);
    calibrate.emplace(set);
    calibrate->begin(kind, vehicle(), before, set);
  }
  void tick() {
    CalibrationSight s;
    s.vehicle = vehicle();
    s.seen.now = now;
    s.seen.ours = true;
    s.seen.tracks = shown();
    s.seen.tracks_stamp = now;
    s.seen.yaw_rate_radps = s.vehicle.yaw_rate_radps;
    s.told = shown();
    s.told_stamp = now;
    s.turn_measured = true;
    if (antennas_off_rad) s.antennas_rad = base::wrap_rad(yaw_rad + *antennas_off_rad);
    if (compass_off_rad) s.compass_rad = base::wrap_rad(yaw_rad + *compass_off_rad);
    calibrate->see(s);
    const base::BodyTwist told = calibrate->step(s.vehicle, limit_mps, kPace_s).command;
    calibrate->sent(told);
    for (int k = 0; k < 4; ++k) move(told, kPace_s / 4.0);
    const BodyPoint p = to_body(at, {}, 0.0);
    farthest.ahead_m = std::max(farthest.ahead_m, p.x_m);
    farthest.behind_m = std::max(farthest.behind_m, -p.x_m);
    farthest.left_m = std::max(farthest.left_m, p.y_m);
    farthest.right_m = std::max(farthest.right_m, -p.y_m);
    now += base::from_seconds(kPace_s);
    taken_s += kPace_s;
  }
  State run(CalibrationKind kind, double limit_s = 300.0) {
    begin(kind);
    while (calibrate->running() && taken_s < limit_s) tick();
    return calibrate->state();
  }
  /// What was measured of it.
  base::CalibrationValue of(Quantity q) const {
    const base::CalibrationState told = calibrate->tell();
    for (std::size_t i = 0; i < told.count; ++i) {
      if (told.values[i].of == q) return told.values[i];
    }
    ADD_FAILURE() << to_string(q) << " is not measured";
    return {};
  }
  double value(Quantity q) const { return of(q).after.value_or(std::nan("")); }

  PathParams set;
  sim::DriveParams plant;
  std::optional<Calibrate> calibrate;
  base::CalibrationSpace space;
  base::CalibrationSpace farthest;
  std::optional<double> antennas_off_rad, compass_off_rad;
  double limit_mps = 10.0;
  double taken_s = 0.0;
  EnuPoint at;
  double yaw_rad = 0.0;
  base::Time now = base::Time{} + std::chrono::seconds(10);

 protected:
  virtual base::BodyTwist shown() const = 0;
  virtual base::BodyTwist ground() const = 0;
  virtual void move(base::BodyTwist told, double dt_s) = 0;
  void carry(base::BodyTwist t, double dt_s) {
    yaw_rad = base::wrap_rad(yaw_rad + t.angular_radps * dt_s);
    at.east_m += t.linear_mps * std::cos(yaw_rad) * dt_s;
    at.north_m += t.linear_mps * std::sin(yaw_rad) * dt_s;
  }

 private:
  Vehicle vehicle() const {
    Vehicle v;
    v.at = at;
    v.yaw_rad = yaw_rad;
    v.yaw_sigma_rad = 0.01;
    v.sigma_m = 0.015;
    v.speed_mps = ground().linear_mps;
    v.yaw_rate_radps = ground().angular_radps;
    v.yaw_scale = set.vehicle.steered() ? 1.0 : 0.75;
    return v;
  }
};

class TracksCourse : public Course {
 public:
  double jitter_s = 0.0;

 protected:
  base::BodyTwist shown() const override { return tracks_.measured(); }
  base::BodyTwist ground() const override { return tracks_.ground().twist; }
  void move(base::BodyTwist told, double dt_s) override {
    sim::DriveParams p = plant;
    p.delay_s += jitter_.step(jitter_s, 0.3, dt_s);
    tracks_.step(p, told, false, dt_s);
    carry(tracks_.ground().twist, dt_s);
  }

 private:
  sim::Tracks tracks_{1};
  sim::Jitter jitter_{7};
};

class CarCourse : public Course {
 public:
  CarCourse() {
    set.vehicle.kinematics = "ackermann";
    set.vehicle.wheelbase_m = car.wheelbase_m = 2.55;
    set.vehicle.max_steering_deg = 33.0;
    set.vehicle.max_steering_rate_dps = 29.0;
    set.vehicle.max_speed_mps = set.speed.max_mps = 1.38;
    set.vehicle.length_m = 3.475;
    set.vehicle.width_m = 1.475;
    set.track.delay_s = 0.4;
    set.speed.accel_mps2 = 0.5;
    set.speed.decel_mps2 = 0.4;
    car.max_wheel_rad = 0.576;
    car.wheel_rate_radps = 0.52;
    car.linkage_rad = 0.02;
    plant.slip = 0.005;
    plant.delay_s = 0.1;
    plant.lag_s = 0.25;
    plant.accel_mps2 = 1.0;
    plant.decel_mps2 = 1.5;
  }
  sim::CarParams car;

 protected:
  base::BodyTwist shown() const override {
    const double v = car_.wheel_speed_mps();
    return {v, v * std::tan(car_.seen_rad()) / car.wheelbase_m};
  }
  base::BodyTwist ground() const override { return car_.ground().twist; }
  void move(base::BodyTwist told, double dt_s) override {
    sim::Car::Wanted wanted{told.linear_mps, std::nullopt};
    if (told.linear_mps != 0.0) {
      wanted.wheel_rad = std::atan(car.wheelbase_m * told.angular_radps / told.linear_mps);
    }
    car_.step(plant, car, wanted, false, dt_s);
    carry(car_.ground().twist, dt_s);
  }

 private:
  sim::Car car_;
};

void expect_measured(const Course& c, double delay_s, double braking_mps2, double turn_scale) {
  EXPECT_NEAR(c.value(Quantity::SteeringDelay), delay_s, 0.03);
  EXPECT_NEAR(c.value(Quantity::Braking), braking_mps2, 0.1 * braking_mps2);
  EXPECT_NEAR(c.value(Quantity::TurnScale), turn_scale, 0.02 * turn_scale);
}

void expect_inside(const Course& c) {
  const double body_m = c.set.vehicle.reach_m();
  EXPECT_LT(c.farthest.ahead_m + body_m, c.space.ahead_m);
  EXPECT_LT(c.farthest.behind_m + body_m, c.space.behind_m);
  EXPECT_LT(c.farthest.left_m + body_m, c.space.left_m);
  EXPECT_LT(c.farthest.right_m + body_m, c.space.right_m);
}

TEST(CalibrationDrive, OfTracksMeasuresWhatThePlantIsMadeOf) {
  for (const double delay_s : {0.06, 0.25}) {
    TracksCourse c;
    c.plant.delay_s = delay_s;
    ASSERT_EQ(c.run(CalibrationKind::Drive), State::Done) << c.calibrate->reason();
    expect_measured(c, delay_s + c.plant.lag_s, c.plant.decel_mps2, 0.92 / 1.3);
    EXPECT_NEAR(c.value(Quantity::SpeedScale), 0.92, 0.01);
    EXPECT_NEAR(c.value(Quantity::SideBias), 0.02 / (0.6 * 1.3), 0.006);
    EXPECT_TRUE(c.of(Quantity::Acceleration).at_least);
    expect_inside(c);
    EXPECT_LT(base::distance_m(c.at, {}), 0.5);
    EXPECT_LT(std::abs(c.yaw_rad), 0.1);
    EXPECT_LT(c.taken_s, 150.0);
  }
}

TEST(CalibrationDrive, OfTracksWithALoadFindsTheBrakesAndTheMotors) {
  TracksCourse c;
  c.plant.accel_mps2 = 0.5;
  c.plant.decel_mps2 = 0.6;
  c.plant.turn_accel_radps2 = 0.8;
  c.plant.turn_decel_radps2 = 0.4;
  ASSERT_EQ(c.run(CalibrationKind::Drive), State::Done) << c.calibrate->reason();
  expect_measured(c, c.plant.delay_s + c.plant.lag_s, 0.6, 0.92 / 1.3);
  EXPECT_NEAR(c.value(Quantity::Acceleration), 0.5, 0.05);
  EXPECT_FALSE(c.of(Quantity::Acceleration).at_least);
  expect_inside(c);
}

TEST(CalibrationDrive, OfTracksWhoseDelayJittersFindsTheMiddle) {
  TracksCourse c;
  c.plant.delay_s = 0.05;
  c.jitter_s = 0.35;
  ASSERT_EQ(c.run(CalibrationKind::Drive), State::Done) << c.calibrate->reason();
  expect_measured(c, 0.05 + 0.175 + c.plant.lag_s, c.plant.decel_mps2, 0.92 / 1.3);
  expect_inside(c);
}

TEST(CalibrationDrive, OfACarMeasuresWhatThePlantIsMadeOf) {
  for (const double delay_s : {0.1, 0.3}) {
    CarCourse c;
    c.plant.delay_s = delay_s;
    ASSERT_EQ(c.run(CalibrationKind::Drive), State::Done) << c.calibrate->reason();
    expect_measured(c, delay_s + c.car.wheel_lag_s, c.plant.decel_mps2, 1.0);
    EXPECT_NEAR(c.value(Quantity::SteeringZero), -0.02, 0.004);
    EXPECT_NEAR(c.value(Quantity::SpeedScale), 0.995, 0.01);
    expect_inside(c);
    EXPECT_LT(base::distance_m(c.at, {}), 3.0);
    EXPECT_LT(c.taken_s, 150.0);
  }
}

TEST(CalibrationDrive, OfTheSteeringAloneTellsNothingOfTheBrakes) {
  CarCourse c;
  ASSERT_EQ(c.run(CalibrationKind::Steering), State::Done) << c.calibrate->reason();
  EXPECT_NEAR(c.value(Quantity::SteeringZero), -0.02, 0.004);
  EXPECT_EQ(c.calibrate->tell().count, 3u);
}

TEST(CalibrationDrive, OfTheCompassTurnsBothWaysAndTellsItsOffset) {
  TracksCourse c;
  c.compass_off_rad = 0.3;
  ASSERT_EQ(c.run(CalibrationKind::Compass), State::Done) << c.calibrate->reason();
  EXPECT_NEAR(c.value(Quantity::CompassOffset), 0.3, 0.01);
  EXPECT_LT(c.value(Quantity::CompassSpread), 0.01);
  EXPECT_FALSE(c.of(Quantity::CompassOffset).keeps);
  expect_inside(c);
}

TEST(CalibrationDrive, OfTheAntennasTellsHowTheyAreMounted) {
  TracksCourse c;
  c.antennas_off_rad = -0.35;
  ASSERT_EQ(c.run(CalibrationKind::Antennas), State::Done) << c.calibrate->reason();
  EXPECT_NEAR(c.value(Quantity::AntennasOffset), -0.35, 0.01);
  CarCourse car;
  car.antennas_off_rad = 0.2;
  ASSERT_EQ(car.run(CalibrationKind::Antennas), State::Done) << car.calibrate->reason();
  EXPECT_NEAR(car.value(Quantity::AntennasOffset), 0.2, 0.02);
}

TEST(CalibrationDrive, EndsWhereSomethingSlowsIt) {
  TracksCourse c;
  c.begin(CalibrationKind::Drive);
  for (int i = 0; i < 500; ++i) c.tick();
  ASSERT_TRUE(c.calibrate->running());
  c.limit_mps = 0.4;
  c.tick();
  EXPECT_EQ(c.calibrate->state(), State::Failed);
  EXPECT_NE(c.calibrate->reason().find("slows"), std::string::npos);
  EXPECT_EQ(c.calibrate->tell().phase, base::CalibrationPhase::Failed);
}

TEST(CalibrationDrive, EndsWhereItLeavesItsSpace) {
  TracksCourse c;
  c.begin(CalibrationKind::Drive);
  for (int i = 0; i < 300; ++i) c.tick();
  c.at.north_m += 2.0;  // pushed
  c.tick();
  EXPECT_EQ(c.calibrate->state(), State::Failed);
  EXPECT_NE(c.calibrate->reason().find("space"), std::string::npos);
}

TEST(CalibrationDrive, EndsWhereTheRobotDoesNotFollow) {
  TracksCourse c;
  c.plant.stick_mps = 5.0;
  ASSERT_EQ(c.run(CalibrationKind::Drive), State::Failed);
  EXPECT_NE(c.calibrate->reason().find("does not do"), std::string::npos);
}

TEST(CalibrationDrive, EndedBySomebodyKeepsTheReason) {
  TracksCourse c;
  c.begin(CalibrationKind::Drive);
  for (int i = 0; i < 300; ++i) c.tick();
  c.calibrate->end("the emergency stop was pressed");
  EXPECT_EQ(c.calibrate->tell().phase, base::CalibrationPhase::Aborted);
  EXPECT_EQ(c.calibrate->reason(), "the emergency stop was pressed");
  EXPECT_EQ(c.calibrate->step({}, 10.0, kPace_s).command, base::BodyTwist{});
}

}  // namespace
}  // namespace roverd::nav
