// A body that skids turns by less than it is told, on a slope by far less, and as it brakes it
// stops turning before it stands. What stands beside the bend is not touched all the same.

#include "nav/sense/skid.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "robot/guard/guard.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Known;
using nav::sense::Pose2;

constexpr double kTick_s = 0.02;
constexpr double kDecel_mps2 = 0.6;
constexpr double kHalfWide_m = 0.39;
constexpr double kHalfBox_m = 0.2;
constexpr std::int32_t kSide = 240;

base::Time moment(double s) {
  return base::Time{} + base::from_seconds(100.0 + s);
}

/// All is seen and free, but one box with upright sides.
std::shared_ptr<Surroundings> box_at(double x_m, double y_m, double half_m) {
  auto out = std::make_shared<Surroundings>();
  out->patch.side = kSide;
  out->patch.x0 = out->patch.y0 = -kSide / 2;
  out->patch.cells.assign(kSide * kSide, {Known::Free, 0, 0});
  for (std::int32_t y = 0; y < kSide; ++y) {
    for (std::int32_t x = 0; x < kSide; ++x) {
      const double off_x = (x - kSide / 2 + 0.5) * 0.05 - x_m;
      const double off_y = (y - kSide / 2 + 0.5) * 0.05 - y_m;
      const bool in = std::max(std::abs(off_x), std::abs(off_y)) < half_m;
      if (in) out->patch.cells[std::size_t(y * kSide + x)].known = Known::Occupied;
    }
  }
  base::SensorState state;
  state.name = "front";
  out->sensors = std::make_shared<const std::vector<base::SensorState>>(1, state);
  return out;
}

std::vector<nav::sense::Vec2> taken(const nav::sense::Patch& patch) {
  std::vector<nav::sense::Vec2> out;
  for (std::size_t i = 0; i < patch.cells.size(); ++i) {
    if (patch.cells[i].known != Known::Occupied) continue;
    const auto side = static_cast<std::size_t>(patch.side);
    out.push_back({(patch.x0 + int(i % side) + 0.5) * patch.cell_m,
                   (patch.y0 + int(i / side) + 0.5) * patch.cell_m});
  }
  return out;
}

struct Drove {
  double nearest_m = 1e9;  ///< while it moved, to the middle of a taken cell
  double way_m = 0.0;
};

/// What becomes of the turn that is told.
struct Skids {
  double sticks_radps = 0.0;  ///< turns slower than this, told, are none
  double part = 1.0;          ///< of the rest
  double slides = 0.0;        ///< aside, out of the bend, as part of its way
  double turned(double told) const {
    return part * std::copysign(std::max(0.0, std::abs(told) - sticks_radps), told);
  }
};

base::BodyTwist step(base::BodyTwist now, const base::BodyTwist& told, const Skids& skids) {
  const double most = kDecel_mps2 * kTick_s;
  now.linear_mps = std::clamp(told.linear_mps, now.linear_mps - most, now.linear_mps + most);
  now.angular_radps += (skids.turned(told.angular_radps) - now.angular_radps) * kTick_s / 0.15;
  return now;
}

/// Out of a bend that it is told.
double left_mps(const base::BodyTwist& now, const base::BodyTwist& wanted, const Skids& skids) {
  const bool to_left = wanted.linear_mps * wanted.angular_radps < 0.0;
  return (to_left ? 1.0 : -1.0) * skids.slides * std::abs(now.linear_mps);
}

/// Where it would be after so long, if nothing stood there.
Pose2 free_way(const base::BodyTwist& wanted, const Skids& skids, double lasts_s) {
  base::BodyTwist now;
  Pose2 pose;
  for (double t = 0.0; t < lasts_s; t += kTick_s) {
    now = step(now, wanted, skids);
    pose = pose * nav::sense::along(now.linear_mps, left_mps(now, wanted, skids), now.angular_radps,
                                    kTick_s);
  }
  return pose;
}

/// By hand for 6 s from a stand.
Drove drive(const base::BodyTwist& wanted, const Skids& skids,
            const std::shared_ptr<Surroundings>& seen) {
  Guard guard;
  guard.set({}, {}, false);
  base::BodyTwist now;
  Drove out;
  const auto stands = taken(seen->patch);
  for (double t = 0.0; t < 6.0; t += kTick_s) {
    const Pose2 pose = guard.move(now, moment(t), {}, left_mps(now, wanted, skids)).pose;
    seen->patch.stamp = moment(t);
    seen->seen = moment(t);
    (void)guard.take(seen);
    const base::BodyTwist let = guard.judge(wanted, false, moment(t));
    now = step(now, let, skids);
    out.way_m += std::abs(now.linear_mps) * kTick_s;
    if (std::abs(now.linear_mps) < 0.02) continue;
    for (const nav::sense::Vec2 cell : stands) {
      const Pose2 there = inverse(pose) * Pose2{cell.x, cell.y, 0.0};
      out.nearest_m = std::min(out.nearest_m, guard.body().distance_m({there.x_m, there.y_m}));
    }
  }
  return out;
}

/// A bend, by chance, and a box outside of it where the body would go by, so far beside it.
struct Bend {
  base::BodyTwist wanted;
  std::shared_ptr<Surroundings> seen;
};
Bend bend(std::mt19937& random, const Skids& skids, double room_m) {
  std::uniform_real_distribution<double> of(0.0, 1.0);
  const double side = of(random) < 0.5 ? 1.0 : -1.0;
  const double way = of(random) < 0.5 ? 1.0 : -1.0;
  const base::BodyTwist wanted{way * (0.6 + 0.4 * of(random)), side * (0.3 + 0.3 * of(random))};
  const double off_m = kHalfWide_m + kHalfBox_m + room_m;
  const Pose2 box =
      free_way(wanted, skids, 1.5 + 3.0 * of(random)) * Pose2{0.0, -side * way * off_m, 0.0};
  return {wanted, box_at(box.x_m, box.y_m, kHalfBox_m)};
}

TEST(Skid, WhatStandsBesideABendIsNotTouchedHoweverItSkids) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> of(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Skids skids{0.2 * of(random), 0.6 + 0.5 * of(random), 0.15 * of(random)};
    const Bend one = bend(random, skids, -0.15 + 0.25 * of(random));
    EXPECT_GT(drive(one.wanted, skids, one.seen).nearest_m, 0.03)
        << i << ": " << one.wanted.linear_mps << " m/s, " << one.wanted.angular_radps
        << " rad/s, of which " << skids.part << " beyond " << skids.sticks_radps << ", slides "
        << skids.slides;
  }
}

//   It slows beside it, for its turn might die there; but it goes by.
TEST(Skid, WhatItGoesByDoesNotHoldIt) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> of(0.0, 1.0);
  int held = 0;
  double sum = 0.0;
  constexpr int kBends = 100;
  for (int i = 0; i < kBends; ++i) {
    const Skids skids{0.0, 0.9 + 0.1 * of(random), 0.0};
    const Bend one = bend(random, skids, 0.35);
    const double part = drive(one.wanted, skids, one.seen).way_m /
                        drive(one.wanted, skids, box_at(-20.0, 0.0, kHalfBox_m)).way_m;
    held += part < 0.5 ? 1 : 0;
    sum += part / kBends;
  }
  EXPECT_LT(held, kBends / 20);
  EXPECT_GT(sum, 0.8);
}

nav::sense::Lately going(double v_mps, double left_mps, double yaw_rate_radps = 0.0) {
  nav::sense::Odometry now;
  now.v_mps = v_mps;
  now.left_mps = left_mps;
  now.yaw_rate_radps = yaw_rate_radps;
  nav::sense::Lately out;
  out.move(now, 1.0);
  return out;
}

//   Outside of the bend, but right ahead. A car that turns as it is told goes by; one that does not
//   yet, or whose turn may die, drives no faster than it can stand: but it is never held for that.
TEST(Skid, OnlyOneThatSteersKeepsItsCurveWhileItBrakes) {
  using nav::sense::Limit;
  const base::BodyTwist told{1.0, 0.7};
  const auto body = nav::sense::Footprint::box(1.02, 0.78, 0.51);
  const auto part = [&](double box_m, bool steered, const base::BodyTwist& moves) {
    const auto seen = box_at(box_m, -0.35, kHalfBox_m);
    return protect_skidding(seen->patch, {}, body, told,
                            going(moves.linear_mps, 0.0, moves.angular_radps), steered, {});
  };
  EXPECT_EQ(part(1.6, true, told).limit, Limit::None);
  EXPECT_EQ(part(1.6, false, told).limit, Limit::Obstacle);
  EXPECT_LT(part(1.6, false, told).part, 0.9);
  EXPECT_LT(part(1.6, true, {1.0, 0.0}).part, 0.9);
  EXPECT_DOUBLE_EQ(part(0.75, false, told).part, 0.2);
  // What stands tells nothing of how it will go, nor what still goes the other way.
  EXPECT_EQ(part(1.6, true, {0.05, 0.0}).limit, Limit::None);
  EXPECT_EQ(part(1.6, true, {-0.5, 0.0}).limit, Limit::None);
}

//   Straight on the box stays 0.16 m beside it.
TEST(Skid, WhatSlidesAsideLooksWhereItSlides) {
  const auto body = nav::sense::Footprint::box(1.02, 0.78, 0.51);
  for (const double way : {1.0, -1.0}) {
    const auto seen = box_at(way * 1.5, 0.75, kHalfBox_m);
    const auto there = [&](double left_mps) {
      return protect_skidding(seen->patch, {}, body, {way, 0.0}, going(way, left_mps), true, {});
    };
    EXPECT_EQ(there(0.0).limit, nav::sense::Limit::None);
    EXPECT_EQ(there(-0.2).limit, nav::sense::Limit::None);
    const auto told = there(0.2);
    EXPECT_LT(told.part, 0.9) << way;
    // The nearest corner of the box comes to that of the body.
    EXPECT_NEAR(told.at.x, way * 1.325, 1e-6);
    EXPECT_NEAR(told.at.y, 0.575, 1e-6);
    EXPECT_NEAR(told.distance_m, 0.72, 0.02);
  }
}

TEST(Skid, WhatNobodyHasSeenIsAMatterOfWhereItIsTold) {
  const auto body = nav::sense::Footprint::box(1.02, 0.78, 0.51);
  auto seen = box_at(-20.0, 0.0, kHalfBox_m);
  std::ranges::fill(seen->patch.cells, nav::sense::Patch::Cell{});
  const auto part = protect_skidding(seen->patch, {}, body, {1.0, 0.7}, going(1.0, 0.0), false, {});
  EXPECT_EQ(part.limit, nav::sense::Limit::None);
  EXPECT_DOUBLE_EQ(part.part, 1.0);
}

//   It leaves the margin beside it, not that before what it drives at.
TEST(Skid, WhereItMightSlideItLeavesTheMarginBeside) {
  const auto body = nav::sense::Footprint::box(1.02, 0.78, 0.51);
  const auto part = [&](double gap_m) {
    nav::sense::ProtectParams params;
    params.gap_m = gap_m;
    const auto seen = box_at(1.6, -0.35, kHalfBox_m);
    return protect_skidding(seen->patch, {}, body, {1.0, 0.7}, going(1.0, 0.0, 0.7), false, params)
        .part;
  };
  EXPECT_LT(part(0.2), 1.0);
  EXPECT_DOUBLE_EQ(part(0.2), part(0.6));
}

TEST(Skid, ATurnOnTheSpotHasNoWayToLeave) {
  const auto body = nav::sense::Footprint::box(1.02, 0.78, 0.51);
  const auto seen = box_at(0.9, -0.35, kHalfBox_m);
  const auto there =
      protect_skidding(seen->patch, {}, body, {0.3, 3.0}, going(0.3, 0.0, 3.0), false, {});
  EXPECT_EQ(there.limit, nav::sense::Limit::None);
}

TEST(Skid, HowItMovesIsSmoothed) {
  nav::sense::Odometry now;
  now.v_mps = 1.0;
  now.left_mps = 0.2;
  now.yaw_rate_radps = 0.4;
  nav::sense::Lately lately;
  lately.move(now, 0.075);
  EXPECT_NEAR(lately.v_mps(), 0.5, 1e-9);
  EXPECT_NEAR(lately.curve_pm(), 0.4, 1e-9);
  EXPECT_NEAR(lately.aside_rad(), std::atan(0.2), 1e-9);
  now.left_mps = 5.0;
  lately.move(now, 1.0);
  EXPECT_NEAR(lately.aside_rad(), 0.35, 1e-9);
}

}  // namespace
}  // namespace roverd::robot
