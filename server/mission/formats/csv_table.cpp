#include "mission/formats/csv_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace roverd::mission {
namespace {

/// More columns than any table of positions has; one more is kept to tell.
constexpr std::size_t kMostColumns = 256;

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

bool is_line_end(char c) noexcept {
  return c == '\n' || c == '\r';
}

}  // namespace

std::string CsvTable::place() const {
  return "line " + std::to_string(begun_ == 0 ? 1 : begun_);
}

/// Up to the line's end, which goes too.
std::string_view CsvTable::take_line() {
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : rest_.empty() ? 0 : 1);
  ++line_;
  return line;
}

bool CsvTable::next() {
  comment_ = {};
  fields_.clear();
  while (!rest_.empty() && !unclosed_) {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view line = without_blanks(rest_.substr(0, end));
    begun_ = line_ + 1;
    // Excel's word to itself: "sep=;".
    const bool sep = separator_ == '\0' && line.size() == 5 && line.starts_with("sep=");
    if (line.empty() || sep) {
      if (sep) separator_ = line.back();
      take_line();
      continue;
    }
    if (line.front() == '#') {
      comment_ = line;
      take_line();
      return true;
    }
    if (separator_ == '\0') choose_separator();
    read_fields();
    return !unclosed_;
  }
  return false;
}

void CsvTable::choose_separator() {
  std::size_t semicolons = 0;
  std::size_t tabs = 0;
  std::size_t commas = 0;
  bool quoted = false;
  for (const char c : rest_) {
    if (is_line_end(c) && !quoted) break;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    semicolons += c == ';' ? 1u : 0u;
    tabs += c == '\t' ? 1u : 0u;
    commas += c == ',' ? 1u : 0u;
  }
  separator_ = semicolons > 0 ? ';' : tabs > 0 ? '\t' : commas > 0 ? ',' : ' ';
}

void CsvTable::read_fields() {
  for (;;) {
    const char blank = separator_ == '\t' ? ' ' : '\t';
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == blank) &&
           rest_.front() != separator_) {
      rest_.remove_prefix(1);
    }
    if (separator_ == ' ') {
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
      if (rest_.empty() || is_line_end(rest_.front())) break;
    }
    CsvField field = rest_.starts_with('"') ? quoted_field() : plain_field();
    if (fields_.size() <= kMostColumns) fields_.push_back(field);
    if (rest_.empty() || is_line_end(rest_.front())) break;
    rest_.remove_prefix(1);  // the separator
  }
  take_line();
}

/// Doubled quotes stay doubled: no number has one.
CsvField CsvTable::quoted_field() {
  std::size_t at = 1;
  for (; at < rest_.size(); ++at) {
    if (rest_[at] == '\n' || (rest_[at] == '\r' && !rest_.substr(at).starts_with("\r\n"))) ++line_;
    if (rest_[at] != '"') continue;
    if (at + 1 >= rest_.size() || rest_[at + 1] != '"') break;
    ++at;
  }
  unclosed_ = at >= rest_.size();
  const CsvField field{without_blanks(rest_.substr(1, at - 1)), true};
  rest_.remove_prefix(std::min(at + 1, rest_.size()));
  // What follows a closing quote is no part of the field; blanks are common.
  plain_field();
  return field;
}

CsvField CsvTable::plain_field() {
  std::size_t end = 0;
  const auto ends = [this](char c) {
    return c == separator_ || is_line_end(c) || (separator_ == ' ' && c == '\t');
  };
  while (end < rest_.size() && !ends(rest_[end])) ++end;
  const CsvField field{without_blanks(rest_.substr(0, end)), false};
  rest_.remove_prefix(end);
  return field;
}

std::optional<double> CsvTable::number(const CsvField& field) const {
  std::array<char, 64> copy{};
  std::string_view text = field.text;
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.size() > copy.size()) return std::nullopt;
  const auto end = std::copy(text.begin(), text.end(), copy.begin());
  const bool commas = separator_ != ',' || field.quoted;
  if (commas && text.find('.') == std::string_view::npos) {
    const auto comma = std::find(copy.begin(), end, ',');
    if (comma != end) *comma = '.';
  }
  double value = 0.0;
  const auto [stop, ec] = std::from_chars(copy.data(), copy.data() + text.size(), value);
  if (ec != std::errc{} || stop != copy.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace roverd::mission
