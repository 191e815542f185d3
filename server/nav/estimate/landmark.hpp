#pragma once
// A thing whose place is known, as it was seen from the body: what Estimator::correct takes.

#include <optional>

#include <Eigen/Core>

#include "base/geo.hpp"
#include "base/time.hpp"

namespace roverd::nav {

struct LandmarkSight {
  base::Time stamp;             ///< when it was seen
  base::EnuPoint at;            ///< where it stands, in the estimator's frame
  double place_sigma_m = 0.05;  ///< how well that is known, each way; more looks do not help
  Eigen::Vector2d seen{0, 0};   ///< from the body then: ahead, left, m
  Eigen::Matrix2d seen_covariance = Eigen::Matrix2d::Identity();  ///< of that, of one look, m^2
  double since_s = 1.0;           ///< since the look at it before: those within a second err alike
  std::optional<double> yaw_rad;  ///< the body's, from east, by the way that it faces
  double yaw_sigma_rad = 0.1;     ///< of one look
  double face_sigma_rad = 0.035;  ///< how well it is known which way it faces
};

/// Where the body stood by what it saw, of which nothing was known before.
struct LandmarkPose {
  base::Time stamp;
  base::EnuPoint at;  ///< in the estimator's frame
  double yaw_rad = 0.0;
  double sigma_m = 0.0;  ///< 1 sigma, each way
  double sigma_rad = 0.0;
};

/// How a sight compares with what is believed.
struct LandmarkLook {
  base::EnuPoint off;     ///< so far the robot would have to stand elsewhere
  double sigma_m = 0.0;   ///< of off, all together, the worse direction
  double belief_m = 0.0;  ///< what of it the estimate's own uncertainty is
  double nis = 0.0;       ///< offᵀ S⁻¹ off
  double turn_rad = 0.0;  ///< so far its heading would have to be another one; 0: not told
  double turn_sigma_rad = 0.0;
};

/// 99 % of a chi-square with two degrees of freedom: what is refused more often than it must.
inline constexpr double kLandmarkGate2 = 9.21;

}  // namespace roverd::nav
