#include "ratio/codec.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace roverd::ratio {
namespace {

std::optional<double> number(std::string_view text) noexcept {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [ptr, ec] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (ec != std::errc{} || ptr != end || !std::isfinite(value)) return {};
  return value;
}

}  // namespace

std::string encode(const Message& m) {
  char text[64];
  // + 0.0 turns −0 into 0.
  std::snprintf(text, sizeof text, "%.3f %.3f\n", std::round(m.speed_mps * 1e3) / 1e3 + 0.0,
                std::round(m.ratio * 1e3) / 1e3 + 0.0);
  return text;
}

std::optional<Message> parse(std::string_view line) noexcept {
  const auto blank = line.find(' ');
  if (blank == std::string_view::npos) return {};
  const auto speed = number(line.substr(0, blank));
  const auto ratio = number(line.substr(blank + 1));
  if (!speed || !ratio || std::abs(*ratio) > 2.0) return {};
  return Message{*speed, *ratio};
}

Message from_twist(base::BodyTwist t, double track_width_m) noexcept {
  const double left = t.linear_mps - t.angular_radps * track_width_m / 2.0;
  const double right = t.linear_mps + t.angular_radps * track_width_m / 2.0;
  const bool left_slower = std::abs(left) <= std::abs(right);
  const double fast = left_slower ? right : left;
  const double slow = left_slower ? left : right;
  if (std::abs(fast) < 1e-6) return {};
  const double lack = 1.0 - slow / fast;  // 0..2
  return {fast, left_slower ? lack : -lack};
}

base::BodyTwist to_twist(const Message& m, double track_width_m) noexcept {
  const double slow = m.speed_mps * (1.0 - std::abs(m.ratio));
  const double left = m.ratio > 0.0 ? slow : m.speed_mps;
  const double right = m.ratio > 0.0 ? m.speed_mps : slow;
  return {(left + right) / 2.0, (right - left) / track_width_m};
}

}  // namespace roverd::ratio
