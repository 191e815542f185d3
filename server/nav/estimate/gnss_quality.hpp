#pragma once
// How far a fix may be trusted, by its class and by what the receiver says of itself.

#include <optional>

#include "base/measurements.hpp"
#include "base/result.hpp"
#include "base/snapshot.hpp"
#include "nav/estimate/ekf.hpp"

namespace roverd::nav {

struct GnssQuality {
  double sigma_east_m = 0.0;  ///< white noise, 1σ
  double sigma_north_m = 0.0;
  Drift drift;  ///< slow part on top of it
};

/// Below (above) these a fix is not used, where the receiver tells.
struct GnssLimits {
  int satellites_min = 6;
  double hdop_max = 2.5;
  double sigma_max_m = 3.0;
  double drift_scale = 1.0;  ///< multiplies the drift
};

/// Why not: empty for what is no fix at all (none, dead reckoning, unknown class, no position).
using NoQuality = std::optional<base::Refusal>;

/// The whole error is the receiver's own figure, at least `least`; without one that of `typical`
/// times hdop (above 1). It is white only in part: the rest wanders within minutes, and averaging
/// it would make claims that are not true. | class     | least   | typical | white | drift | tau |
/// | rtk_fixed | 0.015 m | 0.015 m | × 1.5 | none  |       |
/// | rtk_float | 0.1 m   | 0.35 m  | 1/4   | 0.968 | 60 s  |
/// | dgps      | 0.3 m   | 0.8 m   | 1/4   | 0.968 | 100 s |
/// | gps       | 0.5 m   | 1.2 m   | 1/4   | 0.968 | 400 s |
/// Sources: D. L. Wilson, GPS error correlation; Sensors 2020, 20(21) 6050; limits as PX4's.
/// @param settled false during the first seconds of a new RTK fix, which may still be a wrong one.
tl::expected<GnssQuality, NoQuality> gnss_quality(const base::GnssFix& fix, bool settled,
                                                  const GnssLimits& limits) noexcept;

/// Velocity noise of a class when the receiver gives none; never below 0.05 m/s.
double velocity_sigma_mps(base::FixType fix, std::optional<double> reported_mps) noexcept;

}  // namespace roverd::nav
