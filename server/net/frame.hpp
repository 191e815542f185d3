#pragma once
// WebSocket frames of a server (RFC 6455, section 5.2), made once and shared by all receivers: a
// server does not mask, so the bytes are the same for every client.
//
//   FIN|opcode   length 0..125 | 126 + 16 bit | 127 + 64 bit   payload

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace roverd::net {

/// One or more whole frames. Immutable, shared between clients.
using Frame = std::shared_ptr<const std::string>;

/// @param text UTF-8; not checked here.
inline Frame text_frame(std::string_view text) {
  std::string out;
  out.reserve(text.size() + 10);
  out.push_back(static_cast<char>(0x81));
  const std::uint64_t n = text.size();
  int bytes = 0;
  if (n < 126) {
    out.push_back(static_cast<char>(n));
  } else {
    bytes = n <= 0xffff ? 2 : 8;
    out.push_back(static_cast<char>(bytes == 2 ? 126 : 127));
  }
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<char>((n >> (8 * i)) & 0xff));
  out.append(text);
  return std::make_shared<const std::string>(std::move(out));
}

/// An empty ping.
inline Frame ping_frame() {
  static const Frame kPing = std::make_shared<const std::string>("\x89\x00", 2);
  return kPing;
}

}  // namespace roverd::net
