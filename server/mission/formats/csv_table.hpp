#pragma once
// The records of a table in text: fields apart by comma, semicolon, tab or blanks, as its first
// record shows; fields may be in quotes (RFC 4180), and then hold separators and line ends.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roverd::mission {

struct CsvField {
  std::string_view text;  ///< without its quotes and the blanks around it
  bool quoted = false;
};

class CsvTable {
 public:
  explicit CsvTable(std::string_view content) : rest_(content) {}

  /// The next record that is not blank; false: there is none, or a quote stands open.
  bool next();
  const std::vector<CsvField>& fields() const noexcept { return fields_; }
  /// The record is a comment: "# …". Empty if not.
  std::string_view comment() const noexcept { return comment_; }
  /// Where the record begins, "line 4"; without one "line 1".
  std::string place() const;
  /// A quote was opened in this record and not closed by the end of the text.
  bool unclosed() const noexcept { return unclosed_; }
  /// 0 before the first record
  char separator() const noexcept { return separator_; }

  /// A finite number. A decimal comma is one where commas do not part fields, or in quotes.
  std::optional<double> number(const CsvField& field) const;

 private:
  std::string_view take_line();
  void choose_separator();
  void read_fields();
  CsvField quoted_field();
  CsvField plain_field();

  std::string_view rest_;
  std::size_t line_ = 0;  ///< how many are behind `rest_`
  std::size_t begun_ = 0;
  std::vector<CsvField> fields_;
  std::string_view comment_;
  char separator_ = '\0';
  bool unclosed_ = false;
};

}  // namespace roverd::mission
