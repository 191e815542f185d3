// The stop by counted rays, beside the sweep and instead of it, in the guard and the whole robot.

#include <cmath>
#include <optional>
#include <string>

#include "seeing.hpp"

namespace roverd::robot {
namespace {

base::Time at_s(double s) {
  return base::Time{} + base::from_seconds(100.0 + s);
}

/// All around is seen and free, but for a thing beside; and what the rays say.
struct Counting {
  explicit Counting(bool instead, bool thing = false) : beside(thing) {
    nav::sense::RaysParams rays;
    rays.enabled = true;
    rays.instead = instead;
    guard.set({}, {}, true, {}, {}, {}, rays);
    look(0.0, false);
  }
  void look(double t, bool stop) {
    auto s = std::make_shared<Surroundings>();
    s->patch.stamp = at_s(t);
    s->patch.side = 280;
    s->patch.x0 = s->patch.y0 = -140;
    s->patch.cells.assign(280 * 280, {Known::Free, 0, 0});
    s->patch.cells[144 * 280 + 162].known = met;
    if (beside) {  // 1.2 m ahead, 5 cm wide: no five rays
      s->patch.cells[140 * 280 + 164].known = Known::Occupied;
    }
    base::SensorState state;
    state.name = "camera";
    s->sensors = std::make_shared<const std::vector<base::SensorState>>(1, state);
    s->seen = at_s(t);
    if (stop) s->rays = RaysStop{0, 6, {1.1, 0.2}, at_s(t - 0.05), 0.0, {}, lost};
    if (way_m) s->rays_ahead = RaysStop{0, 7, {1.6, 0.0}, at_s(t), *way_m, {}, false};
    (void)guard.take(std::move(s));
    (void)guard.move({}, at_s(t));
  }
  base::BodyTwist drive(const base::BodyTwist& wanted, double t, bool by_itself = true) {
    return guard.judge(wanted, by_itself, at_s(t));
  }
  Guard guard;
  bool beside;
  bool lost = false;
  Known met = Known::Free;      ///< what the grid knows where the rays met something
  std::optional<double> way_m;  ///< until the rays say stop
};

TEST(CountedRaysGuard, StopWhatDrivesAheadAndSayWhy) {
  for (const bool instead : {false, true}) {
    Counting r(instead);
    EXPECT_EQ(r.drive({0.3, 0.0}, 0.0).linear_mps, 0.3);
    r.look(0.1, true);
    EXPECT_EQ(r.drive({0.3, 0.1}, 0.1).linear_mps, 0.0);
    EXPECT_EQ(r.guard.news(), std::optional(true));
    const base::Obstacle& o = r.guard.obstacle();
    EXPECT_EQ(o.action, base::GuardAction::Stop);
    EXPECT_EQ(o.what, "obstacle");
    EXPECT_EQ(o.sensor, "camera");
    EXPECT_NEAR(o.ahead_m, 1.1, 1e-9);
    EXPECT_NEAR(o.left_m, 0.2, 1e-9);
    EXPECT_NEAR(o.bearing_rad, std::atan2(0.2, 1.1), 1e-9);
    EXPECT_NEAR(o.age_s, 0.05, 1e-9);
    EXPECT_EQ(
        o.reason,
        "something stands in the way, 0.6 m ahead, seen by camera: 6 rays shorter than 0.70 m "
        "(sense.rays.stop_m)");
  }
}

TEST(CountedRaysGuard, WhatStoodThereIsToldFromWhereTheBodyIsByNow) {
  Counting r(true);
  r.look(0.0, true);
  for (int i = 1; i <= 10; ++i) (void)r.guard.move({0.5, 0.0}, at_s(0.02 * i));
  (void)r.drive({0.3, 0.0}, 0.2);
  EXPECT_NEAR(r.guard.obstacle().ahead_m, 1.0, 1e-6);
}

TEST(CountedRaysGuard, ItGoesOnWhenTheWayHasBeenClearForASecond) {
  Counting r(true);
  r.look(0.0, true);
  EXPECT_EQ(r.drive({0.3, 0.0}, 0.0).linear_mps, 0.0);
  r.look(1.5, true);
  (void)r.guard.may_go_on(at_s(1.5));
  EXPECT_TRUE(r.guard.stops());
  for (int i = 0; i < 9; ++i) {
    r.look(2.0 + 0.1 * i, false);
    (void)r.guard.may_go_on(at_s(2.0 + 0.1 * i));
    EXPECT_TRUE(r.guard.stops());
  }
  r.look(3.1, false);
  EXPECT_TRUE(r.guard.may_go_on(at_s(3.1)));
  EXPECT_FALSE(r.guard.stops());
  EXPECT_EQ(r.drive({0.3, 0.0}, 3.1).linear_mps, 0.3);
}

TEST(CountedRaysGuard, HoldNobodyWhoDrivesBackOrTurns) {
  Counting r(true);
  r.look(0.0, true);
  EXPECT_EQ(r.drive({0.3, 0.0}, 0.0, false).linear_mps, 0.0) << "a hand is stopped, too";
  EXPECT_EQ(r.drive({-0.3, 0.0}, 0.0, false).linear_mps, -0.3);
  EXPECT_EQ(r.drive({0.0, 0.4}, 0.0, false).angular_radps, 0.4);
  // And who holds it off drives slowly on.
  EXPECT_NEAR(r.guard.overrule({0.3, 0.0}, at_s(0.0)).linear_mps, 0.15, 1e-9);
  EXPECT_EQ(r.guard.obstacle().action, base::GuardAction::Overridden);
}

TEST(CountedRaysGuard, InsteadOfTheSweepNothingElseStopsItAndBesideItTheSweepDoes) {
  Counting beside(false, true);
  EXPECT_LT(beside.drive({0.8, 0.0}, 0.0).linear_mps, 0.7);
  EXPECT_EQ(beside.guard.obstacle().what, "obstacle");
  Counting instead(true, true);
  EXPECT_EQ(instead.drive({0.8, 0.0}, 0.0).linear_mps, 0.8);
  // A picture that is too old is none, whatever it said: it creeps.
  EXPECT_NEAR(instead.drive({0.8, 0.0}, 2.0).linear_mps, 0.25, 1e-9);
  EXPECT_EQ(instead.guard.obstacle().what, "blind");
}

//   At 0.6 m/s² and with a delay of 0.2 s, as before anything else.
TEST(CountedRaysGuard, BeforeTheyStopItTheySlowItInProportion) {
  for (const bool instead : {false, true}) {
    Counting r(instead);
    const nav::sense::ProtectParams params;
    double before_mps = 0.0;
    for (const double way_m : {0.02, 0.1, 0.3, 0.6}) {
      r.way_m = way_m;
      r.look(way_m, false);
      const double v_mps = r.drive({0.8, 0.0}, way_m).linear_mps;
      EXPECT_NEAR(v_mps * params.delay_s + v_mps * v_mps / (2.0 * params.decel_mps2), way_m, 1e-6);
      EXPECT_GT(v_mps, before_mps);
      before_mps = v_mps;
      EXPECT_EQ(r.guard.obstacle().action, base::GuardAction::Slow);
      EXPECT_NE(r.guard.obstacle().reason.find("7 rays shorter than 1.50 m (sense.rays.slow_m)"),
                std::string::npos)
          << r.guard.obstacle().reason;
      EXPECT_EQ(r.drive({-0.8, 0.0}, way_m).linear_mps, -0.8) << "not who drives back";
    }
    r.way_m = 0.8;
    r.look(1.0, false);
    EXPECT_EQ(r.drive({0.8, 0.0}, 1.0).linear_mps, 0.8);
  }
}

TEST(CountedRaysGuard, TheWayThatWasDrivenSinceIsTakenOff) {
  Counting r(true);
  r.way_m = 0.5;
  r.look(0.0, false);
  for (int i = 1; i <= 20; ++i) (void)r.guard.move({0.5, 0.0}, at_s(0.02 * i));
  const double v_mps = r.drive({0.8, 0.0}, 0.4).linear_mps;
  EXPECT_NEAR(v_mps * 0.2 + v_mps * v_mps / 1.2, 0.3, 1e-6);
}

TEST(CountedRaysGuard, WhatALostSensorSaidIsGroundThatNobodyHasSeen) {
  for (const bool instead : {false, true}) {
    Counting r(instead);
    r.lost = true;
    r.look(0.0, true);
    EXPECT_NEAR(r.drive({0.8, 0.0}, 0.0).linear_mps, 0.25, 1e-9) << "the creep speed";
    EXPECT_EQ(r.guard.obstacle().action, base::GuardAction::Creep);
    EXPECT_EQ(r.guard.obstacle().what, "unseen");
    EXPECT_NE(r.guard.obstacle().reason.find("camera saw something, and sees no more"),
              std::string::npos)
        << r.guard.obstacle().reason;
  }
}

//   What was met 1.1 m ahead and 0.2 m to the left, by who sees no more.
TEST(CountedRaysGuard, AloneTheyHoldWhatALostSensorMetUntilAnotherSeesThePlaceFree) {
  Counting r(true);
  r.lost = true;
  for (const Known known : {Known::Unknown, Known::Occupied}) {
    r.met = known;
    r.look(0.0, true);
    EXPECT_EQ(r.drive({0.8, 0.0}, 0.0).linear_mps, 0.0);
    EXPECT_EQ(r.guard.obstacle().action, base::GuardAction::Stop);
    EXPECT_EQ(r.guard.obstacle().what, "obstacle");
    EXPECT_NE(r.guard.obstacle().reason.find("sees no more"), std::string::npos);
    r.guard.forget();
    EXPECT_EQ(r.drive({-0.8, 0.0}, 0.0).linear_mps, -0.8) << "away from it";
  }
  // Free there, but its legs stand a little farther on: the sweep stops before them.
  r.met = Known::Free;
  r.beside = true;
  r.look(0.1, true);
  const double v_mps = r.drive({0.8, 0.0}, 0.1).linear_mps;
  EXPECT_LE(v_mps, 0.25);
  for (int i = 0; i < 25; ++i) (void)r.guard.move({1.0, 0.0}, at_s(0.1 + 0.02 * (i + 1)));
  EXPECT_EQ(r.drive({0.8, 0.0}, 0.6).linear_mps, 0.0) << "0.7 m before it";
}

TEST_F(Seeing, AMissionStandsWhileTheRaysSayStopAndGoesOnWhenTheyDoNot) {
  nav::sense::RaysParams on;
  on.enabled = true;
  field.robot.guard_by({}, true, {}, {}, on);
  field.drive_mission();
  ASSERT_TRUE(field.moves());
  rays = RaysStop{0, 5, {pose.x_m + 1.5, pose.y_m}, field.now};
  field.run(3.0);
  EXPECT_FALSE(field.moves());
  EXPECT_TRUE(field.has_event("obstacle"));
  EXPECT_TRUE(field.has_condition("obstacle"));
  EXPECT_EQ(field.state()->obstacle->sensor, "front");
  rays.reset();
  field.run(0.5);
  EXPECT_FALSE(field.moves());
  field.run(3.0);
  EXPECT_TRUE(field.moves());
  EXPECT_TRUE(field.has_event("obstacle_gone"));
}

}  // namespace
}  // namespace roverd::robot
