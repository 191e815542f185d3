#pragma once
// Repeatable randomness. Each error of the robot draws from a stream of its own, so switching one
// fault on does not change the course of the others.

#include <cstdint>
#include <random>

namespace roverd::sim {

/// Each user of randomness; the number is part of what a seed means: only append.
enum class Stream : std::uint64_t {
  LeftSlip = 1,
  RightSlip,
  GnssEast,
  GnssNorth,
  GnssHeight,
  GnssDriftEast,
  GnssDriftNorth,
  GnssVelocity,
  Compass,
  LossToBase,
  LossFromBase,
  Gyro,
  GyroWander,
  Accelerometer,
  ImuCompass,
  Antennas,
  DelayJitter,
  TreesEast,
  TreesNorth,
  TreesFix,
  PlainSlowEast,
  PlainSlowNorth,
  PlainFastEast,
  PlainFastNorth,
  PlainVelocityEast,
  PlainVelocityNorth,
};

/// Spreads neighbouring numbers apart. Source: Steele, Lea, Flood 2014 (SplitMix64).
std::uint64_t mix(std::uint64_t z) noexcept;

class Noise {
 public:
  Noise(std::uint64_t seed, Stream stream);

  double uniform();  ///< [0, 1)
  double normal();   ///< mean 0, sigma 1

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// First-order Gauss-Markov process with sigma 1: neighbours in time are alike, and the likeness
/// falls to 1/e after tau. x(t+dt) = x(t)·e^(−dt/τ) + sqrt(1 − e^(−2dt/τ))·w.
class Drift {
 public:
  Drift(std::uint64_t seed, Stream stream) : noise_(seed, stream), value_(noise_.normal()) {}

  /// @param dt_s >= 0. @param tau_s > 0.
  double step(double dt_s, double tau_s);
  double value() const noexcept { return value_; }

 private:
  Noise noise_;
  double value_;
};

}  // namespace roverd::sim
