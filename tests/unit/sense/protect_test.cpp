// How fast it may go: against sweeping the footprint in small steps.
#include "nav/sense/protect.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "nav/sense/odometry.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kBox = Footprint::box(1.0, 0.8, 0.5);

Patch all(Known known) {
  Patch p;
  p.cell_m = 0.05;
  p.x0 = -120;
  p.y0 = -120;
  p.side = 240;
  p.cells.assign(240 * 240, {known, 3, 2});
  return p;
}

void put(Patch& p, double x, double y, Known known = Known::Occupied) {
  const auto ix = static_cast<std::int32_t>(std::floor(x / p.cell_m)) - p.x0;
  const auto iy = static_cast<std::int32_t>(std::floor(y / p.cell_m)) - p.y0;
  p.cells[static_cast<std::size_t>(iy * p.side + ix)].known = known;
}

/// Drives on with the verdict's part, obeyed after the delay with the braking that is sure, and
/// says how near the body came to the middle of the cell; steps of a millisecond.
double comes_near_m(const Patch& patch, Vec2 thing, base::BodyTwist twist, const ProtectParams& p,
                    const Footprint& body) {
  Pose2 pose;
  double part = 1.0;
  double nearest = 1e9;
  std::array<double, 1000> told;
  told.fill(1.0);
  const auto delay = static_cast<std::size_t>(p.delay_s / 0.001);
  std::size_t at = 0;
  const double most = std::max(0.5 * std::abs(twist.linear_mps) / p.decel_mps2,
                               0.5 * std::abs(twist.angular_radps) / p.turn_decel_radps2);
  const double change = 0.001 / (2.0 * most);  // of the part, in a step
  double wanted = 1.0;
  for (int i = 0; i < 12'000; ++i) {
    if (i % 20 == 0) wanted = protect(patch, pose, body, twist, p).part;
    told[at] = wanted;
    at = (at + 1) % (delay + 1);
    const double heard = told[at];
    part += std::clamp(heard - part, -change, change);
    pose = pose * along(part * twist.linear_mps, part * twist.angular_radps, 0.001);
    const Pose2 seen = inverse(pose) * Pose2{thing.x, thing.y, 0.0};
    nearest = std::min(nearest, body.distance_m({seen.x_m, seen.y_m}));
  }
  return nearest;
}

TEST(ProtectTest, AnOpenFieldLimitsNothing) {
  const Verdict v = protect(all(Known::Free), {}, kBox, {1.0, 0.3}, {});
  EXPECT_EQ(v.part, 1.0);
  EXPECT_EQ(v.limit, Limit::None);
  EXPECT_FALSE(v.found);
}

TEST(ProtectTest, ItNamesWhatLimits) {
  Patch p = all(Known::Free);
  put(p, 1.325, 0.025);
  const Verdict v = protect(p, {}, kBox, {1.0, 0.0}, {});
  EXPECT_EQ(v.limit, Limit::Obstacle);
  EXPECT_LT(v.part, 1.0);
  EXPECT_NEAR(v.at.x, 1.325, 1e-9);
  // From the front (0.5) grown by 0.08 and half a cell's diagonal.
  EXPECT_NEAR(v.distance_m, 1.325 - 0.5 - 0.08 - 0.0354, 0.001);
  EXPECT_EQ(v.sensor, 3);
  EXPECT_NEAR(v.age_s, 0.2, 1e-9);
  put(p, 1.025, 0.0, Known::Drop);
  EXPECT_EQ(protect(p, {}, kBox, {1.0, 0.0}, {}).limit, Limit::Drop);
}

TEST(ProtectTest, ThePartOfTheTwistStopsWithinTheTimeThatIsLeft) {
  const ProtectParams p;
  for (const double t : {0.0, 0.05, 0.3, 0.8, 1.0, 3.0}) {
    const double part = part_for(t, {1.2, 0.1}, p);
    const double b = 0.5 * 1.2 / p.decel_mps2;
    EXPECT_LE(part * p.delay_s + part * part * b, t + 1e-12);
    if (part < 1.0) {
      EXPECT_NEAR(part * p.delay_s + part * part * b, t, 1e-12);
    }
  }
}

//   What is beside the way, or behind, or has been passed, holds nobody.
TEST(ProtectTest, WhatIsBesideTheWayIsPassed) {
  Patch p = all(Known::Free);
  put(p, 1.3, 0.55);
  put(p, 1.3, -0.60);
  put(p, -0.8, 0.0);
  EXPECT_EQ(protect(p, {}, kBox, {1.0, 0.0}, {}).part, 1.0);
  EXPECT_LT(protect(p, {}, kBox, {1.0, 0.5}, {}).part, 1.0) << "but not when it turns there";
  EXPECT_LT(protect(p, {}, kBox, {-0.5, 0.0}, {}).part, 1.0);
}

TEST(ProtectTest, NearerThanTheMarginItMayDriveAwayButNotNearer) {
  Patch p = all(Known::Free);
  put(p, 0.575, 0.0);
  EXPECT_EQ(protect(p, {}, kBox, {-0.5, 0.0}, {}).part, 1.0);
  EXPECT_LT(protect(p, {}, kBox, {0.5, 0.0}, {}).part, 0.05);
  Patch beside = all(Known::Free);
  for (double x = -2.0; x < 2.0; x += 0.05) put(beside, x, 0.475);  // along a wall, 5 cm off
  EXPECT_EQ(protect(beside, {}, kBox, {0.5, 0.0}, {}).part, 1.0);
  EXPECT_LT(protect(beside, {}, kBox, {0.0, 0.5}, {}).part, 0.5) << "its corners would touch";
}

TEST(ProtectTest, WhatNobodyHasSeenIsCreptIntoAheadOnly) {
  const Patch p = all(Known::Unknown);
  ProtectParams params;
  EXPECT_NEAR(protect(p, {}, kBox, {1.0, 0.0}, params).part, 0.25, 1e-9);
  EXPECT_EQ(protect(p, {}, kBox, {1.0, 0.0}, params).limit, Limit::Unseen);
  EXPECT_LT(protect(p, {}, kBox, {-1.0, 0.0}, params).part, 0.02);
  EXPECT_LT(protect(p, {}, kBox, {0.0, 0.6}, params).part, 0.02);
  params.creep_mps = 0.0;
  EXPECT_LT(protect(p, {}, kBox, {1.0, 0.0}, params).part, 0.02);
}

//   Seen as far as 2.5 m ahead: full speed while braking to a creep ends before it.
TEST(ProtectTest, TheEdgeOfTheSeenSlowsInTime) {
  Patch p = all(Known::Unknown);
  for (double x = -1.0; x < 2.5; x += 0.05) {
    for (double y = -1.5; y < 1.5; y += 0.05) put(p, x + 0.01, y + 0.01, Known::Free);
  }
  EXPECT_EQ(protect(p, {}, kBox, {1.0, 0.0}, {}).part, 1.0) << "2 m to go, 1.03 to stop";
  const double near = protect(p, {1.2, 0.0, 0.0}, kBox, {1.0, 0.0}, {}).part;
  EXPECT_LT(near, 0.95);
  EXPECT_GT(near, 0.5);
}

TEST(ProtectTest, AllIsToldInTheFrameOfTheBodyWhereverItStands) {
  Patch p = all(Known::Free);
  put(p, 2.025, 3.325);
  const Verdict v = protect(p, {2.0, 2.0, base::kPi / 2}, kBox, {1.0, 0.0}, {});
  EXPECT_NEAR(v.at.x, 1.325, 0.001);
  EXPECT_NEAR(v.at.y, -0.025, 0.001);
  EXPECT_NEAR(v.bearing_rad, std::atan2(-0.025, 1.325), 0.001);
}

//   Three hundred things at seeded places, ahead, backwards, round and on the spot: with the delay
//   and the braking that are said to be sure, none is touched, and what is straight ahead is come
//   to as near as the gap.
TEST(ProtectTest, NothingIsTouchedWithTheDelayAndTheBrakingThatWereMeasured) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Footprint car = Footprint::box(2.0, 1.1, 0.4);
  const ProtectParams params;
  int near = 0;
  for (int i = 0; i < 60; ++i) {
    const Footprint& body = i % 3 == 0 ? car : kBox;
    base::BodyTwist twist{1.3 * unit(random), 0.8 * unit(random)};
    if (i % 4 == 0) twist.angular_radps = 0.0;
    if (i % 6 == 1) twist.linear_mps = 0.0;
    Vec2 thing{4.0 * unit(random), 3.0 * unit(random)};
    if (body.distance_m(thing) < 0.8) continue;
    Patch p = all(Known::Free);
    put(p, thing.x, thing.y);
    thing = {0.05 * (std::floor(thing.x / 0.05) + 0.5), 0.05 * (std::floor(thing.y / 0.05) + 0.5)};
    const double came = comes_near_m(p, thing, twist, params, body);
    EXPECT_GT(came, 0.07) << i << ": " << twist.linear_mps << " " << twist.angular_radps;
    near += came < 0.4;
  }
  EXPECT_GT(near, 5);
  for (const double v : {0.5, 1.0, 1.3, -1.0}) {
    Patch p = all(Known::Free);
    const double x = v > 0.0 ? 3.025 : -3.025;
    put(p, x, 0.0);
    const double came = comes_near_m(p, {x, 0.025}, {v, 0.0}, params, kBox);
    EXPECT_GT(came, 0.05) << v;
    EXPECT_LT(came, 0.4) << v;
  }
}

}  // namespace
}  // namespace roverd::nav::sense
