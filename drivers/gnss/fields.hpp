#pragma once
// The comma-separated fields of one sentence, and readers that remember the first field which was
// not what its column wants. Inner part of the NMEA codec.

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

#include "gnss/sentence.hpp"

namespace roverd::gnss {

/// Plain decimal: optional '-', digits with at most one point, at least one digit. Correctly
/// rounded. Empty result for anything else.
std::optional<double> decimal_from(std::string_view text) noexcept;
/// hhmmss[.s…] as seconds of the day.
std::optional<double> time_from(std::string_view text) noexcept;

class Fields {
 public:
  /// @param body everything between '$' and '*'. Fields after the 40th are counted, not kept.
  explicit Fields(std::string_view body) noexcept;

  std::string_view tag() const noexcept { return tag_; }
  /// Number of fields after the tag.
  std::size_t size() const noexcept { return size_; }
  /// Field i, counted from 1; empty beyond the last.
  std::string_view at(std::size_t i) const noexcept {
    return i >= 1 && i <= kept_ ? list_[i - 1] : std::string_view{};
  }
  /// The first bad field; 0: none yet.
  int bad() const noexcept { return bad_; }
  void refuse(std::size_t i) noexcept {
    if (bad_ == 0) bad_ = static_cast<int>(i);
  }

  /// Each reader gives an empty optional for an empty field, and refuses a wrong one.
  std::optional<double> number(std::size_t i, double lo = -std::numeric_limits<double>::infinity(),
                               double hi = std::numeric_limits<double>::infinity()) noexcept;
  std::optional<int> integer(std::size_t i, int lo = 0, int hi = 1'000'000) noexcept;
  std::optional<double> time(std::size_t i) noexcept { return read(i, time_from); }
  std::optional<double> latitude(std::size_t i) noexcept { return arc(i, 90.0, 'N', 'S'); }
  std::optional<double> longitude(std::size_t i) noexcept { return arc(i, 180.0, 'E', 'W'); }
  /// ddmmyy; 80-99 is 19yy, 00-79 is 20yy.
  std::optional<Date> date(std::size_t i) noexcept;
  /// A single character of `allowed`; 0 for an empty field.
  char letter(std::size_t i, std::string_view allowed) noexcept;
  /// Any single character; 0 for an empty field.
  char any_letter(std::size_t i) noexcept;

 private:
  std::optional<double> read(std::size_t i,
                             std::optional<double> (*from)(std::string_view) noexcept) noexcept;
  std::optional<double> arc(std::size_t i, double limit, char positive, char negative) noexcept;

  std::string_view tag_{};
  std::array<std::string_view, 40> list_{};
  std::size_t kept_ = 0;
  std::size_t size_ = 0;
  int bad_ = 0;
};

}  // namespace roverd::gnss
