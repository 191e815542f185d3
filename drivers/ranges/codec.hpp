#pragma once
// Lines of text from ultrasonic and infrared rangers behind a microcontroller: one range a line, or
// several, in a fixed order. Lines end with CR, LF or both, at most kLongestLine bytes. Pure.
//
//   1.234            R1234                 Distance: 123 cm        d=1.20
//   R 1.20 0.85 - 2.00*6D                  $SONAR,120,85,oor,200*3F
//
// separators    blank, tab, comma, semicolon, bar, slash, brackets
// label         what ends with ':' or '='; letters before a number; words that say nothing else
// number        in the unit that is set, or as it says itself: mm, cm, m, in
// nothing seen  - -- --- oor out none no far max timeout, >4.00 (farther than)
// refused       0, below 0, nan, inf, err, error, x, ?; that range is unknown, the others count
// *HH           two hexadecimal digits, XOR of all bytes before the '*' without a leading '$';
// where
//               a line has it, it must be right
//
// <0.02 (nearer than) is a range of 0.02. A line with anything else is refused as a whole.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"

namespace roverd::ranges {

using base::Bytes;

inline constexpr std::size_t kMostRanges = 16;
inline constexpr std::size_t kLongestLine = 256;

enum class Outcome : std::uint8_t { Range, Nothing, Refused };
struct Reading {
  Outcome outcome = Outcome::Refused;
  double range_m = 0.0;  ///< positive and finite for Range, 0 otherwise
  friend bool operator==(const Reading&, const Reading&) = default;
};

struct Line {
  const char* fault = nullptr;  ///< null: understood
  std::vector<Reading> readings{};
};
/// @param line without its end. @param unit_m of a bare number: 1, 0.01, 0.001.
Line parse(std::string_view line, double unit_m);

/// "R 1.200 - 0.850*51\r\n", metres; empty: nothing seen.
std::string encode(const std::vector<std::optional<double>>& ranges_m);

/// Lines out of bytes however they are cut. Bounded.
class Lines {
 public:
  /// @param on_line std::string_view, not empty. @param on_too_long called once for each.
  template <class OnLine, class OnTooLong>
  void feed(Bytes bytes, OnLine&& on_line, OnTooLong&& on_too_long) {
    for (const std::uint8_t b : bytes) {
      if (b != '\n' && b != '\r') {
        if (size_ < line_.size()) line_[size_] = static_cast<char>(b);
        ++size_;
        continue;
      }
      if (size_ > line_.size()) {
        on_too_long();
      } else if (size_ > 0) {
        on_line(std::string_view(line_.data(), size_));
      }
      size_ = 0;
    }
  }
  void forget() noexcept { size_ = 0; }

 private:
  std::array<char, kLongestLine> line_{};
  std::uint64_t size_ = 0;  ///< may be more than is kept
};

}  // namespace roverd::ranges
