#pragma once
// Packets for tests, written by the rule of the fact sheet's test vectors.

#include <cstdint>
#include <utility>
#include <vector>

#include "velodyne/codec.hpp"

namespace roverd::velodyne {

struct Rule {
  unsigned azimuth0 = 0;
  unsigned step = 40;
  unsigned base = 0;
  unsigned per_block = 0;
  unsigned per_channel = 0;
  unsigned refl_base = 0;
  unsigned refl_per_block = 0;
  unsigned refl_per_channel = 0;
  std::vector<std::pair<std::size_t, std::size_t>> zero{};
};

inline Packet packet_of(const Rule& rule, std::uint32_t stamp_us,
                        ReturnMode mode = ReturnMode::Strongest) {
  Packet p;
  p.stamp_us = stamp_us;
  p.mode = mode;
  for (unsigned b = 0; b < kBlocks; ++b) {
    p.blocks[b].azimuth_cdeg =
        static_cast<std::uint16_t>((rule.azimuth0 + b * rule.step) % kTurn_cdeg);
    for (unsigned c = 0; c < kChannels; ++c) {
      p.blocks[b].channels[c] = {
          static_cast<std::uint16_t>(rule.base + rule.per_block * b + rule.per_channel * c),
          static_cast<std::uint8_t>(rule.refl_base + rule.refl_per_block * b +
                                    rule.refl_per_channel * c)};
    }
  }
  for (const auto& [block, channel] : rule.zero) p.blocks[block].channels[channel].distance = 0;
  return p;
}

/// Vector A: single return, 600 rpm.
inline Packet vector_a() {
  return packet_of({.azimuth0 = 4500,
                    .step = 40,
                    .base = 2500,
                    .per_block = 10,
                    .per_channel = 100,
                    .refl_base = 10,
                    .refl_per_block = 1,
                    .refl_per_channel = 2},
                   1'234'567);
}
/// Vector B: through 360 deg, some misses, the last millisecond of an hour.
inline Packet vector_b() {
  return packet_of({.azimuth0 = 35960,
                    .step = 20,
                    .base = 10000,
                    .per_channel = 7,
                    .refl_base = 200,
                    .refl_per_channel = 3,
                    .zero = {{0, 0}, {5, 17}, {11, 31}}},
                   3'599'999'000);
}

/// A head that turns at 600 rpm and sees a wall at the same range all around.
class Head {
 public:
  explicit Head(unsigned distance = 5000, ReturnMode mode = ReturnMode::Strongest)
      : distance_(distance), mode_(mode) {}
  std::uint32_t stamp_us = 1'000'000;
  unsigned azimuth_cdeg = 0;

  Packet next() {
    Packet p =
        packet_of({.azimuth0 = azimuth_cdeg, .step = 40, .base = distance_}, stamp_us, mode_);
    azimuth_cdeg = (azimuth_cdeg + 480) % kTurn_cdeg;
    parts_ += 104;  // 1327.104 us
    stamp_us = (stamp_us + 1327 + parts_ / 1000) % kHour_us;
    parts_ %= 1000;
    return p;
  }

 private:
  unsigned distance_;
  ReturnMode mode_;
  std::uint32_t parts_ = 0;
};

}  // namespace roverd::velodyne
