#pragma once
// Notices RTCM 2 (10402.x), which is another language than RTCM 3: no byte of it is of use here,
// but a user who chose such a mountpoint must be told.
//
//   bytes   01xxxxxx, six bits each, the lowest first; others are no part of it
//   words   30 bits: 24 of data (inverted after a word that ended in 1), 6 of parity over them and
//           the last two bits of the word before, as in a GPS subframe
//   frame   a word with 0x66, message type (6 bits), station (10); a word with time, sequence,
//           length N, health; N words of data
//
// Pure state; bounded.

#include <cstdint>

#include "base/bytes.hpp"

namespace roverd::rtcm {

class Rtcm2Ear {
 public:
  /// So many words with right parity in a row, the first of them a frame's, are no accident.
  static constexpr int kSure = 6;

  void feed(base::Bytes bytes) noexcept;
  bool sure() const noexcept { return sure_; }
  void forget() noexcept { *this = {}; }

 private:
  void take(unsigned bit) noexcept;

  std::uint32_t shift_ = 0;  ///< the last two bits of the word before, then the word
  int bits_ = 0;             ///< of the word, once in step
  int words_ = 0;            ///< in a row; 0: not in step
  bool sure_ = false;
};

/// @param word as in Rtcm2Ear: two bits of the word before, 24 of data as sent, 6 of parity.
bool rtcm2_parity_is_right(std::uint32_t word) noexcept;

}  // namespace roverd::rtcm
