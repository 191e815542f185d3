#pragma once
// Xsens Xbus messages out of a byte stream, and back.
//
//   FA   bus id   MID   N              data (N bytes, big endian)   checksum
//   FA   bus id   MID   FF   N (u16)   data                         checksum
//
// All bytes but the first, checksum included, add up to 0 modulo 256. Bus id FF is a device alone,
// 01 the first behind a master; others are no message. After a wrong checksum the search goes on
// one byte after the rejected FA. Pure state: no clock; what is kept between two calls is at most
// one message.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "base/bytes.hpp"

namespace roverd::mti {

using base::Bytes;

inline constexpr std::size_t kMaxPayload = 2048;

namespace mid {
inline constexpr std::uint8_t kReqDid = 0x00;
inline constexpr std::uint8_t kDeviceId = 0x01;
inline constexpr std::uint8_t kGoToMeasurement = 0x10;
inline constexpr std::uint8_t kFirmware = 0x13;
inline constexpr std::uint8_t kProductCode = 0x1D;
inline constexpr std::uint8_t kGoToConfig = 0x30;
inline constexpr std::uint8_t kMtData = 0x32;
inline constexpr std::uint8_t kMtData2 = 0x36;
inline constexpr std::uint8_t kWakeUp = 0x3E;
inline constexpr std::uint8_t kError = 0x42;
inline constexpr std::uint8_t kSetOutput = 0xC0;
inline constexpr std::uint8_t kSetOutputAck = 0xC1;
}  // namespace mid

struct Message {
  std::uint8_t bus = 0xFF;
  std::uint8_t mid = 0;
  Bytes payload;  ///< valid until the framer is fed again
};

class Framer {
 public:
  struct Counts {
    std::uint64_t messages = 0;
    std::uint64_t bad_checksum = 0;  ///< also false alarms inside other bytes
    std::uint64_t too_long = 0;      ///< likewise
    std::uint64_t skipped_bytes = 0;
  };

  /// Calls on_message(const Message&) for each intact one.
  template <class OnMessage>
  void feed(Bytes bytes, OnMessage&& on_message) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    drain(false, on_message);
  }
  /// No more will come, or the message that has begun takes too long to be one.
  template <class OnMessage>
  void give_up(OnMessage&& on_message) {
    drain(true, on_message);
  }
  void forget() noexcept {
    position_ += buffer_.size();
    buffer_.clear();
  }
  /// Bytes that may become a message are kept.
  bool waiting() const noexcept { return !buffer_.empty(); }

  const Counts& counts() const noexcept { return counts_; }
  /// Bytes of the stream up to the end of the message that is being told, or to where it waits.
  std::uint64_t position() const noexcept { return position_; }

 private:
  enum class Look { Message, More, Other };
  Look look(std::size_t at, Message& message, std::size_t& length) noexcept;

  template <class OnMessage>
  void drain(bool last, OnMessage& on_message) {
    std::size_t at = 0;
    while (at < buffer_.size()) {
      Message message;
      std::size_t length = 0;
      const Look seen = look(at, message, length);
      if (seen == Look::More && !last) break;
      if (seen == Look::Message) {
        ++counts_.messages;
        at += length;
        position_ += length;
        on_message(std::as_const(message));
      } else {
        ++counts_.skipped_bytes;
        ++at;
        ++position_;
      }
    }
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::vector<std::uint8_t> buffer_;
  std::uint64_t position_ = 0;
  Counts counts_;
};

/// The short form up to 254 bytes, else the extended one. @param payload at most kMaxPayload bytes.
std::vector<std::uint8_t> encode(std::uint8_t mid, Bytes payload, std::uint8_t bus = 0xFF);

/// One entry of SetOutputConfiguration and of its answer.
struct Output {
  std::uint16_t xdi = 0;
  std::uint16_t rate_hz = 0;  ///< 0xFFFF: with every message; in an answer 0: not supported
  friend bool operator==(const Output&, const Output&) = default;
};
std::vector<std::uint8_t> encode(const std::vector<Output>& outputs);
/// Of C0 and C1. A payload that is not whole entries: what is whole of it.
std::vector<Output> outputs_of(Bytes payload);

/// "MTData2"; empty for what has no name here.
std::string_view name_of(std::uint8_t mid) noexcept;
/// Of message 42, in words: "parameter invalid".
std::string_view error_words(std::uint8_t code) noexcept;

}  // namespace roverd::mti
