#pragma once
// The car link of the Ackermann vehicles: one UDP datagram of 12 bytes, 100 times a second, the
// numbers big-endian. The same layout may come back as feedback.
//
//   0    1..4                5    6..9                        10   11
//   10   f32 speed, m/s      20   f32 front wheel angle, rad  30   u8 mode
//
// Example: 1.23 m/s, 0.2571 rad, autonomous = 10 3F9D70A4 20 3E83A29C 30 02.
// The angle is the middle front wheel's, left positive. Pure.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/bytes.hpp"
#include "base/geo.hpp"

namespace roverd::ackermann {

inline constexpr std::size_t kLength = 12;

enum class DriveMode : std::uint8_t { Park = 1, Autonomous = 2, Remote = 3 };

struct Message {
  float speed_mps = 0.0F;
  float wheel_rad = 0.0F;
  DriveMode mode = DriveMode::Park;
  friend bool operator==(const Message&, const Message&) = default;
};

enum class Fault { None, WrongLength, WrongMark, WrongMode, NotFinite };

struct Decoded {
  Fault fault = Fault::None;
  Message message;  ///< meaningful without a fault
};

std::array<std::uint8_t, kLength> encode(const Message& message) noexcept;
/// Exactly one datagram.
Decoded decode(base::Bytes datagram) noexcept;
const char* to_string(Fault fault) noexcept;  // in words: "wrong length"

/// Bicycle model: tan(wheel) = L·ω/v. @return empty where the ratio means nothing: slower than
/// 2 cm/s. Not limited.
inline std::optional<double> wheel_from_twist(base::BodyTwist t, double wheelbase_m) noexcept {
  constexpr double kStanding_mps = 0.02;
  if (std::abs(t.linear_mps) < kStanding_mps) return {};
  return std::atan(wheelbase_m * t.angular_radps / t.linear_mps);
}

inline base::BodyTwist twist_from_wheel(double speed_mps, double wheel_rad,
                                        double wheelbase_m) noexcept {
  return {speed_mps, speed_mps * std::tan(wheel_rad) / wheelbase_m};
}

}  // namespace roverd::ackermann
