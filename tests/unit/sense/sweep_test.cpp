// The moment of contact along a commanded curve.
#include "nav/sense/sweep.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "nav/sense/odometry.hpp"

namespace roverd::nav::sense {
namespace {

const Footprint kTrack = Footprint::box(1.0, 0.8, 0.5);
constexpr double kHorizon_s = 6.0;

/// By trying: the body's pose every millisecond, the point brought into it.
std::optional<double> by_trying(const Footprint& body, Vec2 p, double r, base::BodyTwist twist) {
  for (int i = 0; i <= 6000; ++i) {
    const double t = 0.001 * i;
    const Pose2 moved =
        inverse(along(twist.linear_mps, twist.angular_radps, t)) * Pose2{p.x, p.y, 0.0};
    if (body.distance_m({moved.x_m, moved.y_m}) <= r) return t;
  }
  return std::nullopt;
}

TEST(SweepTest, StraightOnItIsTheDistanceOverTheSpeed) {
  EXPECT_NEAR(touch_s(kTrack, {2.5, 0.1}, 0.0, {0.5, 0.0}, 10.0).value(), 4.0, 1e-9);
  EXPECT_NEAR(touch_s(kTrack, {-2.5, 0.1}, 0.5, {-0.5, 0.0}, 10.0).value(), 3.0, 1e-9);
  EXPECT_FALSE(touch_s(kTrack, {2.5, 0.41}, 0.0, {0.5, 0.0}, 10.0).has_value()) << "beside";
  EXPECT_FALSE(touch_s(kTrack, {2.5, 0.1}, 0.0, {0.5, 0.0}, 3.9).has_value()) << "beyond";
  EXPECT_FALSE(touch_s(kTrack, {-2.5, 0.1}, 0.0, {0.5, 0.0}, 10.0).has_value()) << "behind";
}

//   On the spot only the corners reach out: from 0.5 (front) to 0.64 m.
TEST(SweepTest, APivotMeetsWhatItsCornersMeet) {
  const Vec2 left{0.0, 0.6};
  // Seen from the body the point turns right, and enters through the left side y = 0.4, or through
  // the front x = 0.5, whichever it meets first: the side, at x = 0.6 sin a, y = 0.6 cos a = 0.4.
  EXPECT_NEAR(touch_s(kTrack, left, 0.0, {0.0, 1.0}, 3.0).value(), std::acos(0.4 / 0.6), 1e-9);
  EXPECT_FALSE(touch_s(kTrack, {0.0, 0.65}, 0.0, {0.0, 1.0}, 6.0).has_value());
}

TEST(SweepTest, WhatIsThereAlreadyIsTouchedNow) {
  EXPECT_EQ(touch_s(kTrack, {0.55, 0.0}, 0.1, {-0.5, 0.0}, 10.0).value(), 0.0);
}

TEST(SweepTest, NothingIsTouchedWhereNothingMoves) {
  EXPECT_FALSE(touch_s(kTrack, {0.7, 0.0}, 0.1, {0.0, 0.0}, 10.0).has_value());
}

TEST(SweepTest, FourThousandSeededCasesAgreeWithTryingEveryMillisecond) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto wedge = Footprint::of(
      std::vector<Vec2>{{1.4, 0.0}, {0.9, 0.5}, {-0.3, 0.6}, {-0.3, -0.6}, {0.9, -0.5}});
  ASSERT_TRUE(wedge.has_value());
  int touched = 0;
  for (int i = 0; i < 4000; ++i) {
    const Footprint& body = i % 2 == 0 ? kTrack : *wedge;
    base::BodyTwist twist{1.3 * unit(random), 1.0 * unit(random)};
    if (i % 5 == 0) twist.angular_radps = 0.0;
    if (i % 7 == 0) twist.linear_mps = 0.0;
    const Vec2 p{4.0 * unit(random), 4.0 * unit(random)};
    const double r = 0.25 * std::abs(unit(random));
    const auto exact = touch_s(body, p, r, twist, kHorizon_s);
    const auto tried = by_trying(body, p, r, twist);
    if (tried) {
      ASSERT_TRUE(exact.has_value()) << i;
      // Not later than the first millisecond that touches, and at the very touch.
      EXPECT_LE(*exact, *tried + 1e-9) << i;
      if (*exact > 0.0) {
        EXPECT_NEAR(body.distance_m(seen_after(p, twist, *exact)), r, 1e-6) << i;
      }
      ++touched;
    } else if (exact) {
      // Less than a millisecond of touch, at a corner: the distance there says so.
      EXPECT_NEAR(body.distance_m(seen_after(p, twist, *exact)), r, 1e-6) << i;
    }
  }
  EXPECT_GT(touched, 300);
}

}  // namespace
}  // namespace roverd::nav::sense
