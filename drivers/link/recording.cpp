#include "link/recording.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>

namespace roverd::link {
namespace {

using base::Bytes;
using State = RecordingStep::State;

constexpr std::size_t kLongestHeader = 1024;
/// "(4294967295.999999) R 65536"
constexpr std::size_t kLongestRecordLine = 40;

RecordingStep bad(std::string problem) {
  return {State::Bad, 0, {}, std::move(problem)};
}

std::string_view as_text(Bytes bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Digits only, from the front of `text`, which loses them.
std::optional<std::uint32_t> take_number(std::string_view& text) noexcept {
  std::uint32_t value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (ec != std::errc()) return {};
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool take(std::string_view& text, char wanted) noexcept {
  if (!text.starts_with(wanted)) return false;
  text.remove_prefix(1);
  return true;
}

struct RecordLine {
  base::Duration stamp{};
  bool sent = false;
  std::size_t size = 0;
};

/// "(1700000000.123456) R 71"
std::optional<RecordLine> parse_record_line(std::string_view text) noexcept {
  if (!take(text, '(')) return {};
  const auto seconds = take_number(text);
  if (!seconds || !take(text, '.')) return {};
  const std::size_t before = text.size();
  const auto micros = take_number(text);
  if (!micros || before - text.size() != 6 || !take(text, ')') || !take(text, ' ')) return {};
  const bool sent = text.starts_with('T');
  if (!sent && !text.starts_with('R')) return {};
  text.remove_prefix(1);
  if (!take(text, ' ')) return {};
  const auto size = take_number(text);
  if (!size || *size == 0 || *size > kLargestRecord || !text.empty()) return {};
  return RecordLine{std::chrono::seconds(*seconds) + std::chrono::microseconds(*micros), sent,
                    *size};
}

}  // namespace

std::string recording_header(std::string_view source) {
  std::string line = std::string(kRecordingMagic) + "1 ";
  line += source.substr(0, kLongestHeader / 2);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line + '\n';
}

void append_record(std::string& out, base::Duration stamp, bool sent, Bytes bytes) {
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(stamp).count();
  while (!bytes.empty()) {
    const Bytes part = bytes.first(std::min(bytes.size(), kLargestRecord));
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "(%lld.%06lld) %c %zu\n",
                  static_cast<long long>(us / 1'000'000), static_cast<long long>(us % 1'000'000),
                  sent ? 'T' : 'R', part.size());
    out += line.data();
    out += as_text(part);
    out += '\n';
    bytes = bytes.subspan(part.size());
  }
}

RecordingStep read_recording_header(Bytes start) {
  const std::string_view text = as_text(start);
  const auto known = std::min(text.size(), kRecordingMagic.size());
  if (text.substr(0, known) != kRecordingMagic.substr(0, known)) return bad("no recording");
  const auto end = text.substr(0, kLongestHeader).find('\n');
  if (end == std::string_view::npos) {
    if (text.size() >= kLongestHeader) return bad("the header line is too long");
    return {};
  }
  std::string_view rest = text.substr(0, end);
  if (rest.size() < kRecordingMagic.size()) return bad("no recording");
  rest.remove_prefix(kRecordingMagic.size());
  const auto version = take_number(rest);
  if (!version || !rest.starts_with(' ')) return bad("the header has no version");
  if (*version != 1) return bad("version " + std::to_string(*version) + " is not known here");
  return {State::Ok, end + 1, {}, {}};
}

RecordingStep next_record(Bytes rest) {
  const std::string_view text = as_text(rest);
  const auto end = text.substr(0, kLongestRecordLine).find('\n');
  if (end == std::string_view::npos) {
    if (text.size() >= kLongestRecordLine) return bad("a record line is missing");
    return {};
  }
  const auto line = parse_record_line(text.substr(0, end));
  if (!line) return bad("not a record line");
  const std::size_t whole = end + 1 + line->size + 1;
  if (rest.size() < whole) return {};
  if (rest[whole - 1] != '\n') return bad("the record does not end with a line feed");
  return {State::Ok, whole, {line->stamp, line->sent, rest.subspan(end + 1, line->size)}, {}};
}

}  // namespace roverd::link
