#pragma once
// u-blox UBX frames out of a byte stream that carries other things too, and back.
//
//   0  1    2      3   4 5             6 … 5+N   6+N   7+N
//   B5 62   class  id  length N (LE)   payload   CK_A  CK_B
//
// CK is the 8-bit Fletcher sum over class, id, length and payload. After a wrong one the search
// goes on one byte after the first sync byte. Bytes of no frame are handed out as they are (NMEA,
// RTCM3). Pure state: no clock, no exceptions; bounded: what is kept between two calls is at most
// one frame.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/bytes.hpp"

namespace roverd::ubx {

using base::Bytes;

inline constexpr std::size_t kMaxPayload = 8192;
inline constexpr std::size_t kOverhead = 8;

/// Which message: class and id.
struct Key {
  std::uint8_t cls = 0;
  std::uint8_t id = 0;
  friend constexpr bool operator==(const Key&, const Key&) = default;
};

struct Frame {
  Key key;
  Bytes payload;  ///< valid until the framer is fed again
};

class Framer {
 public:
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t bad_checksum = 0;  ///< also false alarms inside other bytes
    std::uint64_t too_long = 0;      ///< a length beyond kMaxPayload, likewise
    std::uint64_t other_bytes = 0;
  };

  /// @param on_frame called with each intact Frame. @param on_other called with Bytes that are of
  /// no frame, in order with the frames.
  template <class OnFrame, class OnOther>
  void feed(Bytes bytes, OnFrame&& on_frame, OnOther&& on_other) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    drain(false, on_frame, on_other);
  }
  template <class OnFrame>
  void feed(Bytes bytes, OnFrame&& on_frame) {
    feed(bytes, on_frame, [](Bytes) {});
  }
  /// No more will come, or the frame that has begun takes too long to be one.
  template <class OnFrame, class OnOther>
  void give_up(OnFrame&& on_frame, OnOther&& on_other) {
    drain(true, on_frame, on_other);
  }
  void forget() noexcept { buffer_.clear(); }

  const Counts& counts() const noexcept { return counts_; }

 private:
  enum class Look { Frame, More, Other };
  /// @param at of buffer_. @param frame set, with its whole length, when there is one.
  Look look(std::size_t at, Frame& frame, std::size_t& length) noexcept;

  template <class OnFrame, class OnOther>
  void drain(bool last, OnFrame& on_frame, OnOther& on_other) {
    std::size_t at = 0;
    std::size_t other = 0;  // first byte not handed out
    const auto tell_other = [&] {
      if (at == other) return;
      counts_.other_bytes += at - other;
      on_other(Bytes(buffer_.data() + other, at - other));
    };
    while (at < buffer_.size()) {
      Frame frame;
      std::size_t length = 0;
      const Look seen = look(at, frame, length);
      if (seen == Look::More && !last) break;
      if (seen != Look::Frame) {
        ++at;
        continue;
      }
      tell_other();
      ++counts_.frames;
      on_frame(frame);
      other = at += length;
    }
    tell_other();
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::vector<std::uint8_t> buffer_;
  Counts counts_;
};

/// One whole frame. Empty: wrong sync, length or checksum.
bool is_intact(Bytes frame) noexcept;
/// @param frame intact.
Frame opened(Bytes frame) noexcept;
/// @param payload at most kMaxPayload bytes.
std::vector<std::uint8_t> encode(Key key, Bytes payload);

}  // namespace roverd::ubx
