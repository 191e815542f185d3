#pragma once
// A turn that nobody commanded: the ground's yaw rate minus what the commands of one delay ago
// should have made of it, smoothed. Removes what the estimator's scale and pull have not learned.
//
//   d += (w_measured − w_sent(t − T) − d)·dt/τ ,  w_sent = w_wanted − d
//
// Frozen while slow, turning hard or saturated: there the model is worth less than the guess.
// Pure state, no allocation.

#include <algorithm>
#include <cmath>

#include "base/geo.hpp"
#include "nav/track/params.hpp"

namespace roverd::nav {

class YawObserver {
 public:
  static constexpr double kSlow_mps = 0.15;
  static constexpr double kHard_radps = 0.3;

  /// @param measured over ground. @param sent_radps likewise, one delay ago.
  void step(base::BodyTwist measured, double sent_radps, bool saturated, const TrackParams& p,
            double dt_s) noexcept {
    const double measured_radps = measured.angular_radps;
    const bool model = !saturated && std::abs(measured.linear_mps) > kSlow_mps &&
                       std::abs(sent_radps) < kHard_radps && std::isfinite(measured_radps);
    if (!model) return;
    const double share = std::min(1.0, dt_s / p.observer_s);
    d_radps_ += (measured_radps - sent_radps - d_radps_) * share;
    d_radps_ = std::clamp(d_radps_, -p.observer_max_radps, p.observer_max_radps);
  }
  void reset() noexcept { d_radps_ = 0.0; }
  double radps() const noexcept { return d_radps_; }

 private:
  double d_radps_ = 0.0;
};

}  // namespace roverd::nav
