#pragma once
// The simulated base with older firmware: protocol V1 instead of V2. What it tells and what it
// understands; how it moves is the same. It has no radio frame, no odometer and no battery frame.

#include <cstdint>
#include <optional>
#include <vector>

#include "base/bytes.hpp"
#include "base/geo.hpp"
#include "base/measurements.hpp"
#include "sim/params.hpp"

namespace roverd::sim {

using base::CanFrame;

/// What the base knows of itself at one step.
struct V1Facts {
  base::VehicleState vehicle_state = base::VehicleState::Normal;
  base::ControlMode control_mode = base::ControlMode::Standby;
  double battery_v = 0.0;
  std::uint16_t error_code = 0;  ///< in V1's bits
  base::BodyTwist measured;
  struct Motor {
    double current_a = 0.0;
    double rpm = 0.0;
    double heat_c = 25.0;
  };
  Motor right;  ///< motor 1
  Motor left;   ///< motor 2
};

/// The frames of one step, in the periods of the real base; its counters.
class V1Voice {
 public:
  /// @param step of 5 ms, counted from the start.
  std::vector<CanFrame> at(std::int64_t step, const V1Facts& facts);

 private:
  std::uint8_t motion_count_ = 0;
  std::uint8_t state_count_ = 0;
  std::uint8_t motor_count_ = 0;
};

/// What a host's 0x130 orders.
struct V1Order {
  std::uint8_t mode = 0;                  ///< 0 radio or nobody, 1 CAN, 2 serial
  std::optional<base::BodyTwist> motion;  ///< in mode 1 only
  std::uint16_t cleared = 0;              ///< error bits
};

/// Empty for anything but an intact 0x130.
std::optional<V1Order> v1_order(const CanFrame& frame, const BaseParams& params) noexcept;

}  // namespace roverd::sim
