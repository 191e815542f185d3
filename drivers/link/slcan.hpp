#pragma once
// The ASCII protocol of serial-line CAN adapters (LAWICEL, SLCAN), both ways. Pure.
//
//   t iii l dd…       standard data frame: 3 hex digits id, length 0..8, two hex digits a byte
//   T iiiiiiii l dd…  extended data frame
//   r iii l           remote frame, R iiiiiiii l extended; without the length it means 0
//
// Every line ends with CR; an adapter answers a command with CR, perhaps after a word, or refuses
// it with BEL. Hex digits of either case. Time stamps, which adapters can put behind a frame, are
// switched off (Z0): frames are stamped when they arrive, and a line of the wrong length is
// refused. The kernel's slcan and newer adapters add s (state and error counters) and e (bus
// errors).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"
#include "link/can_state.hpp"

namespace roverd::link {

inline constexpr unsigned kSlcanDefaultBitrate = 500'000;

/// The digit of the S command: 6 for 500 000 bit/s. Nothing for a rate that has none.
std::optional<char> slcan_speed(unsigned bitrate) noexcept;

/// With its CR. @param frame valid (can_wire.hpp) and no error frame.
std::string to_slcan_line(const base::CanFrame& frame);

/// One thing the adapter said.
struct SlcanLine {
  enum class Kind {
    Done,     ///< CR, z or Z: the oldest command was carried out
    Refused,  ///< BEL
    Frame,
    Flags,   ///< F: status
    State,   ///< s
    Errors,  ///< e: bus errors, letters in `text`
    Other,   ///< an answer nobody asked for: version, serial number
  };
  Kind kind = Kind::Done;
  base::CanFrame frame{};
  std::uint8_t flags = 0;
  CanController controller = CanController::ErrorActive;
  std::uint16_t rx_errors = 0;
  std::uint16_t tx_errors = 0;
  std::string text{};
};

/// @param line without its CR. Malformed, with the reason in words, for what is no line of an
/// adapter: wrong length, bad digit, id too large.
base::Result<SlcanLine> parse_slcan_line(std::string_view line);

/// Words for the bits of Flags: "receive queue full, bus error"; empty for none.
std::string slcan_flag_words(std::uint8_t flags);

/// Cuts the stream into lines. A line that grows too long is dropped up to its end, and counted.
class SlcanFramer {
 public:
  static constexpr std::size_t kLongestLine = 32;

  struct Piece {
    bool refused = false;  ///< BEL; `line` is then what stood before it, of no use
    bool too_long = false;
    std::string line;  ///< without CR
  };
  /// Appends what is complete. Line feeds are ignored.
  void feed(base::Bytes bytes, std::vector<Piece>& out);
  void reset() noexcept;

 private:
  std::string line_;
  bool too_long_ = false;
};

}  // namespace roverd::link
