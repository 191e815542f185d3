#include "nav/marks/source.hpp"

namespace roverd::nav::marks {

std::string_view to_string(Source s) noexcept {
  return s == Source::Scan ? "scan" : "vision";
}

std::string_view to_string(By by) noexcept {
  switch (by) {
    case By::Scan:
      return to_string(Source::Scan);
    case By::Vision:
      return to_string(Source::Vision);
    case By::Auto:
      break;
  }
  return "auto";
}

std::optional<By> by_from(std::string_view word) noexcept {
  for (const By by : {By::Auto, By::Scan, By::Vision}) {
    if (word == to_string(by)) return by;
  }
  return std::nullopt;
}

}  // namespace roverd::nav::marks
