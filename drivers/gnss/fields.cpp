#include "gnss/fields.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>

namespace roverd::gnss {

namespace {

constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

constexpr std::array<double, 19> kPowersOfTen{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                              1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                              1e14, 1e15, 1e16, 1e17, 1e18};

}  // namespace

std::optional<double> decimal_from(std::string_view text) noexcept {
  const bool negative = !text.empty() && text.front() == '-';
  std::uint64_t mantissa = 0;
  std::size_t digits = 0;
  std::size_t decimals = 0;
  bool point = false;
  for (std::size_t i = negative ? 1 : 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_digit(c)) {
      // Beyond 18 digits the sum is wrong, and not used below.
      mantissa = mantissa * 10 + static_cast<std::uint64_t>(c - '0');
      ++digits;
      if (point) ++decimals;
    } else if (c == '.' && !point) {
      point = true;
    } else {
      return std::nullopt;
    }
  }
  if (digits == 0) return std::nullopt;
  if (digits <= 18 && mantissa < (std::uint64_t{1} << 53U)) {
    // Both operands are exact doubles, so the one division rounds correctly (Clinger 1990).
    const double value = static_cast<double>(mantissa) / kPowersOfTen[decimals];
    return negative ? -value : value;
  }
  double value = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> time_from(std::string_view text) noexcept {
  if (text.size() < 6 || (text.size() > 6 && text[6] != '.')) return std::nullopt;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!is_digit(text[i])) return std::nullopt;
  }
  const int hour = (text[0] - '0') * 10 + (text[1] - '0');
  const int minute = (text[2] - '0') * 10 + (text[3] - '0');
  const auto second = decimal_from(text.substr(4));
  if (hour > 23 || minute > 59 || !second || *second >= 61.0) return std::nullopt;
  return hour * 3600 + minute * 60 + *second;
}

Fields::Fields(std::string_view body) noexcept {
  const char* from = body.data();
  const char* const end = body.data() + body.size();
  for (bool first = true;; first = false) {
    const auto* comma =
        from < end
            ? static_cast<const char*>(std::memchr(from, ',', static_cast<std::size_t>(end - from)))
            : nullptr;
    const char* stop = comma != nullptr ? comma : end;
    const std::string_view field(from, static_cast<std::size_t>(stop - from));
    if (first) {
      tag_ = field;
    } else {
      ++size_;
      if (kept_ < list_.size()) list_[kept_++] = field;
    }
    if (comma == nullptr) return;
    from = comma + 1;
  }
}

std::optional<double> Fields::read(
    std::size_t i, std::optional<double> (*from)(std::string_view) noexcept) noexcept {
  const std::string_view text = at(i);
  if (text.empty()) return std::nullopt;
  const auto value = from(text);
  if (!value) refuse(i);
  return value;
}

std::optional<double> Fields::number(std::size_t i, double lo, double hi) noexcept {
  const auto value = read(i, decimal_from);
  if (value && !(*value >= lo && *value <= hi)) {
    refuse(i);
    return std::nullopt;
  }
  return value;
}

std::optional<int> Fields::integer(std::size_t i, int lo, int hi) noexcept {
  const std::string_view text = at(i);
  if (text.empty()) return std::nullopt;
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < lo || value > hi) {
    refuse(i);
    return std::nullopt;
  }
  return value;
}

std::optional<double> Fields::arc(std::size_t i, double limit, char positive,
                                  char negative) noexcept {
  const std::string_view text = at(i);
  const std::array sides{positive, negative};
  const char side = letter(i + 1, {sides.data(), sides.size()});
  if (text.empty()) return std::nullopt;
  // ddmm.m… or dddmm.m…: two digits before the point are minutes, those before them degrees.
  const std::size_t point = std::min(text.find('.'), text.size());
  const std::size_t split = point > 2 ? point - 2 : 0;
  int degrees = 0;
  bool good = point <= 5 && side != 0;
  for (std::size_t k = 0; good && k < split; ++k) {
    good = is_digit(text[k]);
    degrees = degrees * 10 + (text[k] - '0');
  }
  const auto minutes = good ? decimal_from(text.substr(split)) : std::nullopt;
  // decimal_from takes a sign; an arc has none, its side is a letter.
  if (!minutes || text[split] == '-' || *minutes >= 60.0) {
    refuse(i);
    return std::nullopt;
  }
  const double value = degrees + *minutes / 60.0;
  if (value > limit) {
    refuse(i);
    return std::nullopt;
  }
  return side == negative ? -value : value;
}

std::optional<Date> Fields::date(std::size_t i) noexcept {
  const std::string_view text = at(i);
  if (text.empty()) return std::nullopt;
  bool good = text.size() == 6;
  for (std::size_t k = 0; good && k < 6; ++k) good = is_digit(text[k]);
  if (!good) {
    refuse(i);
    return std::nullopt;
  }
  const auto two = [&](std::size_t k) { return (text[k] - '0') * 10 + (text[k + 1] - '0'); };
  const int year = two(4) >= 80 ? 1900 + two(4) : 2000 + two(4);
  const Date date{std::chrono::year{year}, std::chrono::month{static_cast<unsigned>(two(2))},
                  std::chrono::day{static_cast<unsigned>(two(0))}};
  if (!date.ok()) {
    refuse(i);
    return std::nullopt;
  }
  return date;
}

char Fields::letter(std::size_t i, std::string_view allowed) noexcept {
  const std::string_view text = at(i);
  if (text.empty()) return 0;
  if (text.size() == 1 && allowed.find(text.front()) != std::string_view::npos) return text.front();
  refuse(i);
  return 0;
}

char Fields::any_letter(std::size_t i) noexcept {
  const std::string_view text = at(i);
  if (text.empty()) return 0;
  if (text.size() == 1) return text.front();
  refuse(i);
  return 0;
}

}  // namespace roverd::gnss
