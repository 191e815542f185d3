#pragma once
// Our own simple protocol for microcontrollers: what is said, in either form.
//
//   command    host → device   50 times a second
//   feedback   device → host   20 times a second or more
//
// The device obeys only commands with enable, stops when none came for 0.3 s (watchdog, status bit
// 1), and after that needs nothing but the next command. Sequence numbers count up by one and wrap
// at 256; a feedback repeats the number of the last command it understood.

#include <cstdint>

namespace roverd::twist {

inline constexpr double kWatchdog_s = 0.3;  ///< the device's

struct Command {
  std::uint8_t seq = 0;
  double speed_mps = 0.0;
  double turn_radps = 0.0;
  bool enable = false;
  friend bool operator==(const Command&, const Command&) = default;
};

enum Status : std::uint8_t {
  kObeying = 1U << 0U,     ///< enabled and following commands
  kWatchdog = 1U << 1U,    ///< stopped: no command in time
  kMotorFault = 1U << 2U,  ///< stopped
  kLowBattery = 1U << 3U,
  kByHand = 1U << 4U,  ///< a person drives it by radio or stick
  kTooHot = 1U << 5U,
};

struct Feedback {
  std::uint8_t seq = 0;
  std::uint8_t ack = 0;  ///< of the last command
  double speed_mps = 0.0;
  double turn_radps = 0.0;
  double left_m = 0.0;     ///< travel of the left side since power-up
  double right_m = 0.0;    ///< and of the right one
  double battery_v = 0.0;  ///< 0: not measured
  std::uint8_t status = 0;
  bool estop = false;  ///< its button is pressed
  friend bool operator==(const Feedback&, const Feedback&) = default;
};

}  // namespace roverd::twist
