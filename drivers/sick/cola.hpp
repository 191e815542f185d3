#pragma once
// How SICK scanners wrap what they say: the two dialects of CoLa over TCP.
//
//   CoLa A   02, text, 03                                      no length, no checksum
//   CoLa B   02 02 02 02, u32 length, body, XOR of the body    big endian
//
// Both bodies begin with the same words ("sSN LMDscandata "); what follows is text in one and
// binary in the other (fields.hpp). Which one it is is told by the bytes, telegram by telegram.
//
// A text ends early at the next 02, which begins a new one; a length over 64 kB or a wrong XOR is
// no telegram, and the next beginning is searched from the byte after its first. Memory is bounded
// by the longest telegram and the piece handed over; time is linear in the bytes but for texts cut
// by damage. Pure state.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"

namespace roverd::sick {

using base::Bytes;

enum class Dialect : std::uint8_t { A, B };
std::string_view to_string(Dialect d) noexcept;  // CoLa A, CoLa B
constexpr Dialect other(Dialect d) noexcept {
  return d == Dialect::A ? Dialect::B : Dialect::A;
}

inline constexpr std::size_t kMaxBody = 65'536;

/// Without its frame. The bytes are the framer's, until the sink returns.
struct Telegram {
  Dialect dialect = Dialect::A;
  Bytes body;
};

/// With its frame. @param body at most kMaxBody bytes; in A without 02 and 03.
std::vector<std::uint8_t> frame(Dialect dialect, Bytes body);

/// Bytes in pieces of any size to whole telegrams.
class Framer {
 public:
  struct Counts {
    std::uint64_t telegrams = 0;
    std::uint64_t bad_checksum = 0;
    std::uint64_t bad_length = 0;     ///< over 64 kB, or too short for words
    std::uint64_t cut = 0;            ///< a text that a new one or a stray byte ended
    std::uint64_t skipped_bytes = 0;  ///< in no telegram
  };

  template <class Sink>
  void feed(Bytes bytes, Sink&& sink) {
    append(bytes);
    while (const auto telegram = next()) sink(*telegram);
    drop_used();
  }
  /// What waits for its end will not get one: telegrams inside it are found.
  template <class Sink>
  void give_up(Sink&& sink) {
    while (waiting()) {
      skip(1);
      while (const auto telegram = next()) sink(*telegram);
    }
    drop_used();
  }
  void forget() noexcept;
  /// The beginning of a telegram is kept.
  bool waiting() const noexcept { return head_ < bytes_.size(); }
  const Counts& counts() const noexcept { return counts_; }
  /// Bytes since the beginning that are done with: in a sink, up to the telegram's end.
  std::uint64_t position() const noexcept { return dropped_ + head_; }

 private:
  enum class Look { Found, More, Again };
  void append(Bytes bytes);
  std::optional<Telegram> next();
  Look look_binary(Telegram& out);
  Look look_text(std::size_t run, Telegram& out);
  std::size_t run_of_stx() const noexcept;
  void skip(std::size_t n) noexcept;
  void drop_used();

  std::vector<std::uint8_t> bytes_;
  /// sums_[i] is the XOR of all bytes before bytes_[i]: a wrong beginning costs no second pass.
  std::vector<std::uint8_t> sums_{0};
  std::size_t head_ = 0;
  std::uint64_t dropped_ = 0;  ///< bytes before bytes_[0]
  std::size_t looked_ = 0;     ///< no end of the text at head_ before here
  Counts counts_;
};

}  // namespace roverd::sick
