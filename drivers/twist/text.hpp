#pragma once
// The text form: lines like NMEA 0183's, checksum XOR of what stands between '$' and '*'.
//
//   $RVC,<seq>,<speed_mps>,<turn_radps>,<enable 0|1>*HH\r\n
//   $RVF,<seq>,<ack>,<speed_mps>,<turn_radps>,<left_m>,<right_m>,<battery_v>,<status>,<estop>*HH\r\n
//
//   $RVC,7,0.500,-0.250,1*6E
//
// Pure.

#include <string>
#include <string_view>
#include <variant>

#include "base/bytes.hpp"
#include "twist/messages.hpp"

namespace roverd::twist {

using Said = std::variant<std::monostate, Command, Feedback>;

std::string encode_text(const Command& command);
std::string encode_text(const Feedback& feedback);
/// @param line from '$' on, without the line end. Damaged or unknown: monostate.
Said parse_text(std::string_view line) noexcept;

/// Lines out of bytes however they are cut. Everything outside $…\n is skipped.
class TextDecoder {
 public:
  template <class OnSaid>
  void feed(base::Bytes bytes, OnSaid&& on_said) {
    for (const std::uint8_t b : bytes) {
      if (b == '$') {
        if (size_ > 0) ++refused_;  // the line before never ended
        size_ = 0;
        line_[size_++] = '$';
      } else if (b == '\n') {
        const Said said = line_done();
        if (said.index() != 0) on_said(said);
      } else if (size_ > 0 && size_ < sizeof line_) {
        line_[size_++] = static_cast<char>(b);
      }
    }
  }
  void forget() noexcept { size_ = 0; }
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  Said line_done() noexcept;

  char line_[128]{};
  std::size_t size_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace roverd::twist
