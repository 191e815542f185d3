#include "gate/reading.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <string_view>

namespace roverd::gate {

namespace {

/// Numbers of the longest line.
constexpr std::size_t kNumbers = 4;
using Numbers = std::array<double, kNumbers>;

bool sum_right(const Wire& w) noexcept {
  unsigned sum = (w.id & 0xFFU) + (w.id >> 8U) + static_cast<unsigned>(w.bytes.size());
  for (const std::uint8_t b : w.bytes.first(w.bytes.size() - 1)) sum += b;
  return w.bytes.back() == (sum & 0xFFU);
}

/// Polynomial 0x1021 from 0xFFFF, bit by bit: a second way to the same sum.
bool crc_right(base::Bytes bytes) noexcept {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t b : bytes.subspan(2, bytes.size() - 4)) {
    for (unsigned mask = 0x80; mask != 0; mask >>= 1U) {
      const bool carry = ((crc & 0x8000U) != 0) != ((b & mask) != 0);
      crc = (crc << 1U & 0xFFFFU) ^ (carry ? 0x1021U : 0U);
    }
  }
  const unsigned told = bytes.back() * 256U + bytes[bytes.size() - 2];
  return told == crc;
}

std::string_view chars_of(base::Bytes bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Takes "*HH" off the end of `line`, whose first character does not count.
bool take_seal(std::string_view& line) noexcept {
  const std::size_t star = line.rfind('*');
  if (star == std::string_view::npos) return false;
  const std::string_view digits = line.substr(star + 1);
  line = line.substr(0, star);
  unsigned sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum ^= static_cast<unsigned char>(line[i]);
  unsigned told = 0;
  const char* const last = digits.data() + digits.size();
  return std::from_chars(digits.data(), last, told, 16).ptr == last && digits.size() == 2 &&
         told == sum;
}

/// @return how many; empty: more than any line has, or something that is no number.
std::optional<std::size_t> take_numbers(std::string_view line, char separator,
                                        Numbers& into) noexcept {
  std::size_t count = 0;
  for (double& number : into) {
    ++count;
    const char* const last = line.data() + line.size();
    const auto [end, ec] = std::from_chars(line.data(), last, number, std::chars_format::fixed);
    if (ec != std::errc{} || !std::isfinite(number)) return {};
    if (end == last) return count;
    if (*end != separator) return {};
    line = {end + 1, last};
  }
  return {};
}

bool read_text(const Text& text, base::Bytes bytes, Numbers& into) noexcept {
  std::string_view line = chars_of(bytes);
  if (!line.starts_with(text.begins) || !line.ends_with(text.ends)) return false;
  line.remove_suffix(text.ends.size());
  if (text.check == Check::Xor && !take_seal(line)) return false;
  line.remove_prefix(text.begins.size());
  return take_numbers(line, text.separator, into) == text.numbers;
}

double number_at(const Field& field, const std::uint8_t* p, const Numbers& numbers) noexcept {
  switch (field.form) {
    case Form::U8:
      return p[field.at];
    case Form::I8:
      return static_cast<std::int8_t>(p[field.at]);
    case Form::I16Big:
      return static_cast<std::int16_t>(p[field.at] << 8U | p[field.at + 1]);
    case Form::I16Little:
      return static_cast<std::int16_t>(p[field.at + 1] << 8U | p[field.at]);
    case Form::F32Big: {
      std::uint32_t bits = 0;
      for (std::size_t i = field.at; i < field.at + 4; ++i) bits = bits << 8U | p[i];
      return std::bit_cast<float>(bits);
    }
    case Form::Decimal:
      break;
  }
  return numbers[field.at];
}

}  // namespace

bool sealed(Check check, const Wire& wire) noexcept {
  if (check == Check::Sum) return sum_right(wire);
  return check != Check::Crc16 || crc_right(wire.bytes);
}

bool fits(const Layout& layout, const Wire& wire) noexcept {
  for (std::size_t i = 0; i < layout.size; ++i) {
    const Byte& may = layout.byte[i];
    if (wire.bytes[i] < may.least || wire.bytes[i] > may.most) return false;
  }
  return sealed(layout.check, wire);
}

bool right_length(const Motion& motion, base::Bytes bytes) noexcept {
  return motion.text || bytes.size() == motion.bytes.size;
}

std::optional<Said> read(const Motion& motion, const Wire& wire) noexcept {
  Numbers numbers{};
  if (motion.text ? !read_text(*motion.text, wire.bytes, numbers) : !fits(motion.bytes, wire)) {
    return {};
  }
  const std::uint8_t* p = wire.bytes.data();
  Said said;
  said.stands = true;
  for (std::size_t i = 0; i < said.values.size(); ++i) {
    const Value& value = motion.values[i];
    said.values[i] = number_at(value.field, p, numbers) / value.field.per_unit;
    if (!std::isfinite(said.values[i])) return {};
    if (said.values[i] != 0.0 && !value.holds) said.stands = false;
    if (value.holds && std::abs(said.values[i]) > value.max) said.beyond = true;
  }
  said.drives = !said.stands;
  if (motion.mode) {
    const double mode = number_at(motion.mode->field, p, numbers);
    if (mode < 0.0 || mode > motion.mode->most) return {};
    said.drives = mode == motion.mode->drives;
  }
  said.asks = motion.asks_at && p[*motion.asks_at] != 0;
  return said;
}

}  // namespace roverd::gate
