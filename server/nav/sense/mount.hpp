#pragma once
// How a sensor stands on the body: the one place where a Mount becomes a rotation.
//
//   p_B = R p_S + t,   R = Rz(yaw) Ry(pitch) Rx(roll),   t = (x, y, z)
//
// S is the sensor's frame, B the body's, both FLU (base/sight.hpp). Positive pitch turns the
// sensor's x axis down. Source of the product: Craig, Introduction to Robotics, fixed angles X-Y-Z.

#include <Eigen/Core>

#include "base/result.hpp"
#include "base/sight.hpp"

namespace roverd::nav::sense {

/// Turns what is told in S into B. Orthonormal. @param mount angles of any finite size.
Eigen::Matrix3d rotation(const base::Mount& mount) noexcept;

/// A place that a sensor of a robot can have: every number finite, at least 2 cm above the ground
/// and at most 5 m, at most 5 m from the origin, angles within a full turn. The error names the
/// field ("/z_m").
base::Result<void> check_mount(const base::Mount& mount);

}  // namespace roverd::nav::sense
