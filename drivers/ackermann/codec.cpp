#include "ackermann/codec.hpp"

#include <bit>

namespace roverd::ackermann {
namespace {

constexpr std::uint8_t kSpeedMark = 0x10;
constexpr std::uint8_t kWheelMark = 0x20;
constexpr std::uint8_t kModeMark = 0x30;

void put(std::uint8_t* to, float value) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (unsigned i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(bits >> (24U - 8U * i));
}

float get(base::Bytes from, std::size_t at) noexcept {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits = bits << 8U | from[at + i];
  return std::bit_cast<float>(bits);
}

}  // namespace

std::array<std::uint8_t, kLength> encode(const Message& m) noexcept {
  std::array<std::uint8_t, kLength> out{};
  out[0] = kSpeedMark;
  put(&out[1], m.speed_mps);
  out[5] = kWheelMark;
  put(&out[6], m.wheel_rad);
  out[10] = kModeMark;
  out[11] = static_cast<std::uint8_t>(m.mode);
  return out;
}

Decoded decode(base::Bytes d) noexcept {
  if (d.size() != kLength) return {Fault::WrongLength, {}};
  if (d[0] != kSpeedMark || d[5] != kWheelMark || d[10] != kModeMark) {
    return {Fault::WrongMark, {}};
  }
  if (d[11] < 1 || d[11] > 3) return {Fault::WrongMode, {}};
  const Message m{get(d, 1), get(d, 6), static_cast<DriveMode>(d[11])};
  if (!std::isfinite(m.speed_mps) || !std::isfinite(m.wheel_rad)) return {Fault::NotFinite, {}};
  return {Fault::None, m};
}

const char* to_string(Fault fault) noexcept {
  switch (fault) {
    case Fault::None:
      return "intact";
    case Fault::WrongLength:
      return "wrong length";
    case Fault::WrongMark:
      return "wrong mark";
    case Fault::WrongMode:
      return "unknown mode";
    case Fault::NotFinite:
      return "not a number";
  }
  return "";
}

}  // namespace roverd::ackermann
