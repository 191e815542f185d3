#pragma once
// What is told to the networks of this computer (DNS-SD). Pure.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roverd::announce {

struct Service {
  std::string name;   ///< for people: "kask"
  std::string label;  ///< as DNS knows it: "kask", found as kask.local
  std::uint16_t port = 0;
  std::vector<std::pair<std::string, std::string>> facts{};  ///< of the TXT record
  friend bool operator==(const Service&, const Service&) = default;
};

/// Another robot has that name: "kask-2", "kask-3" … At most 63 bytes, whole UTF-8 characters.
/// @param which from 1, which is the name itself
std::string numbered(std::string_view name, int which);
/// "key=value", as a TXT record holds it: at most 255 bytes, the rest is cut off.
std::vector<std::string> txt_of(const Service& service);
/// As the record of an alias holds it: "a.local" is "\1a\5local\0".
std::string wire_name(std::string_view host);

}  // namespace roverd::announce
