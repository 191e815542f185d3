#pragma once
// Cuts one receiver's byte stream into NMEA lines and binary frames. A port carries NMEA, UBX and
// RTCM3 mixed; the first byte tells which: '$', B5 62 or D3.
//
//   '$' …… CR or LF     a line; NUL bytes inside are skipped; another '$' restarts there
//   B5 62 … checksum    a UBX frame, up to 8192 bytes of payload
//   D3 … CRC-24Q        an RTCM3 frame, up to 1023 bytes
//
// A binary frame whose checksum is right owns all its bytes, '$' among them. If it is wrong, the
// search goes on one byte after its first. All else is skipped and counted. Any bytes may come in.
// Bounded: what is kept between two calls fits kCapacity. Not thread-safe; no clock, no exceptions.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/bytes.hpp"
#include "base/time.hpp"
#include "gnss/nmea.hpp"

namespace roverd::gnss {

using base::Time;

enum class Piece {
  Line,    ///< text: after '$', without line end
  Broken,  ///< text: as far as it went; flaw says why
  Ubx,     ///< bytes: the whole frame
  Rtcm3,   ///< bytes: the whole frame
};

struct Cut {
  Piece piece = Piece::Line;
  Flaw flaw = Flaw::None;
  std::string_view text{};  ///< valid until the next piece is cut
  Bytes bytes{};
  Time stamp{};           ///< arrival of the piece's first byte
  std::uint64_t end = 0;  ///< bytes of the stream up to its end; a line's end is not in it
};

class Framer {
 public:
  static constexpr std::size_t kCapacity = 16384;
  static constexpr std::size_t kMaxUbxPayload = 8192;

  struct Counts {
    std::uint64_t skipped_bytes = 0;  ///< outside any piece; line ends are not counted
    std::uint64_t broken_binary = 0;  ///< frames with a wrong checksum (also false alarms)
    std::uint64_t bytes = 0;          ///< all that came in
  };

  /// Calls sink(const Cut&) for each piece that is complete, in order.
  template <class Sink>
  void feed(Bytes bytes, Time now, Sink&& sink) {
    while (!bytes.empty()) {
      bytes = bytes.subspan(take(bytes, now));
      for (Cut cut; next(cut);) sink(cut);
    }
  }

  /// What looks like the beginning of a binary frame can hold back lines behind it. If its first
  /// byte came at `then` or before, it was none: skip it and cut on.
  template <class Sink>
  void give_up(Time then, Sink&& sink) {
    while (stalled_since(then)) {
      skip_first();
      for (Cut cut; next(cut);) sink(cut);
    }
  }

  /// What has begun will not go on: the line speaks differently from now on.
  void forget() noexcept {
    counts_.skipped_bytes += waiting();
    at_ = end_;
    scanned_ = 0;
    nul_ = false;
  }

  const Counts& counts() const noexcept { return counts_; }
  /// Bytes of the stream that are cut or skipped.
  std::uint64_t position() const noexcept { return dropped_ + at_; }

 private:
  enum class Look { Cut, More, Skip };

  std::size_t take(Bytes bytes, Time now) noexcept;
  bool next(Cut& cut) noexcept;
  Look look_line(Cut& cut) noexcept;
  Look look_ubx(Cut& cut) noexcept;
  Look look_rtcm3(Cut& cut) noexcept;
  Look look_binary(std::size_t total, bool good, Piece piece, Cut& cut) noexcept;
  void finish_line(std::size_t stop, Flaw flaw, Cut& cut) noexcept;
  void compact() noexcept;
  bool stalled_since(Time then) const noexcept;
  void skip_first() noexcept;
  Time stamp_of(std::size_t at) const noexcept;
  std::size_t waiting() const noexcept { return end_ - at_; }

  /// Bytes up to `end` (exclusive, since the beginning of the stream) came at `stamp`.
  struct Mark {
    std::uint64_t end = 0;
    Time stamp{};
  };

  std::array<std::uint8_t, kCapacity> buffer_{};
  std::size_t at_ = 0;         ///< first byte not yet cut
  std::size_t end_ = 0;        ///< behind the last byte
  std::size_t scanned_ = 0;    ///< of a line that is not complete: how far it was searched
  bool nul_ = false;           ///< a NUL is inside it
  std::uint64_t dropped_ = 0;  ///< stream position of buffer_[0]
  std::array<Mark, 64> marks_{};
  std::size_t mark_count_ = 0;
  std::array<char, kMaxLine> line_{};  ///< a line without its NULs
  Counts counts_{};
};

}  // namespace roverd::gnss
