#pragma once
// How far a fix may be trusted, by its class and by what the receiver says of itself.

#include <optional>

#include "base/measurements.hpp"
#include "nav/estimate/ekf.hpp"

namespace roverd::nav {

struct GnssQuality {
  double sigma_east_m = 0.0;  ///< white noise, 1σ
  double sigma_north_m = 0.0;
  Drift drift;  ///< slow part on top of it
  double velocity_sigma_mps = 0.0;
};

/// Empty: not to be used (no fix, dead reckoning, unknown class, no or invalid position).
/// | class     | white floor | drift      | velocity |
/// | rtk_fixed | 0.015 m     | none       | 0.05 m/s |
/// | rtk_float | 0.25 m      | 0.3 m 60 s | 0.10 m/s |
/// | dgps      | 0.5 m       | 0.6 m 100 s| 0.10 m/s |
/// | gps       | 1.0 m       | 1.2 m 90 s | 0.15 m/s |
/// The white part is the larger of floor × hdop (hdop above 1 only) and the receiver's own figure.
/// @param settled false during the first seconds of a new RTK fix, which may still be a wrong one.
/// @param drift_scale multiplies the drift.
std::optional<GnssQuality> gnss_quality(const base::GnssFix& fix, bool settled,
                                        double drift_scale) noexcept;

/// Velocity noise of a class when the receiver gives none; never below 0.05 m/s.
double velocity_sigma_mps(base::FixType fix, std::optional<double> reported_mps) noexcept;

}  // namespace roverd::nav
