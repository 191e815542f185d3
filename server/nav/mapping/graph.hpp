#pragma once
// Poses and what was measured between them, brought to agree: a pose graph. Measurements that may
// be wrong (loops) lose their pull where they contradict all others.
// Source: Grisetti and others 2010, "A tutorial on graph-based SLAM"; solved by Ceres.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "nav/sense/odometry.hpp"

namespace roverd::nav::mapping {

using sense::Pose2;

/// X_AB as measured.
struct Edge {
  std::size_t a = 0;
  std::size_t b = 0;
  Pose2 x_ab;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< x y in A, yaw; m, rad
  bool loop = false;                                         ///< may be wrong
};

/// How far the poses are from the measurement, in deviations; of three numbers.
double strain(const Edge& edge, std::span<const Pose2> poses);

/// Moves all poses but the first. @param edges their ends are poses, covariances positive.
/// @return false: nothing was changed, the numbers do not go.
bool relax(std::span<const Edge> edges, std::vector<Pose2>& poses);

}  // namespace roverd::nav::mapping
