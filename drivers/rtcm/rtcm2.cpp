#include "rtcm/rtcm2.hpp"

#include <array>
#include <bit>
#include <initializer_list>

namespace roverd::rtcm {
namespace {

constexpr std::uint32_t kPreamble = 0x66;
constexpr int kWordBits = 30;

/// Mask over data bits 1 (first sent) to 24, which stand in bits 23 to 0.
constexpr std::uint32_t of(std::initializer_list<int> bits) noexcept {
  std::uint32_t mask = 0;
  for (const int bit : bits) mask |= 1U << (24 - bit);
  return mask;
}

struct Equation {
  bool last;  ///< begins with the last bit of the word before, else with the last but one
  std::uint32_t data;
};
/// Parity bits 25 to 30 (IS-GPS-200, table 20-XIV).
constexpr std::array kParity{
    Equation{false, of({1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 17, 18, 20, 23})},
    Equation{true, of({2, 3, 4, 6, 7, 11, 12, 13, 14, 15, 18, 19, 21, 24})},
    Equation{false, of({1, 3, 4, 5, 7, 8, 12, 13, 14, 15, 16, 19, 20, 22})},
    Equation{true, of({2, 4, 5, 6, 8, 9, 13, 14, 15, 16, 17, 20, 21, 23})},
    Equation{true, of({1, 3, 5, 6, 7, 9, 10, 14, 15, 16, 17, 18, 21, 22, 24})},
    Equation{false, of({3, 5, 6, 8, 9, 10, 11, 13, 15, 19, 22, 23, 24})}};

std::uint32_t data_of(std::uint32_t word) noexcept {
  const std::uint32_t sent = word >> 6U & 0xFF'FFFFU;
  return (word >> 30U & 1U) != 0 ? sent ^ 0xFF'FFFFU : sent;
}

}  // namespace

bool rtcm2_parity_is_right(std::uint32_t word) noexcept {
  const std::uint32_t data = data_of(word);
  std::uint32_t parity = 0;
  for (const Equation& e : kParity) {
    const std::uint32_t before = word >> (e.last ? 30U : 31U) & 1U;
    const auto ones = static_cast<std::uint32_t>(std::popcount(data & e.data));
    parity = parity << 1U | ((before + ones) & 1U);
  }
  return parity == (word & 0x3FU);
}

void Rtcm2Ear::feed(base::Bytes bytes) noexcept {
  for (const std::uint8_t byte : bytes) {
    if ((byte & 0xC0U) != 0x40U) continue;
    for (unsigned i = 0; i < 6; ++i) take(byte >> i & 1U);
  }
}

void Rtcm2Ear::take(unsigned bit) noexcept {
  shift_ = shift_ << 1U | bit;
  if (words_ == 0) {
    if (data_of(shift_) >> 16U != kPreamble || !rtcm2_parity_is_right(shift_)) return;
    words_ = 1;
    bits_ = 0;
    return;
  }
  if (++bits_ < kWordBits) return;
  bits_ = 0;
  words_ = rtcm2_parity_is_right(shift_) ? words_ + 1 : 0;
  if (words_ >= kSure) {
    words_ = kSure;
    sure_ = true;
  }
}

}  // namespace roverd::rtcm
