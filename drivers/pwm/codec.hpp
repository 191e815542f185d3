#pragma once
// Servo pulses for skid steer: 900..2100 us a side, 1500 us stands still.
//
//   linear  = speed_factor · (right + left)/2      right, left: pulses normalised to [−1, 1]
//   angular = turn_factor · (right − left)         counter-clockwise positive
//
// Pure.

#include <optional>

#include "base/geo.hpp"

namespace roverd::pwm {

inline constexpr int kLowest_us = 900;
inline constexpr int kCentre_us = 1500;
inline constexpr int kHighest_us = 2100;

struct Pulses {
  int left_us = kCentre_us;
  int right_us = kCentre_us;
  friend bool operator==(const Pulses&, const Pulses&) = default;
};

/// m/s at both sides full ahead; rad/s for each 1 of difference (full turn: twice that). Both > 0.
struct Factors {
  double speed_mps = 1.0;
  double turn_radps = 0.5;
};

/// Empty: a pulse outside 900..2100 us (a receiver without a signal gives 0, or anything).
std::optional<base::BodyTwist> to_twist(Pulses pulses, const Factors& factors) noexcept;

/// A twist beyond what the pulses can say is shrunk as a whole: the bend stays the same. NaN:
/// centre.
Pulses to_pulses(base::BodyTwist twist, const Factors& factors) noexcept;

}  // namespace roverd::pwm
