#include "twist/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>

namespace roverd::twist {
namespace {

constexpr std::size_t kMostFields = 10;

std::string sealed(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char end[8];
  std::snprintf(end, sizeof end, "*%02X\r\n", sum & 0xFFU);
  return "$" + body + end;
}

std::optional<double> number(std::string_view text, double most) noexcept {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [ptr, ec] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (ec != std::errc{} || ptr != end || !(std::abs(value) <= most)) return {};
  return value;
}

std::optional<std::uint8_t> small(std::string_view text, unsigned most = 255) noexcept {
  unsigned value = 0;
  const char* end = text.data() + text.size();
  const auto [ptr, ec] = std::from_chars(text.data(), end, value);
  if (ec != std::errc{} || ptr != end || value > most) return {};
  return static_cast<std::uint8_t>(value);
}

using Fields = std::span<const std::string_view>;

Said command_of(Fields f) noexcept {
  if (f.size() != 5) return {};
  const auto seq = small(f[1]);
  const auto speed = number(f[2], 100.0);
  const auto turn = number(f[3], 100.0);
  const auto enable = small(f[4], 1);
  if (!seq || !speed || !turn || !enable) return {};
  return Command{*seq, *speed, *turn, *enable == 1};
}

Said feedback_of(Fields f) noexcept {
  if (f.size() != 10) return {};
  const auto seq = small(f[1]);
  const auto ack = small(f[2]);
  const auto speed = number(f[3], 100.0);
  const auto turn = number(f[4], 100.0);
  const auto left = number(f[5], 1e7);
  const auto right = number(f[6], 1e7);
  const auto battery = number(f[7], 1000.0);
  const auto status = small(f[8]);
  const auto estop = small(f[9], 1);
  if (!seq || !ack || !speed || !turn || !left || !right || !battery || !status || !estop) {
    return {};
  }
  return Feedback{*seq, *ack, *speed, *turn, *left, *right, *battery, *status, *estop == 1};
}

}  // namespace

std::string encode_text(const Command& c) {
  char text[80];
  std::snprintf(text, sizeof text, "RVC,%u,%.3f,%.3f,%d", c.seq, c.speed_mps, c.turn_radps,
                c.enable ? 1 : 0);
  return sealed(text);
}

std::string encode_text(const Feedback& f) {
  char text[160];
  std::snprintf(text, sizeof text, "RVF,%u,%u,%.3f,%.3f,%.3f,%.3f,%.2f,%u,%d", f.seq, f.ack,
                f.speed_mps, f.turn_radps, f.left_m, f.right_m, f.battery_v, f.status,
                f.estop ? 1 : 0);
  return sealed(text);
}

Said parse_text(std::string_view line) noexcept {
  if (line.size() < 8 || line.front() != '$' || line[line.size() - 3] != '*') return {};
  const std::string_view body = line.substr(1, line.size() - 4);
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  unsigned said = 256;
  const char* end = line.data() + line.size();
  const auto [ptr, ec] = std::from_chars(end - 2, end, said, 16);
  if (ec != std::errc{} || ptr != end || said != sum) return {};
  std::array<std::string_view, kMostFields> fields;
  std::size_t count = 0;
  std::string_view rest = body;
  while (true) {
    if (count == kMostFields) return {};
    const auto comma = rest.find(',');
    fields[count++] = rest.substr(0, comma);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  const Fields all(fields.data(), count);
  if (fields[0] == "RVC") return command_of(all);
  if (fields[0] == "RVF") return feedback_of(all);
  return {};
}

Said TextDecoder::line_done() noexcept {
  if (size_ == 0) return {};
  std::string_view line(line_, size_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  const Said said = parse_text(line);
  if (said.index() == 0) ++refused_;
  size_ = 0;
  return said;
}

}  // namespace roverd::twist
