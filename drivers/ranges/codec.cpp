#include "ranges/codec.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace roverd::ranges {
namespace {

constexpr std::string_view kSeparators = " \t,;|/()[]{}";
constexpr std::array<std::string_view, 9> kNothing{"-",    "--",  "---", "oor",    "out",
                                                   "none", "far", "max", "timeout"};
constexpr std::array<std::string_view, 8> kRefused{"nan",   "inf", "infinity", "err",
                                                   "error", "x",   "?",        "fail"};

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view word) noexcept {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_letter(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '#' || c == '$';
}
bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

unsigned xor_of(std::string_view text) noexcept {
  if (text.starts_with('$')) text.remove_prefix(1);
  unsigned sum = 0;
  for (const char c : text) sum ^= static_cast<unsigned char>(c);
  return sum;
}

/// @return null: it holds, or there is none; the line is then without it.
const char* take_checksum(std::string_view& line) noexcept {
  const auto star = line.rfind('*');
  if (star == std::string_view::npos) return nullptr;
  const std::string_view digits = line.substr(star + 1);
  unsigned said = 0;
  const auto [end, ec] = std::from_chars(digits.data(), digits.data() + digits.size(), said, 16);
  if (digits.size() != 2 || ec != std::errc{} || end != digits.data() + 2) {
    return "a checksum that is none";
  }
  line = line.substr(0, star);
  return said == xor_of(line) ? nullptr : "a wrong checksum";
}

/// Metres; empty: no unit.
std::optional<double> unit_of(std::string_view word) noexcept {
  if (word == "m") return 1.0;
  if (word == "cm") return 0.01;
  if (word == "mm") return 0.001;
  if (word == "in") return 0.0254;
  return {};
}

Reading reading_of(double range_m) noexcept {
  if (!std::isfinite(range_m) || range_m <= 0.0) return {Outcome::Refused, 0.0};
  return {Outcome::Range, range_m};
}

/// Reads one word after the other.
class Words {
 public:
  explicit Words(double unit_m) : unit_m_(unit_m) {}

  /// @return false: it makes no sense.
  bool take(std::string_view word) {
    if (word.ends_with(':') || word.ends_with('=')) return true;
    const std::string low = lower(word);
    if (is_one_of(kNothing, low) || low == "no" || low.starts_with('>')) {
      bare_.reset();
      return add({Outcome::Nothing, 0.0});
    }
    if (is_one_of(kRefused, low) || low == "-inf") {
      bare_.reset();
      return add({Outcome::Refused, 0.0});
    }
    if (const auto unit = unit_of(low)) {
      // Of the number before; "m" alone is a label.
      if (bare_ && !line.readings.empty()) line.readings.back() = reading_of(*bare_ * *unit);
      bare_.reset();
      return true;
    }
    if (std::all_of(low.begin(), low.end(), is_letter)) return true;
    return take_number(low);
  }

  Line line;

 private:
  bool add(const Reading& reading) {
    if (line.readings.size() == kMostRanges) return false;
    line.readings.push_back(reading);
    return true;
  }
  bool take_number(std::string_view word) {
    while (!word.empty() && (is_letter(word.front()) || word.front() == '<')) word.remove_prefix(1);
    if (word.starts_with('+')) word.remove_prefix(1);
    if (word.empty() || !(is_digit(word.front()) || word.front() == '.' || word.front() == '-')) {
      return false;
    }
    double value = 0.0;
    const char* end = word.data() + word.size();
    const auto [rest, ec] = std::from_chars(word.data(), end, value);
    if (ec == std::errc::invalid_argument) return false;
    if (ec != std::errc{}) value = 0.0;  // beyond all numbers: refused as such
    const std::string_view suffix(rest, static_cast<std::size_t>(end - rest));
    if (suffix.empty()) {
      bare_ = value;
      return add(reading_of(value * unit_m_));
    }
    bare_.reset();
    const auto unit = unit_of(suffix);
    return unit && add(reading_of(value * *unit));
  }

  const double unit_m_;
  std::optional<double> bare_;  ///< the number before, which told no unit
};

/// The words of a line, "d=1.2" and "S1:1.2" cut behind their label.
template <class OnWord>
bool each_word(std::string_view line, OnWord&& on_word) {
  while (!line.empty()) {
    const auto from = line.find_first_not_of(kSeparators);
    if (from == std::string_view::npos) return true;
    line.remove_prefix(from);
    auto size = std::min(line.find_first_of(kSeparators), line.size());
    if (const auto label = line.find_first_of(":="); label < size) size = label + 1;
    if (!on_word(line.substr(0, size))) return false;
    line.remove_prefix(size);
  }
  return true;
}

}  // namespace

Line parse(std::string_view line, double unit_m) {
  if (const char* fault = take_checksum(line)) return {fault};
  Words words(unit_m);
  if (!each_word(line, [&](std::string_view w) { return words.take(w); })) {
    return {"a word that makes no sense"};
  }
  if (words.line.readings.empty()) return {"no range in it"};
  return words.line;
}

std::string encode(const std::vector<std::optional<double>>& ranges_m) {
  std::string line = "R";
  for (const auto& range_m : ranges_m) {
    char text[32];
    std::snprintf(text, sizeof text, " %.3f", range_m.value_or(0.0));
    line += range_m ? text : " -";
  }
  char end[8];
  std::snprintf(end, sizeof end, "*%02X\r\n", xor_of(line));
  return line + end;
}

}  // namespace roverd::ranges
