#pragma once
// The fact sheet's UBX frames.

#include <cstdint>
#include <string_view>
#include <vector>

namespace roverd::ubx {

inline std::vector<std::uint8_t> from_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    out.push_back(static_cast<std::uint8_t>(digit(hex[i]) * 16 + digit(hex[i + 1])));
  }
  return out;
}

inline constexpr std::string_view kPvtFixed =
    "b56201075c0000420612ea0705140b3b2a371900000084ffffff0383ea1dffb5e0a5f50ad0eb91380100c8e300000e"
    "00"
    "000014000000e803000006ffffff0c0000000704000017e60f022800000040e2010062000400000000000000000000"
    "00"
    "0000e4d5";
inline constexpr std::string_view kPvtNoFix =
    "b56201075c00e8030000ea0701010000000014000000000000000000000000000000000000000000000000000000ff"
    "ff"
    "ffffffffffff0000000000000000000000000000000000000000204e000080a812010f270000000000000000000000"
    "00"
    "00002d72";
inline constexpr std::string_view kHpPosLlh =
    "b562011424000000000000420612ffb5e0a5f50ad0eb91380100c8e30000dd0704fa8a000000c70000002e87";
inline constexpr std::string_view kRelPosNed =
    "b562013c400001000000004206120c0000009dffffffffffffff640000005acea6010000000022eb05fe1500000016"
    "00"
    "00002b0000001e000000306f010000000000370100000982";
inline constexpr std::string_view kCov =
    "b5620136400000420612000100000000000000000000"
    "17b7d1390000000017b7d1b8faed6b3a6f12833917b7d13a0000000000000000000000000000000000000000000000"
    "00"
    "a381";
inline constexpr std::string_view kMonVerAnswer =
    "b5620a04a00045585420434f524520312e303020286131623263332900000000000000003030313930303030000052"
    "4f"
    "4d20424153452030783131384232303630000000000000000000000046575645523d48504720312e33320000000000"
    "00"
    "0000000000000000000050524f545645523d32372e333100000000000000000000000000000000004d4f443d5a4544"
    "2d"
    "463950000000000000000000000000000000000000000337";
inline constexpr std::string_view kMonVerPoll = "b5620a0400000e34";
inline constexpr std::string_view kAckAck = "b56205010200068a98c1";
inline constexpr std::string_view kAckNak = "b56205000200068a97bc";
inline constexpr std::string_view kAckDamaged = "b56205010200068a98c0";
inline constexpr std::string_view kValSetMessages =
    "b562068a240000010000070091200134009120018e00912001840091200101002130c8000200213001003839";
inline constexpr std::string_view kValSetPort =
    "b562068a11000007000004007310010100524000080700d221";

}  // namespace roverd::ubx
