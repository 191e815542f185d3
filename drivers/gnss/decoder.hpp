#pragma once
// A receiver's bytes to typed sentences and UBX messages, every one of them accounted for.

#include <array>
#include <cstdint>
#include <type_traits>

#include "gnss/framer.hpp"
#include "gnss/nmea.hpp"
#include "ubx/messages.hpp"

namespace roverd::gnss {

/// used + unused + unknown + damaged is the number of '$' that began a sentence.
struct SentenceCounts {
  std::uint64_t used = 0;
  std::uint64_t unused = 0;
  std::uint64_t unknown = 0;
  std::uint64_t damaged = 0;
  std::array<std::uint64_t, kFlaws> by_flaw{};  ///< of the damaged ones, by Flaw
  std::uint64_t ubx = 0;                        ///< binary frames with a right checksum
  std::uint64_t rtcm3 = 0;
  std::uint64_t ubx_used = 0;     ///< of ubx: decoded
  std::uint64_t ubx_refused = 0;  ///< of ubx: too short, of an unknown version, out of range

  std::uint64_t intact() const noexcept { return used + unused + unknown; }
};

/// Not thread-safe; no clock.
class Decoder {
 public:
  /// Calls sink(const Sentence&, Time first_byte) for each decoded sentence, in order; and, if the
  /// sink takes that, sink(const ubx::Message&, Time first_byte) for each UBX message.
  template <class Sink>
  void feed(Bytes bytes, Time now, Sink&& sink) {
    framer_.feed(bytes, now, [&](const Cut& cut) { take(cut, sink); });
  }
  /// See Framer::give_up.
  template <class Sink>
  void give_up(Time then, Sink&& sink) {
    framer_.give_up(then, [&](const Cut& cut) { take(cut, sink); });
  }

  /// See Framer::forget.
  void forget() noexcept { framer_.forget(); }

  const SentenceCounts& counts() const noexcept { return counts_; }
  const Framer::Counts& framing() const noexcept { return framer_.counts(); }

 private:
  template <class Sink>
  void take(const Cut& cut, Sink&& sink) {
    switch (cut.piece) {
      case Piece::Line:
        break;
      case Piece::Broken:
        return damaged(cut.flaw);
      case Piece::Ubx:
        return take_ubx(cut, sink);
      case Piece::Rtcm3:
        ++counts_.rtcm3;
        return;
    }
    const Parsed parsed = parse_line(cut.text);
    switch (parsed.kind) {
      case Kind::Used:
        ++counts_.used;
        sink(parsed.sentence, cut.stamp);
        return;
      case Kind::Unused:
        ++counts_.unused;
        return;
      case Kind::Unknown:
        ++counts_.unknown;
        return;
      case Kind::Damaged:
        return damaged(parsed.flaw);
    }
  }
  template <class Sink>
  void take_ubx(const Cut& cut, Sink&& sink) {
    ++counts_.ubx;
    if constexpr (std::is_invocable_v<Sink&, const ubx::Message&, Time>) {
      const ubx::Decoded decoded = ubx::decode(ubx::opened(cut.bytes));
      if (decoded.verdict == ubx::Verdict::Decoded) {
        ++counts_.ubx_used;
        sink(decoded.message, cut.stamp);
      } else if (decoded.verdict != ubx::Verdict::NotOurs) {
        ++counts_.ubx_refused;
      }
    }
  }
  void damaged(Flaw flaw) noexcept {
    ++counts_.damaged;
    ++counts_.by_flaw[static_cast<std::size_t>(flaw)];
  }

  Framer framer_;
  SentenceCounts counts_{};
};

}  // namespace roverd::gnss
