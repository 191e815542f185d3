#pragma once
// What the sentences of the failsafes and of the checks are made of. Pure.

#include <cstdio>
#include <optional>
#include <string>

#include "base/measurements.hpp"
#include "base/time.hpp"

namespace roverd::robot {

/// @param format of printf, for one double.
inline std::string number(double value, const char* format) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Never counts as older than any limit.
inline bool older(std::optional<base::Time> stamp, double limit_s, base::Time now) noexcept {
  return !stamp || base::seconds(now - *stamp) > limit_s;
}

inline std::string error_words(const base::BaseStatus& status) {
  std::string text;
  for (const std::string& e : status.errors) text += (text.empty() ? "" : ", ") + e;
  return text.empty() ? "no error bit set" : text;
}

inline std::string in_brackets(const std::string& where) {
  return where.empty() ? "" : " (" + where + ")";
}

}  // namespace roverd::robot
