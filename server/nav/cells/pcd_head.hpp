#pragma once
// What a PCD file says before its points, for its readers alone.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::nav::cells::pcd {

struct Field {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
  std::size_t bytes() const noexcept { return size * count; }
};

struct Header {
  std::vector<Field> fields;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  std::optional<std::uint32_t> points;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};
  std::string data;
  std::size_t lines = 0;
  std::size_t ends_at = 0;  // byte after it

  std::size_t row_bytes() const noexcept {
    std::size_t sum = 0;
    for (const Field& f : fields) sum += f.bytes();
    return sum;
  }
};

/// Malformed, named by line.
tl::unexpected<base::Error> wrong_line(std::size_t line, const std::string& what);

/// The next word of the line; empty at its end.
std::string_view next_word(std::string_view& rest);

/// The whole word as a number. @return false: it is none
bool read_number(std::string_view word, double& out);

/// @return Malformed with "line n"; TooLarge: more points than kMostPcdPoints
base::Result<Header> read_header(base::Bytes file);

}  // namespace roverd::nav::cells::pcd
