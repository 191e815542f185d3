#pragma once
// Lines of HTTP headers.

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace roverd::camera {

inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

inline std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view kBlank = " \t\r";
  const auto begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// The value of "NAME: value", if the line is that. @param name in small letters.
inline std::optional<std::string_view> header(std::string_view line, std::string_view name) {
  const auto colon = line.find(':');
  if (colon == std::string_view::npos || lower(trimmed(line.substr(0, colon))) != name) return {};
  return trimmed(line.substr(colon + 1));
}

}  // namespace roverd::camera
