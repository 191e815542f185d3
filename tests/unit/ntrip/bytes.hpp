#pragma once
// The fact sheet's bytes.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roverd::ntrip {

inline std::string from_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string out;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    out += static_cast<char>(digit(hex[i]) * 16 + digit(hex[i + 1]));
  }
  return out;
}

inline std::vector<std::uint8_t> bytes_from(const std::string& text) {
  return {text.begin(), text.end()};
}

inline const std::string k1005 = from_hex("d300133ed7d30382980edeef34b4bd62ac0941986f3305ab51");
inline const std::string k1006 = from_hex("d300153ee04d0386ba9305d2030cd236880cd60114443a9801144b");

}  // namespace roverd::ntrip
