#include "pair/code.hpp"

#include <memory>

#include <qrencode.h>

namespace roverd::pair {

namespace {

/// The light frame that a reader needs.
constexpr std::size_t kBorder = 4;
/// A terminal has few lines, and two are enough on a screen.
constexpr std::size_t kTerminalBorder = 2;

}  // namespace

base::Result<Code> qr_code(std::string_view text) {
  // Level M: a seventh of it may be dirty.
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> made(
      QRcode_encodeData(static_cast<int>(text.size()),
                        reinterpret_cast<const unsigned char*>(text.data()), 0, QR_ECLEVEL_M),
      &QRcode_free);
  if (!made) {
    return base::fail(base::Code::Invalid,
                      "no QR code holds " + std::to_string(text.size()) + " bytes");
  }
  Code code{static_cast<std::size_t>(made->width), {}};
  const std::size_t modules = code.width * code.width;
  code.dark.reserve(modules);
  for (std::size_t i = 0; i < modules; ++i) code.dark.push_back((made->data[i] & 1U) != 0);
  return code;
}

std::string svg_of(const Code& code) {
  const std::string side = std::to_string(code.width + 2 * kBorder);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + side + " " + side +
                    "\" shape-rendering=\"crispEdges\"><path fill=\"#fff\" d=\"M0 0h" + side + "v" +
                    side + "H0z\"/><path d=\"";
  for (std::size_t row = 0; row < code.width; ++row) {
    for (std::size_t column = 0; column < code.width; ++column) {
      if (!code.at(row, column)) continue;
      std::size_t end = column + 1;
      while (end < code.width && code.at(row, end)) ++end;
      svg += "M" + std::to_string(column + kBorder) + " " + std::to_string(row + kBorder) + "h" +
             std::to_string(end - column) + "v1H" + std::to_string(column + kBorder) + "z";
      column = end;
    }
  }
  return svg + "\"/></svg>\n";
}

std::string terminal_text_of(const Code& code) {
  constexpr std::string_view kBlackOnWhite = "\x1b[30;107m";
  constexpr std::string_view kAsBefore = "\x1b[0m\n";
  const std::size_t side = code.width + 2 * kTerminalBorder;
  const auto dark = [&code](std::size_t row, std::size_t column) {
    const std::size_t r = row - kTerminalBorder;  // wraps in the border, and is too large then
    const std::size_t c = column - kTerminalBorder;
    return r < code.width && c < code.width && code.at(r, c);
  };
  std::string text;
  for (std::size_t row = 0; row < side; row += 2) {
    text += kBlackOnWhite;
    for (std::size_t column = 0; column < side; ++column) {
      const bool upper = dark(row, column);
      const bool lower = dark(row + 1, column);
      text += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    text += kAsBefore;
  }
  return text;
}

}  // namespace roverd::pair
