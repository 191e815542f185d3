#include "sick/fields.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>

namespace roverd::sick {
namespace {

constexpr std::string_view kEnds = "the telegram ends before it";

std::string_view letters_of(Bytes bytes) noexcept {
  // Letters are bytes, too; nothing is written through this.
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A number of CoLa A as it would stand in `bytes` bytes; empty: it is none, or does not fit.
std::optional<std::uint64_t> parse_number(std::string_view text, std::size_t bytes,
                                          bool is_signed) {
  const bool decimal = !text.empty() && (text[0] == '+' || text[0] == '-');
  const bool minus = decimal && text[0] == '-';
  if (decimal) text.remove_prefix(1);
  std::uint32_t magnitude = 0;
  const auto [end, problem] =
      std::from_chars(text.data(), text.data() + text.size(), magnitude, decimal ? 10 : 16);
  if (problem != std::errc{} || end != text.data() + text.size() || text.empty()) return {};
  const std::uint64_t most = bytes == 4 ? 0xFFFF'FFFFU : bytes == 2 ? 0xFFFFU : 0xFFU;
  if (!decimal) return magnitude <= most ? std::optional<std::uint64_t>(magnitude) : std::nullopt;
  const std::uint64_t limit = is_signed ? (most >> 1U) + (minus ? 1U : 0U) : minus ? 0 : most;
  if (magnitude > limit) return {};
  return minus ? (std::uint64_t{0} - magnitude) & most : magnitude;
}

}  // namespace

Fields::Fields(Dialect dialect, Bytes body, std::size_t at) noexcept
    : dialect_(dialect),
      body_(body),
      at_(std::min(at, body.size())),
      began_(at_),
      more_(at_ < body.size()) {}

void Fields::refuse(const char* field, const char* problem) {
  if (error_) return;
  error_ = base::Error{base::Code::Malformed,
                       std::string(field) + ": " + problem,
                       {{"byte " + std::to_string(began_), problem}}};
}

std::string_view Fields::token(const char* field) {
  if (error_) return {};
  began_ = at_;
  if (!more_) {
    refuse(field, kEnds.data());
    return {};
  }
  const std::string_view rest = letters_of(body_.subspan(at_));
  const std::size_t end = rest.find(' ');
  more_ = end != std::string_view::npos;
  at_ = more_ ? at_ + end + 1 : body_.size();
  return rest.substr(0, end);
}

std::uint64_t Fields::number(const char* field, std::size_t bytes, bool is_signed) {
  if (error_) return 0;
  if (dialect_ == Dialect::A) {
    const auto value = parse_number(token(field), bytes, is_signed);
    if (!value) refuse(field, "no such number");
    return value.value_or(0);
  }
  began_ = at_;
  if (body_.size() - at_ < bytes) {
    refuse(field, kEnds.data());
    return 0;
  }
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | body_[at_++];
  return value;
}

std::uint8_t Fields::u8(const char* field) {
  return static_cast<std::uint8_t>(number(field, 1, false));
}
std::uint16_t Fields::u16(const char* field) {
  return static_cast<std::uint16_t>(number(field, 2, false));
}
std::uint32_t Fields::u32(const char* field) {
  return static_cast<std::uint32_t>(number(field, 4, false));
}
std::int32_t Fields::i32(const char* field) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(number(field, 4, true)));
}
float Fields::f32(const char* field) {
  return std::bit_cast<float>(u32(field));
}

std::string Fields::text(const char* field, std::size_t length) {
  if (error_) return {};
  began_ = at_;
  const bool follows = dialect_ == Dialect::B || more_;
  if (!follows || body_.size() - at_ < length) {
    refuse(field, kEnds.data());
    return {};
  }
  std::string out(letters_of(body_.subspan(at_, length)));
  at_ += length;
  if (dialect_ == Dialect::B) return out;
  more_ = at_ < body_.size();
  if (more_ && body_[at_++] != ' ') refuse(field, "longer than its length");
  return out;
}

std::string Fields::word(const char* field, std::size_t length) {
  if (dialect_ == Dialect::B) return text(field, length);
  const std::string_view found = token(field);
  if (ok() && (found.empty() || found.size() > length)) refuse(field, "no such word");
  return ok() ? std::string(found) : std::string();
}

bool Fields::holds(const char* field, std::size_t count, std::size_t bytes_each) {
  if (error_) return false;
  const std::size_t rest = body_.size() - at_;
  const std::size_t most = dialect_ == Dialect::B ? rest / bytes_each : (rest + 1) / 2;
  if (count > most) refuse(field, "more than the telegram holds");
  return ok();
}

bool Fields::ends() {
  if (error_) return false;
  began_ = at_;
  const Bytes rest = body_.subspan(at_);
  const bool blank = rest.empty() || (rest.size() == 1 && rest[0] == ' ');
  if (!blank) refuse("end", "something follows the last field");
  return ok();
}

std::optional<Words> words_of(const Telegram& telegram) noexcept {
  const std::string_view body = letters_of(telegram.body);
  if (body.size() < 3 || body[0] != 's') return {};
  Words out{body.substr(0, 3), {}, 3};
  if (out.kind == "sFA") return out;
  if (body.size() < 5 || body[3] != ' ') return {};
  const std::size_t end = std::min(body.find(' ', 4), body.size());
  out.name = body.substr(4, end - 4);
  out.fields_at = std::min(end + 1, body.size());
  const bool letters =
      std::all_of(out.name.begin(), out.name.end(), [](char c) { return c > ' ' && c < '\x7F'; });
  return letters && !out.name.empty() ? std::optional(out) : std::nullopt;
}

std::uint16_t error_code(const Telegram& telegram) noexcept {
  Bytes rest = telegram.body.subspan(std::min<std::size_t>(3, telegram.body.size()));
  if (!rest.empty() && rest[0] == ' ') rest = rest.subspan(1);
  if (telegram.dialect == Dialect::A) {
    return static_cast<std::uint16_t>(parse_number(letters_of(rest), 2, false).value_or(0));
  }
  if (rest.empty() || rest.size() > 2) return 0;
  return static_cast<std::uint16_t>(rest.size() == 1 ? rest[0] : rest[0] << 8U | rest[1]);
}

std::string_view error_words(std::uint16_t code) noexcept {
  constexpr std::array<std::string_view, 16> kWords{"error",
                                                    "access denied",
                                                    "unknown method index",
                                                    "unknown variable index",
                                                    "local condition failed",
                                                    "invalid data",
                                                    "unknown error",
                                                    "buffer overflow",
                                                    "buffer underflow",
                                                    "unknown type",
                                                    "write access denied",
                                                    "unknown command for the name server",
                                                    "unknown CoLa command",
                                                    "server busy",
                                                    "array out of bounds",
                                                    "unknown event"};
  return code < kWords.size() ? kWords[code] : kWords[0];
}

Writer::Writer(Dialect dialect, std::string_view kind, std::string_view name) : dialect_(dialect) {
  letters(kind);
  if (name.empty()) return;
  body_.push_back(' ');
  letters(name);
}

void Writer::letters(std::string_view text) {
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    body_.push_back(byte < 0x20 ? std::uint8_t{'?'} : byte);
  }
}

/// In CoLa B the one blank after the words, in CoLa A one before every field.
void Writer::next_field() {
  if (first_ || dialect_ == Dialect::A) body_.push_back(' ');
  first_ = false;
}

Writer& Writer::put(std::uint32_t value, std::size_t bytes) {
  next_field();
  if (dialect_ == Dialect::B) {
    for (std::size_t i = bytes; i-- > 0;) {
      body_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    return *this;
  }
  std::array<char, 8> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, 16).ptr;
  for (const char* c = digits.data(); c != end; ++c) {
    body_.push_back(static_cast<std::uint8_t>(*c >= 'a' ? *c - 'a' + 'A' : *c));
  }
  return *this;
}

Writer& Writer::f32(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if (dialect_ == Dialect::B) return put(bits, 4);
  next_field();
  for (int shift = 28; shift >= 0; shift -= 4) {
    body_.push_back(static_cast<std::uint8_t>("0123456789ABCDEF"[bits >> shift & 0xFU]));
  }
  return *this;
}

Writer& Writer::two_digits(std::uint8_t value) {
  if (dialect_ == Dialect::B) return u8(value);
  next_field();
  body_.push_back(static_cast<std::uint8_t>("0123456789ABCDEF"[value >> 4U]));
  body_.push_back(static_cast<std::uint8_t>("0123456789ABCDEF"[value & 0xFU]));
  return *this;
}

Writer& Writer::decimal(std::int64_t value, std::size_t bytes) {
  if (dialect_ == Dialect::B) return put(static_cast<std::uint32_t>(value), bytes);
  next_field();
  letters((value < 0 ? "" : "+") + std::to_string(value));
  return *this;
}

Writer& Writer::text(std::string_view text) {
  text = text.substr(0, 255);
  u8(static_cast<std::uint8_t>(text.size()));
  if (dialect_ == Dialect::A) body_.push_back(' ');
  letters(text);
  return *this;
}

Writer& Writer::word(std::string_view word, std::size_t length) {
  next_field();
  letters(word.substr(0, length));
  if (dialect_ == Dialect::B)
    body_.insert(body_.end(), length - std::min(length, word.size()), ' ');
  return *this;
}

}  // namespace roverd::sick
