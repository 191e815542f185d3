#include "bumper/codec.hpp"

#include <array>
#include <charconv>
#include <cstdio>

namespace roverd::bumper {
namespace {

constexpr std::array<const char*, 8> kPlaces{"front left", "front", "front right", "left", "right",
                                             "rear left",  "rear",  "rear right"};

unsigned checksum(std::string_view text) noexcept {
  unsigned sum = 0;
  for (const char c : text) sum ^= static_cast<unsigned char>(c);
  return sum;
}

/// All of `text`, or −1.
int number(std::string_view text, int base) noexcept {
  int value = -1;
  const char* end = text.data() + text.size();
  const auto [ptr, ec] = std::from_chars(text.data(), end, value, base);
  return ec == std::errc{} && ptr == end && !text.empty() && text[0] != '-' ? value : -1;
}

}  // namespace

std::optional<std::uint8_t> parse(std::string_view line) noexcept {
  if (line.size() < 6 || line.substr(0, 2) != "B,") return {};
  const auto star = line.size() - 3;
  if (line[star] != '*') return {};
  if (number(line.substr(star + 1), 16) != static_cast<int>(checksum(line.substr(0, star)))) {
    return {};
  }
  const int mask = number(line.substr(2, star - 2), 10);
  if (mask < 0 || mask > 255) return {};
  return static_cast<std::uint8_t>(mask);
}

std::string encode(std::uint8_t mask) {
  const std::string body = "B," + std::to_string(mask);
  char end[8];
  std::snprintf(end, sizeof end, "*%02X\r\n", checksum(body));
  return body + end;
}

std::string where(std::uint8_t mask) {
  std::string text;
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    if ((mask >> i & 1U) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(kPlaces[i]);
  }
  return text;
}

}  // namespace roverd::bumper
