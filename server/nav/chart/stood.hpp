#pragma once
// A pose in the plane, with how the body lies there, as one motion in three dimensions.

#include <Eigen/Geometry>

#include "nav/sense/odometry.hpp"

namespace roverd::nav::chart {

/// X_MB: takes points of B (FLU, on the ground) to M (z up). @param z_m of B in M; of the lie only
/// roll and pitch are looked at. Pure.
inline Eigen::Isometry3d stood(const sense::Pose2& pose, double z_m, const sense::Lie3& lie) {
  Eigen::Isometry3d x = Eigen::Isometry3d::Identity();
  x.translation() = Eigen::Vector3d(pose.x_m, pose.y_m, z_m);
  x.linear() = (Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(-lie.pitch_rad, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(lie.roll_rad, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return x;
}

}  // namespace roverd::nav::chart
