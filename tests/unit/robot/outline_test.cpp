// What the vehicle carries or pulls, from above.

#include "robot/guard/outline.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/angle.hpp"
#include "robot/guard/guard.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Known;
using nav::sense::Vec2;

/// A mower behind the vehicle: 0.8 m long, 1.6 m wide, its middle 1 m behind the origin.
nav::ToolParams mower() {
  nav::ToolParams tool;
  tool.forward_m = -1.0;
  return tool;
}
constexpr OutlineParams kMower{0.8, 1.6};

/// Its axle 1.2 m behind the coupling, that 0.6 m behind the origin.
nav::ToolParams trailer() {
  nav::ToolParams tool;
  tool.hitch_m = 0.6;
  tool.trailer_m = 1.2;
  return tool;
}
constexpr OutlineParams kTrailer{1.0, 0.8};

TEST(Outline, OfAMountedToolBelongsToTheVehicle) {
  const auto both = footprint_of({}, mower(), kMower);
  EXPECT_NEAR(both.distance_m({-1.4, 0.8}), 0.0, 1e-9) << "its corner";
  EXPECT_LT(both.distance_m({-1.3, 0.7}), 0.0);
  EXPECT_NEAR(both.distance_m({0.5115, 0.0}), 0.0, 1e-9) << "the vehicle's nose";
  EXPECT_NEAR(both.reach_m(), std::hypot(1.4, 0.8), 1e-9);
  EXPECT_FALSE(pulled_of(mower(), kMower));
  // Without an outline it is the vehicle's.
  EXPECT_NEAR(footprint_of({}, mower(), {}).reach_m(), footprint_of({}).reach_m(), 1e-12);
}

TEST(Outline, OfATrailerLiesWithinItsSectorHoweverTheCouplingStands) {
  const auto sector = pulled_of(trailer(), kTrailer);
  ASSERT_TRUE(sector);
  for (int deg = -60; deg <= 60; deg += 5) {
    const double c = std::cos(base::rad_from_deg(deg));
    const double s = std::sin(base::rad_from_deg(deg));
    for (double behind = 0.7; behind < 1.71; behind += 0.1) {
      for (const double left : {-0.4, 0.0, 0.4}) {
        const Vec2 p{-0.6 - behind * c - left * s, -behind * s + left * c};
        EXPECT_LE(sector->distance_m(p), 1e-9) << deg << " " << behind << " " << left;
      }
    }
  }
  EXPECT_GT(sector->distance_m({0.6, 0.0}), 0.5) << "nothing ahead is hidden by it";
  EXPECT_GT(sector->distance_m({-2.6, 0.0}), 0.2);
  EXPECT_NEAR(footprint_of({}, trailer(), kTrailer).reach_m(), footprint_of({}).reach_m(), 1e-12)
      << "it is swept on its own";
}

TEST(Outline, ATurnOnTheSpotSweepsTheToolAsWell) {
  // Given a post beside the mower, out of reach of the vehicle itself,
  auto around = std::make_shared<Surroundings>();
  const base::Time now = base::Time{} + std::chrono::seconds(5);
  around->patch.stamp = now;
  around->patch.side = 200;
  around->patch.x0 = around->patch.y0 = -100;
  around->patch.cells.assign(200 * 200, {Known::Free, 0, 0});
  const std::size_t x = 100 - 24;  // 1.2 m behind
  const std::size_t y = 100 + 20;  // 1.0 m to the left
  around->patch.cells[y * 200 + x].known = Known::Occupied;
  around->sensors = std::make_shared<const std::vector<base::SensorState>>(1);
  around->seen = now;
  for (const bool mows : {false, true}) {
    Guard guard;
    if (mows) {
      guard.set({}, {}, true, {}, mower(), kMower);
    } else {
      guard.set({}, {}, true);
    }
    (void)guard.move({}, now);
    (void)guard.take(around);
    // when it turns on the spot, the tool's tail towards the post,
    const double turn = guard.judge({0.0, -0.8}, true, now).angular_radps;
    // then it turns freely without the tool, and hardly with it.
    if (mows) {
      EXPECT_GT(turn, -0.5);
      EXPECT_EQ(guard.obstacle().what, "obstacle");
    } else {
      EXPECT_EQ(turn, -0.8);
    }
  }
}

TEST(Outline, OneSideOfItAloneSaysNothing) {
  EXPECT_TRUE(check(OutlineParams{}));
  EXPECT_TRUE(check(kMower));
  const auto half = check(OutlineParams{1.0, 0.0});
  ASSERT_FALSE(half);
  EXPECT_EQ(half.error().fields.at(0).pointer, "width_m");
}

}  // namespace
}  // namespace roverd::robot
