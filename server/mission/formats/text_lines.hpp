#pragma once
// The lines of a text file, one by one.

#include <cstddef>
#include <string>
#include <string_view>

namespace roverd::mission {

/// Lines that end in LF, CRLF or CR.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find_first_of("\r\n");
    line = rest_.substr(0, end);
    ++number_;
    if (end == std::string_view::npos) {
      rest_ = {};
      return true;
    }
    const bool two = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(end + (two ? 2 : 1));
    return true;
  }
  /// Of the line given last: "line 4". Of a file without lines: "line 1".
  std::string place() const { return "line " + std::to_string(number_ == 0 ? 1 : number_); }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace roverd::mission
