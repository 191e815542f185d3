#pragma once
// What the estimator has learned of this robot and will be as true tomorrow: worth keeping over a
// restart. Never the compass bias, which belongs to the place.

#include <optional>

namespace roverd::nav {

struct LearnedValue {
  double value = 0.0;
  double sigma = 0.0;  ///< > 0
  double age_s = 0.0;  ///< since it was learned
};

struct Learned {
  std::optional<LearnedValue> odometry_scale;   ///< true way over that of the tracks
  std::optional<LearnedValue> gyro_bias_radps;  ///< what the gyro shows at rest
  std::optional<LearnedValue> pivot_m{};  ///< of the place it turns about, ahead of its origin
  // Not the estimator's: nav/identify.
  std::optional<LearnedValue> delay_s{};       ///< from a command to its motion
  std::optional<LearnedValue> braking_mps2{};  ///< it brakes no harder
  // Of a calibration drive that a person kept.
  std::optional<LearnedValue> acceleration_mps2{};  ///< it speeds up no harder
  std::optional<LearnedValue> yaw_scale{};          ///< true turn over that of the tracks
  std::optional<LearnedValue> pull_1pm{};           ///< bend of a straight command; left positive
  bool forgotten = false;  ///< what is not told here and was kept before is wrong
};

/// A value that is no more certain than this was not learned, and is not told.
inline constexpr double kScaleLearned = 0.02;
inline constexpr double kGyroBiasLearned_radps = 0.0015;  // 0.09 deg/s
inline constexpr double kPivotLearned_m = 0.01;
/// One that is recalled is less certain: told again only once it was learned again.
inline constexpr double kScaleRecalled = 0.03;
inline constexpr double kGyroBiasRecalled_radps = 0.0025;  // 0.14 deg/s
inline constexpr double kYawScaleRecalled = 0.02;
inline constexpr double kPullRecalled_1pm = 0.005;
inline constexpr double kPivotRecalled_m = 0.015;

}  // namespace roverd::nav
