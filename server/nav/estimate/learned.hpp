#pragma once
// What the estimator has learned of this robot and will be as true tomorrow: worth keeping over a
// restart. Never the compass bias, which belongs to the place.

#include <optional>

namespace roverd::nav {

struct LearnedValue {
  double value = 0.0;
  double sigma = 0.0;  ///< > 0
};

struct Learned {
  std::optional<LearnedValue> odometry_scale;   ///< true way over that of the tracks
  std::optional<LearnedValue> gyro_bias_radps;  ///< what the gyro shows at rest
};

/// A value that is no more certain than this was not learned, and is not told.
inline constexpr double kScaleLearned = 0.02;
inline constexpr double kGyroBiasLearned_radps = 0.0015;  // 0.09 deg/s
/// One that is recalled is less certain: told again only once it was learned again.
inline constexpr double kScaleRecalled = 0.03;
inline constexpr double kGyroBiasRecalled_radps = 0.0025;  // 0.14 deg/s

}  // namespace roverd::nav
