#include "rtcm/framer.hpp"

#include "rtcm/crc24q.hpp"

namespace roverd::rtcm {

Framer::Look Framer::look(std::size_t at, Frame& frame) noexcept {
  const Bytes rest = Bytes(buffer_).subspan(at);
  if (rest[0] != 0xD3) return Look::Other;
  if (rest.size() < 2) return Look::More;
  if ((rest[1] & 0xFCU) != 0) return Look::Other;  // six reserved bits
  if (rest.size() < 3) return Look::More;
  const std::size_t payload = static_cast<std::size_t>(rest[1] & 3U) << 8U | rest[2];
  const std::size_t length = payload + 6;
  if (rest.size() < length) return Look::More;
  if (crc24q(rest.first(length)) != 0) {
    ++counts_.bad_crc;
    return Look::Other;
  }
  frame.bytes = rest.first(length);
  frame.number = payload >= 2 ? static_cast<int>(rest[3]) << 4 | rest[4] >> 4U : 0;
  return Look::Frame;
}

}  // namespace roverd::rtcm
