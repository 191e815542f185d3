#pragma once
// Contact switches behind a microcontroller on USB serial, 115200 baud. It sends a line at every
// change and at least five times a second:
//
//   B,<mask>*<CS>\r\n      mask: decimal 0..255, one bit a switch; CS: two hexadecimal digits, XOR
//                          of all bytes before the '*'
//
//   bit 0 front left   1 front   2 front right   3 left   4 right   5 rear left   6 rear
//   bit 7 rear right
//
// Examples: B,0*5E nothing pressed; B,1*5F front left.
// Device side: mask as wired, print, XOR, done; neither latching nor debouncing is asked of it.

#include <cstdint>
#include <string>
#include <string_view>

#include "base/bytes.hpp"

namespace roverd::bumper {

/// Feeds on bytes however they are cut; an unfinished line waits, an endless one is dropped.
class Decoder {
 public:
  /// @param on_mask called with the mask of each intact line.
  template <class OnMask>
  void feed(base::Bytes bytes, OnMask&& on_mask) {
    for (const std::uint8_t b : bytes) {
      if (b == '\n') {
        if (const int mask = line_done(); mask >= 0) on_mask(static_cast<std::uint8_t>(mask));
      } else if (size_ < sizeof line_) {
        line_[size_++] = static_cast<char>(b);
      } else {
        too_long_ = true;
      }
    }
  }
  void forget() noexcept {
    size_ = 0;
    too_long_ = false;
  }
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  int line_done() noexcept;

  char line_[16]{};
  std::size_t size_ = 0;
  bool too_long_ = false;
  std::uint64_t refused_ = 0;
};

/// @return the mask, or −1. @param line without the line end.
int parse(std::string_view line) noexcept;
/// With the line end.
std::string encode(std::uint8_t mask);
/// "front left, rear"; empty when nothing is pressed.
std::string where(std::uint8_t mask);

}  // namespace roverd::bumper
