// What is pulled, along the commanded curve: against driving it in small steps.
#include "nav/sense/trailer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kTractor = Footprint::box(1.0, 0.8, 0.5);

/// A trailer of 1.0 by 0.8 m, its axle 1.2 m behind the coupling, that 0.6 m behind the middle.
Trailer cart() {
  const std::array<Vec2, 5> corners{
      {{0.0, 0.0}, {-1.7, -0.4}, {-0.7, -0.4}, {-0.7, 0.4}, {-1.7, 0.4}}};
  return {*Footprint::of(corners), 0.6, 1.2};
}

Patch open_ground() {
  Patch p;
  p.x0 = p.y0 = -120;
  p.side = 240;
  p.cells.assign(240 * 240, {Known::Free, 3, 2});
  return p;
}

Vec2 put_pole(Patch& p, double x, double y) {
  const auto ix = static_cast<std::int32_t>(std::floor(x / p.cell_m));
  const auto iy = static_cast<std::int32_t>(std::floor(y / p.cell_m));
  p.cells[static_cast<std::size_t>((iy - p.y0) * p.side + ix - p.x0)].known = Known::Occupied;
  return {(ix + 0.5) * p.cell_m, (iy + 0.5) * p.cell_m};
}

/// A vehicle with its trailer, as they roll: the axle never slides sideways.
struct Train {
  Pose2 vehicle;
  double angle_rad = 0.0;

  void roll(const base::BodyTwist& t, double dt_s) {
    const Trailer c = cart();
    // Where the coupling and the axle are before and after: the axle follows along its drawbar.
    const Pose2 hitch = vehicle * Pose2{-c.hitch_m, 0.0, angle_rad};
    const Pose2 axle = hitch * Pose2{-c.axle_m, 0.0, 0.0};
    vehicle = vehicle * along(t.linear_mps, t.angular_radps, dt_s);
    const Pose2 then = vehicle * Pose2{-c.hitch_m, 0.0, 0.0};
    const double yaw = std::atan2(then.y_m - axle.y_m, then.x_m - axle.x_m);
    angle_rad = base::wrap_rad(yaw - vehicle.yaw_rad);
  }
  double to_trailer_m(Vec2 p) const {
    const Pose2 h = vehicle * Pose2{-cart().hitch_m, 0.0, angle_rad};
    const Pose2 in = inverse(h) * Pose2{p.x, p.y, 0.0};
    return cart().body.distance_m({in.x_m, in.y_m});
  }
  double to_vehicle_m(Vec2 p) const {
    const Pose2 in = inverse(vehicle) * Pose2{p.x, p.y, 0.0};
    return kTractor.distance_m({in.x_m, in.y_m});
  }
};

Coupling after_five_metres() {
  Coupling c;
  for (int i = 0; i < 250; ++i) c.drive(cart(), {1.0, 0.0}, 0.02);
  return c;
}

TEST(TrailerTest, TheTwoAnglesBoundTheTrueOneHoweverItIsDriven) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int run = 0; run < 200; ++run) {
    Train train;
    train.angle_rad = 0.95 * Coupling::kBegins_rad * unit(random);
    Coupling c;
    for (int leg = 0; leg < 8; ++leg) {
      const base::BodyTwist t{1.2 * unit(random), 0.4 * unit(random)};
      for (int i = 0; i < 50; ++i) {
        train.roll(t, 0.02);
        c.drive(cart(), t, 0.02);
        if (std::abs(train.angle_rad) > Coupling::kMost_rad) break;
        ASSERT_GT(train.angle_rad, c.low_rad() - 0.01) << run;
        ASSERT_LT(train.angle_rad, c.high_rad() + 0.01) << run;
      }
      if (std::abs(train.angle_rad) > 0.95 * Coupling::kMost_rad) break;
    }
  }
}

TEST(TrailerTest, DrivenAheadItBecomesKnown) {
  Coupling c;
  EXPECT_NEAR(c.high_rad() - c.low_rad(), 2.0 * Coupling::kBegins_rad, 1e-9);
  c = after_five_metres();
  EXPECT_LT(c.high_rad() - c.low_rad(), 0.15);
  for (int i = 0; i < 100; ++i) c.drive(cart(), {-1.0, 0.0}, 0.02);
  EXPECT_GT(c.high_rad() - c.low_rad(), 0.2) << "backwards it parts";
}

//        ▪ what the vehicle passes,
//   ▭ ▭ ╱  the trailer cuts
TEST(TrailerTest, WhatStandsInsideABendIsTheTrailers) {
  Patch p = open_ground();
  put_pole(p, -0.3, 0.60);
  const base::BodyTwist bend{0.8, 0.5};
  Train train;
  Coupling c = after_five_metres();
  Verdict v = protect_trailer(p, {}, cart(), c, bend, {});
  EXPECT_TRUE(v.found);
  for (int i = 0; i < 100 && v.part >= 1.0; ++i) {
    train.roll(bend, 0.02);
    c.drive(cart(), bend, 0.02);
    v = protect_trailer(p, train.vehicle, cart(), c, bend, {});
  }
  EXPECT_LT(v.part, 1.0);
  EXPECT_EQ(v.limit, Limit::Obstacle);
  EXPECT_EQ(v.sensor, 3);
  EXPECT_EQ(protect(p, train.vehicle, kTractor, bend, {}).part, 1.0) << "the vehicle passes";
  EXPECT_EQ(protect_trailer(p, {}, cart(), after_five_metres(), {0.8, 0.0}, {}).part, 1.0)
      << "straight on it passes";
  EXPECT_EQ(protect_trailer(p, {}, cart(), after_five_metres(), {0.8, -0.5}, {}).part, 1.0);
}

TEST(TrailerTest, BackwardsWhatItMaySwingToHolds) {
  Patch p = open_ground();
  put_pole(p, -3.0, 0.0);
  EXPECT_LT(protect_trailer(p, {}, cart(), after_five_metres(), {-1.0, 0.0}, {}).part, 1.0);
  EXPECT_EQ(protect_trailer(p, {}, cart(), after_five_metres(), {1.0, 0.0}, {}).part, 1.0);
}

TEST(TrailerTest, WhatMayBeTheTrailerItselfHoldsNobody) {
  Patch p = open_ground();
  put_pole(p, -1.5, 0.2);
  EXPECT_EQ(protect_trailer(p, {}, cart(), {}, {0.5, 0.1}, {}).part, 1.0);
}

//   Before it was driven the coupling may be at up to 60 degrees, looked at in eight of them: what
//   stands a hand's breadth behind all of its places is none of the trailer.
TEST(TrailerTest, WhatStandsJustOutsideOfEveryPlaceOfItIsNotTakenForIt) {
  Patch p = open_ground();
  // The tail's corners are 1.75 m from the coupling.
  const Vec2 pole = put_pole(p, -0.6 - 1.85, 0.0);
  EXPECT_GT(std::hypot(pole.x + 0.6, pole.y), cart().body.reach_m() + 0.05);
  const Verdict v = protect_trailer(p, {}, cart(), {}, {-0.5, 0.0}, {});
  EXPECT_TRUE(v.found);
  EXPECT_EQ(v.part, 0.0);
  EXPECT_EQ(protect_trailer(p, {}, cart(), {}, {0.5, 0.0}, {}).part, 1.0) << "away from it";
}

//   Whatever the angle, its own points hold it nowhere, between the eight as well.
TEST(TrailerTest, NoPartOfItIsInItsOwnWay) {
  const Coupling c;
  for (int i = 0; i <= 40; ++i) {
    const double angle = c.low_rad() + (c.high_rad() - c.low_rad()) * i / 40.0;
    for (const double back_m : {0.8, 1.2, 1.65}) {
      for (const double side_m : {-0.35, 0.0, 0.35}) {
        const Pose2 at = Pose2{-0.6, 0.0, angle} * Pose2{-back_m, side_m, 0.0};
        Patch p = open_ground();
        const Vec2 seen = put_pole(p, at.x_m, at.y_m);
        const Pose2 in = inverse(Pose2{-0.6, 0.0, angle}) * Pose2{seen.x, seen.y, 0.0};
        if (cart().body.distance_m({in.x_m, in.y_m}) > -0.01) continue;
        EXPECT_EQ(protect_trailer(p, {}, cart(), c, {0.5, 0.2}, {}).part, 1.0) << angle;
        EXPECT_EQ(protect_trailer(p, {}, cart(), c, {-0.5, 0.2}, {}).part, 1.0) << angle;
      }
    }
  }
}

TEST(TrailerTest, TheMarksChangeNothing) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int limited = 0;
  for (int i = 0; i < 200; ++i) {
    Patch p = open_ground();
    for (int k = 0; k < 12; ++k) put_pole(p, 4.0 * unit(random), 3.0 * unit(random));
    Marks marks;
    marks.mark(p);
    const Pose2 pose{unit(random), unit(random), 3.0 * unit(random)};
    const base::BodyTwist t{1.2 * unit(random), 0.6 * unit(random)};
    const Coupling c = i % 2 == 0 ? after_five_metres() : Coupling{};
    const Verdict a = protect_trailer(p, pose, cart(), c, t, {});
    const Verdict b = protect_trailer(p, pose, cart(), c, t, {}, &marks);
    EXPECT_EQ(a.part, b.part) << i;
    EXPECT_EQ(a.touch_s, b.touch_s) << i;
    limited += a.part < 1.0;
  }
  EXPECT_GT(limited, 40);
}

//   Poles at seeded places, ahead and in bends: the verdicts obeyed after the delay with the
//   braking that is sure, the trailer touches none.
TEST(TrailerTest, NothingIsTouchedByIt) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const ProtectParams params;
  int near = 0;
  for (int i = 0; i < 60; ++i) {
    const base::BodyTwist twist{0.8 + 0.4 * unit(random), 0.5 * unit(random)};
    Patch p = open_ground();
    const Vec2 pole = put_pole(p, 2.0 + 2.5 * unit(random), 2.5 * unit(random));
    Marks marks;
    marks.mark(p);
    Train train;
    Coupling coupling = after_five_metres();
    if (train.to_trailer_m(pole) < 0.3 || train.to_vehicle_m(pole) < 0.6) continue;
    const double most = std::max(0.5 * std::abs(twist.linear_mps) / params.decel_mps2,
                                 0.5 * std::abs(twist.angular_radps) / params.turn_decel_radps2);
    std::array<double, 11> told{};  // every tick; obeyed after 0.2 s
    told.fill(1.0);
    double part = 1.0;
    double came_m = 1e9;
    for (std::size_t tick = 0; tick < 400; ++tick) {
      const Verdict v = protect(p, train.vehicle, kTractor, twist, params, nullptr, &marks);
      const Verdict t = protect_trailer(p, train.vehicle, cart(), coupling, twist, params, &marks);
      told[tick % told.size()] = std::min(v.part, t.part);
      const double heard = told[(tick + 1) % told.size()];
      part += std::clamp(heard - part, -0.02 / (2.0 * most), 0.02 / (2.0 * most));
      const base::BodyTwist driven{part * twist.linear_mps, part * twist.angular_radps};
      train.roll(driven, 0.02);
      coupling.drive(cart(), driven, 0.02);
      came_m = std::min(came_m, train.to_trailer_m(pole));
    }
    EXPECT_GT(came_m, 0.05) << i << ": " << twist.linear_mps << " " << twist.angular_radps;
    near += came_m < 0.3;
  }
  EXPECT_GE(near, 3);
}

}  // namespace
}  // namespace roverd::nav::sense
