#pragma once
// RTCM 2 as a reference station writes it, from the standard: bit by bit, apart from the decoder.

#include <string>
#include <vector>

namespace roverd::rtcm {

class Rtcm2Writer {
 public:
  /// One message: its header's two words, then `words` of 24 bits of data.
  void message(unsigned type, unsigned station, const std::vector<unsigned>& words) {
    word(0x66U << 16U | (type & 0x3FU) << 10U | (station & 0x3FFU));
    const auto count = static_cast<unsigned>(words.size());
    word((z_++ & 0x1FFFU) << 11U | (sequence_++ & 7U) << 8U | (count & 0x1FU) << 3U | 2U);
    for (const unsigned w : words) word(w);
  }
  /// What was written, six bits a byte, the lowest first. @param begin bits that are left out.
  std::string bytes(std::size_t begin = 0) const {
    std::string out;
    for (std::size_t at = begin; at + 6 <= bits_.size(); at += 6) {
      unsigned byte = 0x40;
      for (std::size_t i = 0; i < 6; ++i) byte |= static_cast<unsigned>(bits_[at + i]) << i;
      out += static_cast<char>(byte);
    }
    return out;
  }

 private:
  void word(unsigned data) {
    // d[1] … d[24], D29* and D30* of the word before; D = what is sent.
    std::vector<int> d(25);
    for (int i = 1; i <= 24; ++i)
      d[static_cast<std::size_t>(i)] = static_cast<int>(data >> (24 - i) & 1U);
    const int d29 = last_but_one_;
    const int d30 = last_;
    for (std::size_t i = 1; i <= 24; ++i) bits_.push_back(d[i] ^ d30);
    const auto x = [&d](int from, std::initializer_list<std::size_t> of) {
      for (const std::size_t i : of) from ^= d[i];
      return from;
    };
    const int parity[6] = {x(d29, {1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 17, 18, 20, 23}),
                           x(d30, {2, 3, 4, 6, 7, 11, 12, 13, 14, 15, 18, 19, 21, 24}),
                           x(d29, {1, 3, 4, 5, 7, 8, 12, 13, 14, 15, 16, 19, 20, 22}),
                           x(d30, {2, 4, 5, 6, 8, 9, 13, 14, 15, 16, 17, 20, 21, 23}),
                           x(d30, {1, 3, 5, 6, 7, 9, 10, 14, 15, 16, 17, 18, 21, 22, 24}),
                           x(d29, {3, 5, 6, 8, 9, 10, 11, 13, 15, 19, 22, 23, 24})};
    for (const int p : parity) bits_.push_back(p);
    last_but_one_ = parity[4];
    last_ = parity[5];
  }

  std::vector<int> bits_;
  int last_but_one_ = 0;
  int last_ = 0;
  unsigned z_ = 1234;
  unsigned sequence_ = 0;
};

}  // namespace roverd::rtcm
