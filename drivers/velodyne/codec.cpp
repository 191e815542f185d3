#include "velodyne/codec.hpp"

#include <algorithm>
#include <cstdio>

namespace roverd::velodyne {
namespace {

constexpr std::size_t kBlockSize = 100;
constexpr std::size_t kStampAt = kBlocks * kBlockSize;
constexpr std::size_t kModeAt = kStampAt + 4;
constexpr std::size_t kProductAt = kModeAt + 1;
constexpr std::size_t kPositionStampAt = 198;
constexpr std::size_t kPpsAt = 202;
constexpr std::size_t kSentenceAt = 206;

std::uint16_t u16(const std::uint8_t* at) noexcept {
  return static_cast<std::uint16_t>(at[0] | at[1] << 8U);
}
std::uint32_t u32(const std::uint8_t* at) noexcept {
  return static_cast<std::uint32_t>(u16(at)) | static_cast<std::uint32_t>(u16(at + 2)) << 16U;
}
void put16(std::uint8_t* at, unsigned value) noexcept {
  at[0] = static_cast<std::uint8_t>(value & 0xFFU);
  at[1] = static_cast<std::uint8_t>(value >> 8U & 0xFFU);
}
void put32(std::uint8_t* at, std::uint32_t value) noexcept {
  put16(at, value & 0xFFFFU);
  put16(at + 2, value >> 16U);
}

Decoded refuse(Fault fault, std::size_t at) noexcept {
  Decoded out;
  out.fault = fault;
  out.at = static_cast<std::uint8_t>(at);
  return out;
}

/// Other sensors of the maker whose packets have the same size.
const char* other_product(std::uint8_t code) noexcept {
  switch (code) {
    case 0x20:
      return "an HDL-64E";
    case 0x21:
      return "an HDL-32E";
    case 0x28:
      return "a VLP-32C";
    case 0x31:
      return "a Velarray";
    case 0xA1:
      return "a VLS-128";
    default:
      return "no sensor that is known";
  }
}

std::string hex_byte(std::uint8_t value) {
  char text[4];
  std::snprintf(text, sizeof text, "%02X", value);
  return text;
}

void read_block(const std::uint8_t* at, Block& block) noexcept {
  block.azimuth_cdeg = u16(at + 2);
  const std::uint8_t* channel = at + 4;
  for (Return& r : block.channels) {
    r.distance = u16(channel);
    r.reflectivity = channel[2];
    channel += 3;
  }
}

}  // namespace

std::string_view to_string(ReturnMode m) noexcept {
  switch (m) {
    case ReturnMode::Strongest:
      return "strongest";
    case ReturnMode::Last:
      return "last";
    case ReturnMode::Dual:
      return "dual";
  }
  return "?";
}

std::string_view to_string(Product p) noexcept {
  switch (p) {
    case Product::Vlp16:
      return "VLP-16";
    case Product::Vlp16HiRes:
      return "VLP-16 Hi-Res";
  }
  return "?";
}

Decoded decode(Bytes datagram) noexcept {
  if (datagram.size() != kPacketSize) return refuse(Fault::WrongSize, 0);
  const std::uint8_t* data = datagram.data();
  const std::uint8_t product = data[kProductAt];
  // First: what else is wrong with another sensor's packet is of no interest.
  if (product != static_cast<std::uint8_t>(Product::Vlp16) &&
      product != static_cast<std::uint8_t>(Product::Vlp16HiRes)) {
    return refuse(Fault::OtherProduct, product);
  }
  const std::uint8_t mode = data[kModeAt];
  if (mode < static_cast<std::uint8_t>(ReturnMode::Strongest) ||
      mode > static_cast<std::uint8_t>(ReturnMode::Dual)) {
    return refuse(Fault::UnknownMode, mode);
  }
  Decoded out;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::uint8_t* at = data + b * kBlockSize;
    if (at[0] != 0xFF || at[1] != 0xEE) return refuse(Fault::BadFlag, b);
    read_block(at, out.packet.blocks[b]);
    if (out.packet.blocks[b].azimuth_cdeg >= kTurn_cdeg) return refuse(Fault::BadAzimuth, b);
  }
  out.packet.stamp_us = u32(data + kStampAt);
  if (out.packet.stamp_us >= kHour_us) return refuse(Fault::BadStamp, 0);
  out.packet.mode = static_cast<ReturnMode>(mode);
  out.packet.product = static_cast<Product>(product);
  return out;
}

std::string describe(const Decoded& refused) {
  switch (refused.fault) {
    case Fault::None:
      return {};
    case Fault::WrongSize:
      return "a datagram that has not 1206 bytes";
    case Fault::BadFlag:
      return "block " + std::to_string(refused.at) + " does not begin with FF EE";
    case Fault::BadAzimuth:
      return "block " + std::to_string(refused.at) + " has an azimuth of 360 deg or more";
    case Fault::BadStamp:
      return "a time stamp of more than an hour";
    case Fault::UnknownMode:
      return "unknown return mode " + hex_byte(refused.at);
    case Fault::OtherProduct:
      return "product " + hex_byte(refused.at) + " is " + other_product(refused.at) +
             ": only VLP-16 (22) and VLP-16 Hi-Res (24) are understood";
  }
  return "?";
}

std::array<std::uint8_t, kPacketSize> encode(const Packet& packet) noexcept {
  std::array<std::uint8_t, kPacketSize> out{};
  for (std::size_t b = 0; b < kBlocks; ++b) {
    std::uint8_t* at = out.data() + b * kBlockSize;
    at[0] = 0xFF;
    at[1] = 0xEE;
    put16(at + 2, packet.blocks[b].azimuth_cdeg);
    at += 4;
    for (const Return& r : packet.blocks[b].channels) {
      put16(at, r.distance);
      at[2] = r.reflectivity;
      at += 3;
    }
  }
  put32(out.data() + kStampAt, packet.stamp_us);
  out[kModeAt] = static_cast<std::uint8_t>(packet.mode);
  out[kProductAt] = static_cast<std::uint8_t>(packet.product);
  return out;
}

DecodedPosition decode_position(Bytes datagram) {
  DecodedPosition out;
  if (datagram.size() != kPositionSize) {
    out.fault = Fault::WrongSize;
    return out;
  }
  const std::uint32_t stamp_us = u32(datagram.data() + kPositionStampAt);
  if (stamp_us >= kHour_us) {
    out.fault = Fault::BadStamp;
    return out;
  }
  out.position.stamp_us = stamp_us;
  out.position.pps = datagram[kPpsAt];
  for (const std::uint8_t byte : datagram.subspan(kSentenceAt, kLongestSentence)) {
    if (byte < ' ' || byte > '~') break;
    out.position.nmea += static_cast<char>(byte);
  }
  if (!out.position.nmea.starts_with('$')) out.position.nmea.clear();
  return out;
}

std::array<std::uint8_t, kPositionSize> encode(const Position& position) noexcept {
  std::array<std::uint8_t, kPositionSize> out{};
  put32(out.data() + kPositionStampAt, position.stamp_us);
  out[kPpsAt] = position.pps;
  const std::size_t size = std::min(position.nmea.size(), kLongestSentence);
  std::copy_n(position.nmea.begin(), size, out.begin() + kSentenceAt);
  return out;
}

double height_m(Product product, std::size_t laser) noexcept {
  if (product != Product::Vlp16) return 0.0;
  // Of the lower eight rings, as the maker tells them; the upper ones mirror them.
  constexpr std::array kLower_mm{11.2, 9.7, 8.1, 6.6, 5.1, 3.7, 2.2, 0.7};
  const std::size_t ring = ring_of(laser);
  const double mm = ring < kLower_mm.size() ? kLower_mm[ring] : -kLower_mm[kLasers - 1 - ring];
  return mm * 1e-3;
}

Steps steps_of(const Packet& packet, std::uint16_t fallback_cdeg) noexcept {
  Steps out;
  const std::size_t together = packet.together();
  std::uint16_t before = 0;
  for (std::size_t b = 0; b < kBlocks; b += together) {
    std::uint16_t step = before;  // the last one goes on as the one before
    if (b + together < kBlocks) {
      const unsigned next = packet.blocks[b + together].azimuth_cdeg;
      step = static_cast<std::uint16_t>((next + kTurn_cdeg - packet.blocks[b].azimuth_cdeg) %
                                        kTurn_cdeg);
    }
    if (step == 0 || step > kLargestStep_cdeg) {
      step = fallback_cdeg;
      out.gap = true;
    }
    out.cdeg[b] = before = step;
  }
  return out;
}

}  // namespace roverd::velodyne
