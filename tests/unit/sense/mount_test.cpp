// How a sensor stands on the body.
#include "nav/sense/mount.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/angle.hpp"

namespace roverd::nav::sense {
namespace {

using base::kPi;

//   x of S (ahead) ──▶ yaw 90 deg left: y of B; pitch 90 deg down: −z of B; roll 90: left goes up
TEST(MountTest, EachAngleTurnsAsTheHeaderDraws) {
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY();
  EXPECT_TRUE((rotation({.yaw_rad = kPi / 2}) * ahead).isApprox(left, 1e-12));
  EXPECT_TRUE(
      (rotation({.pitch_rad = kPi / 2}) * ahead).isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE((rotation({.roll_rad = kPi / 2}) * left).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST(MountTest, AllAnglesTogetherAreTheProductOfTheThreeAxes) {
  const base::Mount m{.roll_rad = 0.3, .pitch_rad = -0.7, .yaw_rad = 2.1};
  const Eigen::Matrix3d want = (Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-0.7, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  EXPECT_TRUE(rotation(m).isApprox(want, 1e-12));
}

TEST(MountTest, ASensorInTheGroundIsRefusedByName) {
  const auto refused = check_mount({.x_m = 0.4, .z_m = -0.1});
  ASSERT_FALSE(refused.has_value());
  ASSERT_EQ(refused.error().fields.size(), 1U);
  EXPECT_EQ(refused.error().fields[0].pointer, "/z_m");
  EXPECT_FALSE(check_mount({}).has_value()) << "on the ground itself";
  EXPECT_TRUE(check_mount({.x_m = 0.4, .z_m = 0.3}).has_value());
}

TEST(MountTest, EveryAbsurdFieldIsNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto refused = check_mount({nan, 50.0, inf, 7.0, nan, -inf});
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().fields.size(), 6U);
}

}  // namespace
}  // namespace roverd::nav::sense
