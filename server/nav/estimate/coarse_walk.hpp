#pragma once
// What a coarse receiver may do to a place that was known well.
//
// Its velocity errs slowly (by some cm/s for some ten seconds), which no filter of white noise
// sees: summed up it is a walk, σ² = 2·σ_v²·τ·t (a Gauss-Markov velocity of σ_v and τ, for t much
// longer than τ), until the receiver's own accuracy bounds it. Source: P. S. Maybeck, Stochastic
// models, estimation, and control, volume 1, section 4.11.

#include <algorithm>

namespace roverd::nav {

class CoarseWalk {
 public:
  /// A position of the coarse receiver was taken. @param moves it does not stand
  /// @param most_m accuracy of the receiver
  void led(bool moves, double dt_s, double most_m) noexcept {
    most_m2_ = most_m * most_m;
    if (moves) walked_m2_ += kVelocity_mps * kVelocity_mps * 2.0 * kTau_s * std::max(0.0, dt_s);
  }
  /// Something better led: satellites that are fixed or corrected, a map, a known place.
  void found() noexcept { walked_m2_ = 0.0; }

  /// Variance of the place, which is not known better than this.
  double least_m2() const noexcept { return std::min(walked_m2_, most_m2_); }

 private:
  static constexpr double kVelocity_mps = 0.03;
  static constexpr double kTau_s = 10.0;

  double walked_m2_ = 0.0;
  double most_m2_ = 0.0;
};

}  // namespace roverd::nav
