#include "mission/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "mission/json/json.hpp"

namespace roverd::mission {
namespace {

/// Bytes of the character that begins at `at`; 0 if it is broken. Table 3-7 of the Unicode
/// standard.
std::size_t character_size(std::string_view text, std::size_t at) noexcept {
  const auto byte = [&](std::size_t i) -> unsigned {
    return at + i < text.size() ? static_cast<std::uint8_t>(text[at + i]) : 0u;
  };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned a = byte(0);
  const unsigned b = byte(1);
  if (a < 0x80) return 1;
  if (a >= 0xC2 && a <= 0xDF) return follows(1) ? 2 : 0;
  if (a >= 0xE0 && a <= 0xEF) {
    const bool narrow = (a == 0xE0 && b < 0xA0) || (a == 0xED && b > 0x9F);
    return follows(1) && follows(2) && !narrow ? 3 : 0;
  }
  if (a >= 0xF0 && a <= 0xF4) {
    const bool narrow = (a == 0xF0 && b < 0x90) || (a == 0xF4 && b > 0x8F);
    return follows(1) && follows(2) && follows(3) && !narrow ? 4 : 0;
  }
  return 0;
}

bool is_control(char c) noexcept {
  const auto byte = static_cast<std::uint8_t>(c);
  return byte < 0x20 || byte == 0x7F;
}

}  // namespace

std::optional<std::size_t> utf8_length(std::string_view text) noexcept {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); ++count) {
    const std::size_t size = character_size(text, at);
    if (size == 0) return std::nullopt;
    at += size;
  }
  return count;
}

std::string name_problem(std::string_view name) {
  const auto length = utf8_length(name);
  if (!length) return "must be valid UTF-8";
  if (name.find_first_not_of(' ') == std::string_view::npos) return "must not be empty";
  if (*length > kMaxNameLength) {
    return "must have at most " + std::to_string(kMaxNameLength) + " characters, has " +
           std::to_string(*length);
  }
  if (std::any_of(name.begin(), name.end(), is_control)) {
    return "must not contain control characters";
  }
  return {};
}

std::string clean_name(std::string_view name, std::string_view fallback) {
  std::string out;
  std::size_t count = 0;
  for (std::size_t at = 0; at < name.size() && count < kMaxNameLength; ++count) {
    const std::size_t size = character_size(name, at);
    if (size == 0 || is_control(name[at])) {
      out += ' ';
      at += 1;
    } else {
      out += name.substr(at, size);
      at += size;
    }
  }
  const std::size_t first = out.find_first_not_of(' ');
  if (first == std::string::npos) return std::string(fallback);
  return out.substr(first, out.find_last_not_of(' ') - first + 1);
}

std::string name_with_ending(std::string name, std::string_view ending) {
  const auto is_inside = [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; };
  while (!name.empty() &&
         utf8_length(name).value_or(0) + utf8_length(ending).value_or(0) > kMaxNameLength) {
    while (is_inside(name.back())) name.pop_back();
    name.pop_back();
  }
  return name += ending;
}

namespace {

/// The small letter of a capital one, by Unicode's blocks of two bytes in UTF-8.
unsigned small_letter(unsigned code) noexcept {
  const bool latin_1 = code >= 0xC0 && code <= 0xDE && code != 0xD7;
  const bool greek = code >= 0x391 && code <= 0x3A9 && code != 0x3A2;
  const bool cyrillic = code >= 0x410 && code <= 0x42F;
  if (latin_1 || greek || cyrillic) return code + 32;
  if (code >= 0x400 && code <= 0x40F) return code + 80;
  if (code == 0x178) return 0xFF;  // Y with diaeresis
  // Extended Latin has capital and small letters in pairs.
  const bool even_capitals = (code >= 0x100 && code <= 0x137) || (code >= 0x14A && code <= 0x177);
  const bool odd_capitals = (code >= 0x139 && code <= 0x148) || (code >= 0x179 && code <= 0x17E);
  if (even_capitals) return code | 1u;
  if (odd_capitals) return code % 2 == 1 ? code + 1 : code;
  return code;
}

}  // namespace

std::string folded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = std::max<std::size_t>(1, character_size(text, at));
    if (size == 1 && text[at] >= 'A' && text[at] <= 'Z') {
      out += static_cast<char>(text[at] + ('a' - 'A'));
    } else if (size == 2) {
      const unsigned code = small_letter((static_cast<unsigned char>(text[at]) & 0x1Fu) << 6u |
                                         (static_cast<unsigned char>(text[at + 1]) & 0x3Fu));
      out += static_cast<char>(0xC0u | code >> 6u);
      out += static_cast<char>(0x80u | (code & 0x3Fu));
    } else {
      out += text.substr(at, size);
    }
    at += size;
  }
  return out;
}

void append_number(std::string& out, double value) {
  if (!std::isfinite(value)) {
    out += "null";
    return;
  }
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  out.append(text.data(), end);
}

std::string number_text(double value) {
  std::string out;
  append_number(out, value);
  return out;
}

std::string fixed_number(double value, int decimals) {
  std::array<char, 400> text{};  // the smallest double takes 327 characters, the largest 310
  const double finite = std::isfinite(value) ? value : 0.0;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), finite, std::chars_format::fixed).ptr;
  std::string out(text.data(), end);
  std::size_t point = out.find('.');
  if (point == std::string::npos) {
    if (decimals == 0) return out;
    point = out.size();
    out += '.';
  }
  const std::size_t wanted = point + 1 + static_cast<std::size_t>(decimals);
  if (out.size() < wanted) out.resize(wanted, '0');
  return out;
}

std::string_view without_bom(std::string_view text) noexcept {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

}  // namespace roverd::mission
