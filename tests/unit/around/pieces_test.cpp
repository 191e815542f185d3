// Curves between two poses.
#include "nav/around/pieces.hpp"

#include <random>

#include <gtest/gtest.h>

namespace roverd::nav::around {
namespace {

Pose2 end_of(Pose2 at, const Link& link) {
  for (std::size_t i = 0; i < link.size; ++i) at = link.pieces[i].after(at, 1.0);
  return at;
}

void expect_same(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x_m, b.x_m, 1e-6);
  EXPECT_NEAR(a.y_m, b.y_m, 1e-6);
  EXPECT_NEAR(base::angle_diff_rad(a.yaw_rad, b.yaw_rad), 0.0, 1e-6);
}

TEST(PiecesTest, DubinsKnowsTheEasyOnes) {
  EXPECT_NEAR(dubins({0, 0, 0}, {5, 0, 0}, 1.0).length_m, 5.0, 1e-9) << "straight on";
  EXPECT_NEAR(dubins({0, 0, 0}, {0, 2, base::kPi}, 1.0).length_m, base::kPi, 1e-9) << "half a turn";
  EXPECT_NEAR(dubins({0, 0, 0}, {2, 0, base::kPi / 2}, 2.0).length_m,
              dubins({0, 0, 0}, {2, 0, -base::kPi / 2}, 2.0).length_m, 1e-9)
      << "a mirror changes nothing";
}

TEST(PiecesTest, EveryLinkEndsWhereItShall) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  std::uniform_real_distribution<double> angle(-base::kPi, base::kPi);
  for (int i = 0; i < 20'000; ++i) {
    const Pose2 a{place(random), place(random), angle(random)};
    const Pose2 b{place(random), place(random), angle(random)};
    const Link curve = dubins(a, b, 1.5);
    expect_same(end_of(a, curve), b);
    EXPECT_GE(curve.length_m, std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) - 1e-9);
    expect_same(end_of(a, straight_between_turns(a, b)), b);
    if (HasFailure()) FAIL() << "pair " << i;
  }
}

TEST(PiecesTest, BackwardsAnArcIsDrivenBack) {
  const Piece ahead{0.5, 1.2, 0.0};
  const Piece back{0.5, -1.2, 0.0};
  expect_same(back.after(ahead.after({1, 2, 0.3}, 1.0), 1.0), {1, 2, 0.3});
}

}  // namespace
}  // namespace roverd::nav::around
