#include "ubx/framer.hpp"

namespace roverd::ubx {
namespace {

constexpr std::uint8_t kSync1 = 0xB5;
constexpr std::uint8_t kSync2 = 0x62;

struct Checksum {
  std::uint8_t a = 0;
  std::uint8_t b = 0;
};

/// @param middle class to the end of the payload.
Checksum checksum(Bytes middle) noexcept {
  Checksum sum;
  for (const std::uint8_t byte : middle) {
    sum.a = static_cast<std::uint8_t>(sum.a + byte);
    sum.b = static_cast<std::uint8_t>(sum.b + sum.a);
  }
  return sum;
}

std::size_t payload_length(Bytes frame) noexcept {
  return static_cast<std::size_t>(frame[4]) | static_cast<std::size_t>(frame[5]) << 8U;
}

bool sum_is_right(Bytes frame) noexcept {
  const Checksum sum = checksum(frame.subspan(2, frame.size() - 4));
  return frame[frame.size() - 2] == sum.a && frame[frame.size() - 1] == sum.b;
}

}  // namespace

bool is_intact(Bytes frame) noexcept {
  return frame.size() >= kOverhead && frame[0] == kSync1 && frame[1] == kSync2 &&
         frame.size() == payload_length(frame) + kOverhead && sum_is_right(frame);
}

Frame opened(Bytes frame) noexcept {
  return {{frame[2], frame[3]}, frame.subspan(6, frame.size() - kOverhead)};
}

Framer::Look Framer::look(std::size_t at, Frame& frame, std::size_t& length) noexcept {
  const Bytes rest = Bytes(buffer_).subspan(at);
  if (rest[0] != kSync1) return Look::Other;
  if (rest.size() < 2) return Look::More;
  if (rest[1] != kSync2) return Look::Other;
  if (rest.size() < 6) return Look::More;
  if (payload_length(rest) > kMaxPayload) {
    ++counts_.too_long;
    return Look::Other;
  }
  length = payload_length(rest) + kOverhead;
  if (rest.size() < length) return Look::More;
  if (!sum_is_right(rest.first(length))) {
    ++counts_.bad_checksum;
    return Look::Other;
  }
  frame = opened(rest.first(length));
  return Look::Frame;
}

std::vector<std::uint8_t> encode(Key key, Bytes payload) {
  std::vector<std::uint8_t> out;
  out.reserve(payload.size() + kOverhead);
  const auto size = static_cast<unsigned>(payload.size());
  for (const unsigned byte : {unsigned{kSync1}, unsigned{kSync2}, unsigned{key.cls},
                              unsigned{key.id}, size, size >> 8U}) {
    out.push_back(static_cast<std::uint8_t>(byte));
  }
  out.insert(out.end(), payload.begin(), payload.end());
  const Checksum sum = checksum(Bytes(out).subspan(2));
  out.push_back(sum.a);
  out.push_back(sum.b);
  return out;
}

}  // namespace roverd::ubx
