#pragma once
// RTCM 3 frames out of a byte stream; what they say is the receiver's business.
//
//   D3   000000 and N (10 bits)   payload, N bytes; its first 12 bits are the message's number CRC
//
// After a wrong CRC-24Q the search goes on one byte after the false D3. Pure state: no clock;
// bounded: what is kept between two calls is less than one frame.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/bytes.hpp"

namespace roverd::rtcm {

using base::Bytes;

inline constexpr std::size_t kMaxFrame = 1023 + 6;

/// One whole frame with its number; 0: a filler without payload.
struct Frame {
  int number = 0;
  Bytes bytes;  ///< valid until the framer is fed again
};

class Framer {
 public:
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t bad_crc = 0;  ///< also false alarms inside other bytes
    std::uint64_t other_bytes = 0;
  };

  /// Calls on_frame(const Frame&) for each intact one.
  template <class OnFrame>
  void feed(Bytes bytes, OnFrame&& on_frame) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    drain(false, on_frame);
  }
  /// The frame that has begun takes too long to be one.
  template <class OnFrame>
  void give_up(OnFrame&& on_frame) {
    drain(true, on_frame);
  }
  void forget() noexcept { buffer_.clear(); }
  bool waiting() const noexcept { return !buffer_.empty(); }

  const Counts& counts() const noexcept { return counts_; }

 private:
  enum class Look { Frame, More, Other };
  Look look(std::size_t at, Frame& frame) noexcept;

  template <class OnFrame>
  void drain(bool last, OnFrame& on_frame) {
    std::size_t at = 0;
    while (at < buffer_.size()) {
      Frame frame;
      const Look seen = look(at, frame);
      if (seen == Look::More && !last) break;
      if (seen == Look::Frame) {
        ++counts_.frames;
        on_frame(static_cast<const Frame&>(frame));
        at += frame.bytes.size();
      } else {
        ++counts_.other_bytes;
        ++at;
      }
    }
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::vector<std::uint8_t> buffer_;
  Counts counts_;
};

}  // namespace roverd::rtcm
