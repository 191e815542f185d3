#pragma once
// Words of headers are compared without regard to case. Beast's own iequals (1.81) reads one sign
// beyond words that differ in it.

#include <algorithm>
#include <string_view>

namespace roverd::base {

/// Equal but for the case of a to z. Pure.
constexpr bool same_word(std::string_view a, std::string_view b) noexcept {
  const auto lower = [](char sign) {
    return sign >= 'A' && sign <= 'Z' ? static_cast<char>(sign - 'A' + 'a') : sign;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char one, char other) { return lower(one) == lower(other); });
}

}  // namespace roverd::base
