#include "link/candump.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>

#include "link/can_wire.hpp"

namespace roverd::link {
namespace {

using base::Duration;

constexpr std::uint32_t kErrorBit = 0x2000'0000;
constexpr std::size_t kLongestBusName = 15;

tl::unexpected<base::Error> bad_line(std::string_view problem) {
  return base::fail(base::Code::Malformed, std::string(problem));
}

std::string_view trim(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Takes the next word off the front of `rest`; empty at the end.
std::string_view next_word(std::string_view& rest) noexcept {
  rest = trim(rest);
  const auto end = std::min(rest.find_first_of(" \t"), rest.size());
  const auto word = rest.substr(0, end);
  rest = rest.substr(end);
  return word;
}

template <class N>
std::optional<N> number(std::string_view text, int radix = 10) noexcept {
  N value{};
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value, radix);
  if (text.empty() || ec != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

std::optional<int> hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return {};
}

std::optional<std::uint8_t> hex_byte(std::string_view two) noexcept {
  if (two.size() != 2) return {};
  const auto high = hex_digit(two[0]);
  const auto low = hex_digit(two[1]);
  if (!high || !low) return {};
  return static_cast<std::uint8_t>(*high * 16 + *low);
}

/// "20", "20.1234": seconds with up to nine decimals.
std::optional<Duration> parse_seconds(std::string_view text) noexcept {
  const auto dot = text.find('.');
  const auto whole = number<std::uint32_t>(text.substr(0, dot));  // until the year 2106
  if (!whole) return {};
  Duration out = std::chrono::seconds(*whole);
  if (dot == std::string_view::npos) return out;
  const auto decimals = text.substr(dot + 1);
  const auto fraction = number<std::uint32_t>(decimals);
  if (!fraction || decimals.size() > 9) return {};
  std::int64_t ns = *fraction;
  for (std::size_t i = decimals.size(); i < 9; ++i) ns *= 10;
  return out + std::chrono::nanoseconds(ns);
}

/// "2023-11-14 22:13:20.123456" (candump -t A), taken as UTC; only differences are ever used.
std::optional<Duration> parse_date(std::string_view text) noexcept {
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || text[10] != ' ' || text[13] != ':' ||
      text[16] != ':') {
    return {};
  }
  const auto year = number<std::uint32_t>(text.substr(0, 4));
  const auto month = number<std::uint32_t>(text.substr(5, 2));
  const auto day = number<std::uint32_t>(text.substr(8, 2));
  const auto hour = number<std::uint32_t>(text.substr(11, 2));
  const auto minute = number<std::uint32_t>(text.substr(14, 2));
  const auto second = parse_seconds(text.substr(17));
  if (!year || !month || !day || !hour || !minute || !second) return {};
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(*month), std::chrono::day(*day)};
  if (!date.ok() || *year < 1970 || *year > 2105 || *hour > 23 || *minute > 59 ||
      *second >= std::chrono::seconds(61)) {
    return {};
  }
  return std::chrono::sys_days(date).time_since_epoch() + std::chrono::hours(*hour) +
         std::chrono::minutes(*minute) + *second;
}

/// Sets id and flags from 3 or 8 hex digits. @return what is wrong, or empty.
std::string_view read_id(std::string_view text, base::CanFrame& frame) noexcept {
  const auto id = number<std::uint32_t>(text, 16);
  if (!id || (text.size() != 3 && text.size() != 8)) return "the id is not 3 or 8 hex digits";
  if (text.size() == 3) {
    if (*id > kStandardIdMask) return "a standard id is at most 7FF";
    frame.id = *id;
    return {};
  }
  if (*id > (kExtendedIdMask | kErrorBit)) return "an extended id is at most 1FFFFFFF";
  frame.error = (*id & kErrorBit) != 0;
  frame.extended = !frame.error;
  frame.id = *id & kExtendedIdMask;
  return {};
}

/// The part after '#': "R", "R4", "1122AA", "11.22.AA", with an optional "_C" (raw length code).
std::string_view read_data(std::string_view text, base::CanFrame& frame) noexcept {
  if (text.starts_with('#')) return "CAN FD frames are not supported";
  if (text.starts_with('R') || text.starts_with('r')) {
    frame.remote = true;
    text.remove_prefix(1);
    if (!text.empty() && text.front() >= '0' && text.front() <= '8') {
      frame.len = static_cast<std::uint8_t>(text.front() - '0');
      text.remove_prefix(1);
    }
  } else {
    while (!text.empty() && text.front() != '_') {
      if (text.front() == '.' && frame.len > 0) text.remove_prefix(1);
      const auto byte = hex_byte(text.substr(0, 2));
      if (!byte) return "the data is not pairs of hex digits";
      if (frame.len == 8) return "more than 8 data bytes";
      frame.data[frame.len++] = *byte;
      text.remove_prefix(2);
    }
  }
  const bool raw_length = text.size() == 2 && text[0] == '_' && hex_digit(text[1]).has_value();
  return text.empty() || (raw_length && frame.len == 8) ? "" : "unexpected text behind the data";
}

/// "241#A600… [R|T]", the bus already read.
std::string_view read_log(std::string_view word, std::string_view rest, CanRecord& out) noexcept {
  const auto hash = word.find('#');
  if (const auto problem = read_id(word.substr(0, hash), out.frame); !problem.empty()) {
    return problem;
  }
  if (const auto problem = read_data(word.substr(hash + 1), out.frame); !problem.empty()) {
    return problem;
  }
  rest = trim(rest);
  out.sent = rest == "T";
  return rest.empty() || rest == "T" || rest == "R" ? "" : "unexpected text behind the data";
}

/// "241   [8]  A6 00 …" or "RX - -  241 …", the bus and the first word already read.
std::string_view read_console(std::string_view word, std::string_view rest,
                              CanRecord& out) noexcept {
  if (word == "RX" || word == "TX") {
    out.sent = word == "TX";
    next_word(rest);  // B: the bit rate was switched
    next_word(rest);  // E: the error state
    word = next_word(rest);
  }
  if (const auto problem = read_id(word, out.frame); !problem.empty()) return problem;
  const auto length = next_word(rest);
  if (length.size() == 4) return "CAN FD frames are not supported";
  if (length.size() != 3 || length[0] != '[' || length[2] != ']' || length[1] < '0' ||
      length[1] > '8') {
    return "the length is not [0] to [8]";
  }
  out.frame.len = static_cast<std::uint8_t>(length[1] - '0');
  rest = trim(rest);
  if (rest.starts_with("remote request")) {
    out.frame.remote = true;
    return {};
  }
  for (std::size_t i = 0; i < out.frame.len; ++i) {
    const auto byte = hex_byte(next_word(rest));
    if (!byte) return "fewer data bytes than the length says, or not two hex digits each";
    out.frame.data[i] = *byte;
  }
  rest = trim(rest);
  const bool known_tail = rest.empty() || rest.starts_with('\'') || rest == "ERRORFRAME";
  return known_tail ? "" : "unexpected text behind the data";
}

}  // namespace

base::Result<std::optional<CanRecord>> parse_candump_line(std::string_view line) {
  if (line.starts_with('\t')) return std::nullopt;
  auto rest = trim(line);
  if (rest.empty() || rest.front() == '#') return std::nullopt;
  CanRecord out;
  if (rest.front() == '(') {
    const auto close = rest.find(')');
    if (close == std::string_view::npos) return bad_line("the time stamp has no closing bracket");
    const auto text = trim(rest.substr(1, close - 1));
    out.stamp = parse_seconds(text);
    if (!out.stamp) out.stamp = parse_date(text);
    if (!out.stamp) return bad_line("the time stamp is not a number of seconds");
    rest = rest.substr(close + 1);
  }
  const auto bus = next_word(rest);
  if (bus.empty() || bus.size() > kLongestBusName)
    return bad_line("the name of the bus is missing");
  out.bus = bus;
  const auto word = next_word(rest);
  if (word.empty()) return bad_line("the frame is missing");
  const bool log = word.find('#') != std::string_view::npos;
  const auto problem = log ? read_log(word, rest, out) : read_console(word, rest, out);
  if (!problem.empty()) return bad_line(problem);
  return out;
}

std::string to_candump_line(const CanRecord& record) {
  using std::chrono::microseconds;
  const auto us = std::chrono::duration_cast<microseconds>(record.stamp.value_or(Duration{}));
  const base::CanFrame& frame = record.frame;
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "(%010lld.%06lld) ",
                static_cast<long long>(us.count() / 1'000'000),
                static_cast<long long>(us.count() % 1'000'000));
  std::string out = text.data() + record.bus;
  const bool wide = frame.extended || frame.error;
  std::snprintf(text.data(), text.size(), wide ? " %08X#" : " %03X#",
                frame.id | (frame.error ? kErrorBit : 0U));
  out += text.data();
  if (frame.remote) {
    out += 'R';
    if (frame.len > 0) out += static_cast<char>('0' + frame.len);
  } else {
    for (const std::uint8_t byte : frame.bytes()) {
      std::snprintf(text.data(), text.size(), "%02X", byte);
      out += text.data();
    }
  }
  return out + (record.sent ? " T\n" : " R\n");
}

}  // namespace roverd::link
