#pragma once
// QR codes, for a screen and for a terminal. Pure.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

namespace roverd::pair {

/// A square of dark and light modules, row by row, without the light border.
struct Code {
  std::size_t width = 0;
  std::vector<bool> dark{};

  bool at(std::size_t row, std::size_t column) const { return dark[row * width + column]; }
};

/// Errors: Invalid (empty, or longer than a QR code can say: about 2,300 bytes).
base::Result<Code> qr_code(std::string_view text);

/// With its border of four modules; black on white, whatever lies below.
std::string svg_of(const Code& code);
/// Two rows of modules a line, by half blocks; black on white by the terminal's colours.
std::string terminal_text_of(const Code& code);

}  // namespace roverd::pair
