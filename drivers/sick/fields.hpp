#pragma once
// What stands in a telegram after its frame: two words, then fields. The same walk reads and writes
// both dialects:
//
//   field   CoLa A                                                    CoLa B, big endian
//   u8 ...  hexadecimal; a leading + or − marks decimal               1, 2 or 4 bytes
//   i32     as u32, in two's complement; or decimal                   4 bytes
//   f32     8 hexadecimal digits of IEEE 754                          4 bytes
//   text    so many characters, blanks among them                     so many bytes
//   word    up to the next blank                                      a fixed number of bytes
//
// In CoLa A one blank stands between two fields, so two in a row are an empty field, which no
// number is. Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "sick/cola.hpp"

namespace roverd::sick {

/// Reads fields in order. The first error stays, and all that is read after it is 0; so a walk is
/// written without branches and asks at its end.
class Fields {
 public:
  /// @param body of a telegram. @param at where its fields begin.
  Fields(Dialect dialect, Bytes body, std::size_t at) noexcept;

  std::uint8_t u8(const char* field);
  std::uint16_t u16(const char* field);
  std::uint32_t u32(const char* field);
  std::int32_t i32(const char* field);
  /// Any float, NaN and infinities among them.
  float f32(const char* field);
  std::string text(const char* field, std::size_t length);
  /// @param length in CoLa B. In CoLa A: the longest that is taken.
  std::string word(const char* field, std::size_t length);

  /// So many more fields of so many bytes could follow. Otherwise that is the error.
  bool holds(const char* field, std::size_t count, std::size_t bytes_each);
  /// Nothing but a blank follows. Otherwise that is the error.
  bool ends();
  /// Names what is wrong, at the byte where the present field began.
  void refuse(const char* field, const char* problem);

  bool ok() const noexcept { return !error_; }
  const std::optional<base::Error>& error() const noexcept { return error_; }
  Dialect dialect() const noexcept { return dialect_; }

 private:
  std::string_view token(const char* field);
  std::uint64_t number(const char* field, std::size_t bytes, bool is_signed);

  const Dialect dialect_;
  const Bytes body_;
  std::size_t at_;
  std::size_t began_;
  bool more_;  ///< CoLa A: a field follows, be it an empty one
  std::optional<base::Error> error_;
};

/// The words of a telegram. Of an error reply (sFA) the name is empty and the field its code.
struct Words {
  std::string_view kind;  ///< "sRA"
  std::string_view name;  ///< "LMDscandata"
  std::size_t fields_at = 0;
};
/// Empty: there are none. The views are the telegram's.
std::optional<Words> words_of(const Telegram& telegram) noexcept;
/// The code of an sFA, of one or two bytes; 0: it holds none.
std::uint16_t error_code(const Telegram& telegram) noexcept;
/// 1 "access denied" … ; "error" where the code is unknown.
std::string_view error_words(std::uint16_t code) noexcept;

/// Writes a telegram field by field.
class Writer {
 public:
  /// @param kind "sMN" @param name empty: there is none (sFA)
  Writer(Dialect dialect, std::string_view kind, std::string_view name);

  Writer& u8(std::uint8_t value) { return put(value, 1); }
  Writer& u16(std::uint16_t value) { return put(value, 2); }
  Writer& u32(std::uint32_t value) { return put(value, 4); }
  Writer& i32(std::int32_t value) { return put(static_cast<std::uint32_t>(value), 4); }
  Writer& f32(float value);
  /// As u8, in CoLa A with two digits.
  Writer& two_digits(std::uint8_t value);
  /// As u16, u32, i32; in CoLa A decimal with its sign. @param bytes 1, 2 or 4
  Writer& decimal(std::int64_t value, std::size_t bytes);
  /// Length (u8), then the text: at most 255 characters, none of them a control character.
  Writer& text(std::string_view text);
  /// In CoLa B filled up or cut to its length.
  Writer& word(std::string_view word, std::size_t length);

  std::vector<std::uint8_t> framed() const { return frame(dialect_, body_); }
  Bytes body() const noexcept { return body_; }

 private:
  Writer& put(std::uint32_t value, std::size_t bytes);
  void letters(std::string_view text);
  void next_field();

  const Dialect dialect_;
  std::vector<std::uint8_t> body_;
  bool first_ = true;
};

}  // namespace roverd::sick
