#pragma once
// Texts that are not UTF-8. UTF-16 is told by its byte order mark, or, as every format that is read
// here begins with ASCII, by the zero byte beside the first character. Pure.

#include <string>
#include <string_view>

namespace roverd::mission {

/// A text as UTF-8; refers to `raw` unless that is UTF-16. What is no character becomes U+FFFD.
class Utf8Text {
 public:
  explicit Utf8Text(std::string_view raw);
  std::string_view text() const noexcept { return converted_ ? std::string_view(own_) : raw_; }

 private:
  std::string_view raw_;
  std::string own_;
  bool converted_ = false;
};

}  // namespace roverd::mission
