#include "twist/binary.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::twist {
namespace {

constexpr std::uint8_t kSync0 = 0xA5;
constexpr std::uint8_t kSync1 = 0x5A;
constexpr std::uint8_t kCommand = 1;
constexpr std::uint8_t kFeedback = 2;
constexpr std::size_t kCommandLength = 6;
constexpr std::size_t kFeedbackLength = 18;
constexpr std::size_t kAround = 6;  ///< bytes of a frame beside its payload

class Writer {
 public:
  explicit Writer(std::uint8_t type, std::size_t length)
      : out_{kSync0, kSync1, type, static_cast<std::uint8_t>(length)} {}

  void u8(unsigned value) { out_.push_back(static_cast<std::uint8_t>(value)); }
  void number(double value, double min, double max, int bytes) {
    const double cut = std::isnan(value) ? 0.0 : std::clamp(value, min, max);
    const auto bits = static_cast<std::uint64_t>(std::llround(cut));
    for (int i = 0; i < bytes; ++i) u8(static_cast<unsigned>(bits >> (8 * i) & 0xFFU));
  }
  void i16(double value) { number(value, -32768.0, 32767.0, 2); }
  void i32(double value) { number(value, -2147483648.0, 2147483647.0, 4); }
  void u16(double value) { number(value, 0.0, 65535.0, 2); }
  std::vector<std::uint8_t> sealed() {
    const std::uint16_t crc = crc16(base::Bytes(out_).subspan(2));
    u8(crc & 0xFFU);
    u8(crc >> 8U);
    return std::move(out_);
  }

 private:
  std::vector<std::uint8_t> out_;
};

std::uint32_t raw(const std::uint8_t* p, int bytes) noexcept {
  std::uint32_t bits = 0;
  for (int i = 0; i < bytes; ++i) bits |= static_cast<std::uint32_t>(p[i]) << (8 * i);
  return bits;
}
double i16(const std::uint8_t* p) noexcept {
  return static_cast<std::int16_t>(raw(p, 2));
}
double i32(const std::uint8_t* p) noexcept {
  return static_cast<std::int32_t>(raw(p, 4));
}

std::size_t length_of(std::uint8_t type) noexcept {
  return type == kCommand ? kCommandLength : type == kFeedback ? kFeedbackLength : 0;
}

/// @param p the payload. Empty: flags that nobody defined.
Said payload(std::uint8_t type, const std::uint8_t* p) noexcept {
  if (type == kCommand) {
    if (p[5] > 1) return {};
    return Command{p[0], i16(p + 1) / 1e3, i16(p + 3) / 1e3, p[5] == 1};
  }
  if (p[17] > 1) return {};
  return Feedback{p[0],
                  p[1],
                  i16(p + 2) / 1e3,
                  i16(p + 4) / 1e3,
                  i32(p + 6) / 1e3,
                  i32(p + 10) / 1e3,
                  raw(p + 14, 2) / 1e2,
                  p[16],
                  p[17] == 1};
}

}  // namespace

std::uint16_t crc16(base::Bytes bytes) noexcept {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t b : bytes) {
    crc ^= static_cast<unsigned>(b) << 8U;
    for (int i = 0; i < 8; ++i) crc = (crc & 0x8000U) != 0 ? crc << 1U ^ 0x1021U : crc << 1U;
    crc &= 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

std::vector<std::uint8_t> encode_binary(const Command& c) {
  Writer out(kCommand, kCommandLength);
  out.u8(c.seq);
  out.i16(c.speed_mps * 1e3);
  out.i16(c.turn_radps * 1e3);
  out.u8(c.enable ? 1 : 0);
  return out.sealed();
}

std::vector<std::uint8_t> encode_binary(const Feedback& f) {
  Writer out(kFeedback, kFeedbackLength);
  out.u8(f.seq);
  out.u8(f.ack);
  out.i16(f.speed_mps * 1e3);
  out.i16(f.turn_radps * 1e3);
  out.i32(f.left_m * 1e3);
  out.i32(f.right_m * 1e3);
  out.u16(f.battery_v * 1e2);
  out.u8(f.status);
  out.u8(f.estop ? 1 : 0);
  return out.sealed();
}

void BinaryDecoder::drop(std::size_t count) noexcept {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(count),
            buffer_.begin() + static_cast<std::ptrdiff_t>(size_), buffer_.begin());
  size_ -= count;
}

BinaryDecoder::Step BinaryDecoder::look(Said& said) noexcept {
  if (buffer_[0] != kSync0 || (size_ > 1 && buffer_[1] != kSync1)) {
    drop(1);
    return Step::Again;
  }
  if (size_ < 4) return Step::Wait;
  const std::size_t length = length_of(buffer_[2]);
  if (length == 0 || buffer_[3] != length) {
    ++refused_;
    drop(1);
    return Step::Again;
  }
  if (size_ < length + kAround) return Step::Wait;
  const std::uint16_t crc = crc16({buffer_.data() + 2, length + 2});
  if (raw(buffer_.data() + 4 + length, 2) == crc) {
    said = payload(buffer_[2], buffer_.data() + 4);
  }
  if (said.index() == 0) ++refused_;
  drop(said.index() == 0 ? 1 : length + kAround);
  return Step::Again;
}

}  // namespace roverd::twist
