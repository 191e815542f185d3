#pragma once
// Velodyne VLP-16 (Puck) and Puck Hi-Res: what their datagrams hold, and how they are written.
// Pure; little endian; nothing is allocated but the text of a sentence.
//
// Data packet, 1206 bytes: 12 blocks of {FF EE, azimuth u16 in 0.01 deg clockwise from above,
// 32 x (distance u16 in 2 mm, 0: no return; reflectivity u8)}, then the time of the first firing
// (u32, microseconds since the top of the hour), return mode, product.
// A block holds two firing sequences of the 16 lasers, one laser after the other. With dual return
// two blocks in a row tell the same firings: the even one the last return, the odd one the
// strongest, or the second strongest where the last is itself the strongest.
//
// Position packet, 512 bytes: microseconds since the hour at 198, state of the pulse per second at
// 202, an NMEA sentence at 206, the rest zero.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/bytes.hpp"

namespace roverd::velodyne {

using base::Bytes;

inline constexpr std::size_t kPacketSize = 1206;
inline constexpr std::size_t kPositionSize = 512;
inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kChannels = 32;  ///< of a block: two sequences
inline constexpr std::size_t kLasers = 16;
inline constexpr unsigned kTurn_cdeg = 36'000;
inline constexpr std::uint32_t kHour_us = 3'600'000'000;

inline constexpr double kUnit_m = 0.002;        ///< of a distance word
inline constexpr double kLaser_us = 2.304;      ///< from one laser to the next
inline constexpr double kSequence_us = 55.296;  ///< sixteen lasers and the recharging
inline constexpr double kBlock_us = 2.0 * kSequence_us;

enum class ReturnMode : std::uint8_t { Strongest = 0x37, Last = 0x38, Dual = 0x39 };
enum class Product : std::uint8_t { Vlp16 = 0x22, Vlp16HiRes = 0x24 };
std::string_view to_string(ReturnMode m) noexcept;  // strongest last dual
std::string_view to_string(Product p) noexcept;     // VLP-16, VLP-16 Hi-Res

struct Return {
  std::uint16_t distance = 0;  ///< 2 mm; 0: none
  std::uint8_t reflectivity = 0;
  friend bool operator==(const Return&, const Return&) = default;
};
struct Block {
  std::uint16_t azimuth_cdeg = 0;  ///< of its first firing, 0..35999
  std::array<Return, kChannels> channels{};
  friend bool operator==(const Block&, const Block&) = default;
};
struct Packet {
  std::array<Block, kBlocks> blocks{};
  std::uint32_t stamp_us = 0;  ///< 0..3599999999
  ReturnMode mode = ReturnMode::Strongest;
  Product product = Product::Vlp16;

  /// Blocks of the same firings.
  std::size_t together() const noexcept { return mode == ReturnMode::Dual ? 2 : 1; }
  /// From its first firing to that of the next packet: 1327.104 us, with dual return half of it.
  double period_us() const noexcept {
    return kBlock_us * static_cast<double>(kBlocks / together());
  }
  friend bool operator==(const Packet&, const Packet&) = default;
};

enum class Fault {
  None,
  WrongSize,
  BadFlag,     ///< a block does not begin with FF EE
  BadAzimuth,  ///< 360 deg or more
  BadStamp,    ///< more than an hour
  UnknownMode,
  OtherProduct,
};

struct Decoded {
  Fault fault = Fault::None;
  std::uint8_t at = 0;  ///< the block; or the byte of mode or product
  Packet packet{};      ///< only without a fault
};
Decoded decode(Bytes datagram) noexcept;
/// What is wrong in words: "block 3 does not begin with FF EE", "product 28 is a VLP-32C: …".
std::string describe(const Decoded& refused);

std::array<std::uint8_t, kPacketSize> encode(const Packet& packet) noexcept;

struct Position {
  std::uint32_t stamp_us = 0;  ///< since the top of the hour
  std::uint8_t pps = 0;        ///< 0 absent, 1 synchronizing, 2 locked, 3 in error
  std::string nmea{};          ///< without line end; empty: the sensor has no receiver
  friend bool operator==(const Position&, const Position&) = default;
};
inline constexpr std::size_t kLongestSentence = 128;

struct DecodedPosition {
  Fault fault = Fault::None;  ///< WrongSize or BadStamp
  Position position{};
};
DecodedPosition decode_position(Bytes datagram);
/// A sentence is cut to kLongestSentence.
std::array<std::uint8_t, kPositionSize> encode(const Position& position) noexcept;

// ---- where a channel of a block points, and when

/// After the first firing of its block.
constexpr double firing_us(std::size_t channel) noexcept {
  return static_cast<double>(channel / kLasers) * kSequence_us +
         static_cast<double>(channel % kLasers) * kLaser_us;
}
/// 0 lowest.
constexpr std::uint8_t ring_of(std::size_t laser) noexcept {
  return static_cast<std::uint8_t>(laser / 2 + (laser % 2 == 0 ? 0 : kLasers / 2));
}
/// Above the horizon. VLP-16: -15, +1, -13 … +15; Hi-Res: -10, +2/3, -26/3 … +10 in steps of 4/3.
constexpr double elevation_deg(Product product, std::size_t laser) noexcept {
  const double step_deg = product == Product::Vlp16 ? 2.0 : 4.0 / 3.0;
  return (ring_of(laser) - 7.5) * step_deg;
}
/// How much higher than the middle the laser looks out: 11.2 mm at the lowest ring to −11.2 mm.
double height_m(Product product, std::size_t laser) noexcept;

/// Steps of azimuth from block to block, hundredths of a degree. Where two neighbours tell none (a
/// packet beside a filtered sector, a motor that starts): the fallback.
/// @param fallback_cdeg of a block with single return.
struct Steps {
  std::array<std::uint16_t, kBlocks> cdeg{};  ///< [first block of a pair] with dual return
  bool gap = false;                           ///< the fallback was needed
};
Steps steps_of(const Packet& packet, std::uint16_t fallback_cdeg) noexcept;
/// Of the step: less is none, more is a gap.
inline constexpr unsigned kLargestStep_cdeg = 500;
/// At 600 turns a minute, 110.592 us.
inline constexpr std::uint16_t kNominalStep_cdeg = 40;

}  // namespace roverd::velodyne
