#include "api/json/plain_json.hpp"

#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

namespace roverd::api {

namespace {

bool is_number_char(char c) noexcept {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

/// The same number; the shortest digits that read back as it.
void append_plain(std::string& out, std::string_view number) {
  double value = 0.0;
  const auto read = std::from_chars(number.data(), number.data() + number.size(), value);
  std::array<char, 400> digits{};  // the largest double has 309 of them, the smallest 327
  const auto wrote =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  if (read.ec != std::errc{} || wrote.ec != std::errc{}) {
    out += number;
    return;
  }
  const std::string_view plain(digits.data(), static_cast<std::size_t>(wrote.ptr - digits.data()));
  out += plain;
  if (plain.find('.') == std::string_view::npos) out += ".0";  // it is no whole number by nature
}

/// The end of the string that begins at `at`, behind its quote.
std::size_t string_end(std::string_view text, std::size_t at) noexcept {
  for (++at; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return at + 1;
}

}  // namespace

std::string plain_json(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  std::size_t copied = 0;  // up to here `out` has what stands in `text`
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '"') {
      i = string_end(text, i);
      continue;
    }
    if (text[i] != '-' && (text[i] < '0' || text[i] > '9')) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && is_number_char(text[end])) ++end;
    const std::string_view number = std::string_view(text).substr(i, end - i);
    if (number.find('e') != std::string_view::npos) {
      out.append(text, copied, i - copied);
      append_plain(out, number);
      copied = end;
    }
    i = end;
  }
  if (copied == 0) return text;
  out.append(text, copied, std::string::npos);
  return out;
}

}  // namespace roverd::api
