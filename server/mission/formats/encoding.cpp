#include "mission/formats/encoding.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace roverd::mission {
namespace {

enum class Order { Little, Big };

std::optional<Order> order_of(std::string_view raw) {
  if (raw.size() < 2) return std::nullopt;
  if (raw[0] == '\xFF' && raw[1] == '\xFE') return Order::Little;
  if (raw[0] == '\xFE' && raw[1] == '\xFF') return Order::Big;
  if (raw[0] != '\0' && raw[1] == '\0') return Order::Little;
  if (raw[0] == '\0' && raw[1] != '\0') return Order::Big;
  return std::nullopt;
}

void append_utf8(std::string& out, unsigned code) {
  const auto put = [&out](unsigned byte) { out += static_cast<char>(byte); };
  const auto rest = [&](unsigned shift) { put(0x80u | ((code >> shift) & 0x3Fu)); };
  if (code < 0x80u) return put(code);
  if (code < 0x800u) {
    put(0xC0u | (code >> 6u));
  } else if (code < 0x10000u) {
    put(0xE0u | (code >> 12u));
    rest(6u);
  } else {
    put(0xF0u | (code >> 18u));
    rest(12u);
    rest(6u);
  }
  rest(0u);
}

std::string from_utf16(std::string_view raw, Order order) {
  constexpr unsigned kMark = 0xFEFF;
  constexpr unsigned kUnknown = 0xFFFD;
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(raw[at]);
    const auto second = static_cast<unsigned char>(raw[at + 1]);
    return order == Order::Little ? first | unsigned{second} << 8u : second | unsigned{first} << 8u;
  };
  std::string out;
  out.reserve(raw.size() / 2);
  for (std::size_t at = 0; at + 1 < raw.size(); at += 2) {
    unsigned code = unit(at);
    if (at == 0 && code == kMark) continue;
    if (code >= 0xD800 && code < 0xE000) {
      const unsigned low = at + 3 < raw.size() ? unit(at + 2) : 0;
      const bool pair = code < 0xDC00 && low >= 0xDC00 && low < 0xE000;
      code = pair ? 0x10000u + ((code - 0xD800u) << 10u) + (low - 0xDC00u) : kUnknown;
      if (pair) at += 2;
    }
    append_utf8(out, code);
  }
  if (raw.size() % 2 == 1) append_utf8(out, kUnknown);
  return out;
}

/// The text is UTF-8 now, whatever its XML declaration says: blanks in its place.
void drop_xml_declaration(std::string& text) {
  if (!text.starts_with("<?xml")) return;
  const std::size_t end = text.find("?>");
  if (end == std::string::npos) return;
  std::replace_if(
      text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end) + 2,
      [](char c) { return c != '\n' && c != '\r'; }, ' ');
}

}  // namespace

Utf8Text::Utf8Text(std::string_view raw) : raw_(raw) {
  const auto order = order_of(raw);
  if (!order) return;
  own_ = from_utf16(raw, *order);
  drop_xml_declaration(own_);
  converted_ = true;
}

}  // namespace roverd::mission
