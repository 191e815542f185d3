#include "announce/service.hpp"

#include <algorithm>

namespace roverd::announce {
namespace {

constexpr std::size_t kLongestLabel = 63;
constexpr std::size_t kLongestFact = 255;

/// Not within a character.
std::string cut(std::string_view text, std::size_t most) {
  std::size_t end = std::min(text.size(), most);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;
  return std::string(text.substr(0, end));
}

}  // namespace

std::string numbered(std::string_view name, int which) {
  const std::string number = which > 1 ? "-" + std::to_string(which) : "";
  return cut(name, kLongestLabel - number.size()) + number;
}

std::vector<std::string> txt_of(const Service& service) {
  std::vector<std::string> out;
  for (const auto& [key, value] : service.facts)
    out.push_back(cut(key + "=" + value, kLongestFact));
  return out;
}

std::string wire_name(std::string_view host) {
  std::string out;
  while (!host.empty()) {
    const std::size_t dot = std::min(host.find('.'), host.size());
    const std::string label = cut(host.substr(0, dot), kLongestLabel);
    if (!label.empty()) out += static_cast<char>(label.size()) + label;
    host.remove_prefix(std::min(dot + 1, host.size()));
  }
  return out + '\0';
}

}  // namespace roverd::announce
