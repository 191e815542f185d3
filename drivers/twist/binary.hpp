#pragma once
// The binary form, all numbers little-endian as small boards are:
//
//   0   1   2     3     4 …            4+len, 5+len
//   A5  5A  type  len   payload        CRC-16/CCITT-FALSE of type, len and payload
//
//   type 1, command, 6 bytes:    u8 seq, i16 speed mm/s, i16 turn mrad/s, u8 flags (bit 0 enable)
//   type 2, feedback, 18 bytes:  u8 seq, u8 ack, i16 speed mm/s, i16 turn mrad/s, i32 left mm,
//                                i32 right mm, u16 battery 10 mV, u8 status, u8 estop
//
// CRC: polynomial 0x1021, start 0xFFFF, not reflected; "123456789" gives 0x29B1. Pure.

#include <array>
#include <cstdint>
#include <vector>

#include "base/bytes.hpp"
#include "twist/text.hpp"

namespace roverd::twist {

std::uint16_t crc16(base::Bytes bytes) noexcept;
/// Values beyond what the wire holds are cut to it; NaN is sent as 0.
std::vector<std::uint8_t> encode_binary(const Command& command);
std::vector<std::uint8_t> encode_binary(const Feedback& feedback);

/// Frames out of bytes however they are cut. After a damaged frame the search goes on at the next
/// byte, so that a good frame inside a damaged one is found.
class BinaryDecoder {
 public:
  template <class OnSaid>
  void feed(base::Bytes bytes, OnSaid&& on_said) {
    for (const std::uint8_t b : bytes) {
      buffer_[size_++] = b;
      while (size_ > 0) {
        Said said;
        const Step step = look(said);
        if (said.index() != 0) on_said(said);
        if (step == Step::Wait) break;
      }
    }
  }
  void forget() noexcept { size_ = 0; }
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  enum class Step { Wait, Again };
  Step look(Said& said) noexcept;
  void drop(std::size_t count) noexcept;

  std::array<std::uint8_t, 32> buffer_{};  ///< the longest frame has 24 bytes
  std::size_t size_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace roverd::twist
