#pragma once
// By how much a map's anchor is off, as satellites show it: metres in ENU, to be added to what the
// map says. It is learned along what the map shows only: a bare corridor says nothing of the way
// along it. Pure; one thread.

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace roverd::nav {

class MapOffset {
 public:
  static constexpr double kLeast_m = 0.02;  ///< a map may be bent: its offset is another elsewhere

  /// @param sigma_m of the anchor, each way, at least 0
  void begin(double sigma_m) noexcept {
    covariance_ = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
  }
  const Eigen::Matrix2d& covariance() const noexcept { return covariance_; }
  /// Along the larger axis.
  double sigma_m() const noexcept {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance_, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, axes.eigenvalues()(1)));
  }
  /// One look at it. @param r of that look, positive definite (m^2). @return the share of what is
  /// missing that is to be believed
  Eigen::Matrix2d learn(const Eigen::Matrix2d& r) noexcept {
    const Eigen::Matrix2d gain = covariance_ * (covariance_ + r).inverse();
    const Eigen::Matrix2d left = covariance_ - gain * covariance_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(0.5 * (left + left.transpose()));
    const double least = std::min(kLeast_m * kLeast_m, covariance_.diagonal().minCoeff());
    covariance_ = axes.eigenvectors() * axes.eigenvalues().cwiseMax(least).asDiagonal() *
                  axes.eigenvectors().transpose();
    return gain;
  }

 private:
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

}  // namespace roverd::nav
