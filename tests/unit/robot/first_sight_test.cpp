// Looks at one tag by a robot that knows nothing of where it stands.

#include "robot/first_sight.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Pose2;

/// The tag hangs at (10, 5) of the map and looks to the west; the body looks at it from 2 m before.
nav::LandmarkSight sight(double at_s, double yaw_rad = 0.0) {
  nav::LandmarkSight s;
  s.stamp = base::Time{} + base::from_seconds(100.0 + at_s);
  s.at = {10.0, 5.0};
  s.place_sigma_m = 0.05;
  s.seen = {2.0, 0.0};
  s.seen_covariance = 1e-4 * Eigen::Matrix2d::Identity();
  s.yaw_rad = yaw_rad;
  s.yaw_sigma_rad = 0.03;
  s.face_sigma_rad = 0.04;
  return s;
}

std::optional<nav::LandmarkPose> looks(FirstSight& first, int n, double every_s) {
  std::optional<nav::LandmarkPose> out;
  for (int i = 0; i < n; ++i) out = first.look(3, sight(i * every_s), {});
  return out;
}

TEST(FirstSight, FiveLooksOverHalfASecondDecide) {
  FirstSight first;
  EXPECT_FALSE(looks(first, 4, 0.2));
  const auto found = first.look(3, sight(0.8), {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->at.east_m, 8.0, 1e-9);
  EXPECT_NEAR(found->at.north_m, 5.0, 1e-9);
  EXPECT_NEAR(found->yaw_rad, 0.0, 1e-9);
  // By hand: 0.05 of the place, 0.01 of the range, 0.03 and 0.04 rad at two metres.
  EXPECT_NEAR(found->sigma_m, std::sqrt(0.0025 + 0.0001 + 0.0036 + 0.0064), 1e-6);
  EXPECT_NEAR(found->sigma_rad, 0.05, 1e-9);
}

TEST(FirstSight, FiveLooksWithinATenthOfASecondAreOne) {
  FirstSight first;
  EXPECT_FALSE(looks(first, 9, 0.05));
}

TEST(FirstSight, AFaceThatTurnsBetweenTwoLooksBeginsAnew) {
  FirstSight first;
  for (int i = 0; i < 40; ++i) {
    EXPECT_FALSE(first.look(3, sight(0.1 * i, i % 4 == 3 ? 0.7 : 0.0), {})) << i;
  }
}

TEST(FirstSight, AnotherTagOrALongGapBeginsAnew) {
  FirstSight first;
  EXPECT_FALSE(looks(first, 4, 0.2));
  EXPECT_FALSE(first.look(4, sight(0.8), {}));
  FirstSight gap;
  EXPECT_FALSE(looks(gap, 4, 0.2));
  EXPECT_FALSE(gap.look(3, sight(1.7), {}));
}

TEST(FirstSight, TheWayBetweenTheLooksIsTakenOff) {
  FirstSight first;
  std::optional<nav::LandmarkPose> found;
  // It drives towards the tag, 0.1 m a look; its odometry began elsewhere, askew.
  const Pose2 began{-3.0, 7.0, 1.0};
  for (int i = 0; i < 6; ++i) {
    nav::LandmarkSight s = sight(0.15 * i);
    s.seen = {2.0 - 0.1 * i, 0.0};
    found = first.look(3, s, began * Pose2{0.1 * i, 0.0, 0.0});
  }
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->at.east_m, 8.5, 1e-9);
  EXPECT_NEAR(found->at.north_m, 5.0, 1e-9);
  EXPECT_NEAR(found->yaw_rad, 0.0, 1e-9);
}

TEST(FirstSight, WithoutAWayThatItFacesOrANumberNothingIsLookedAt) {
  FirstSight first;
  for (int i = 0; i < 20; ++i) {
    nav::LandmarkSight s = sight(0.1 * i);
    if (i % 2 == 0) {
      s.yaw_rad.reset();
    } else {
      s.seen.x() = std::numeric_limits<double>::quiet_NaN();
    }
    EXPECT_FALSE(first.look(3, s, {}));
  }
}

}  // namespace
}  // namespace roverd::robot
