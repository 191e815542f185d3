#pragma once
// Names of places inside a JSON document (RFC 6901) and the bounded list of what is wrong there.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "mission/json/json.hpp"

namespace roverd::mission {

/// One step of a pointer. A very long key is cut (between characters) and ends in "...".
inline std::string escaped_key(std::string_view key) {
  constexpr std::size_t kMax = 200;
  std::size_t end = key.size();
  if (end > kMax) {
    end = kMax;
    while (end > 0 && (static_cast<unsigned char>(key[end]) & 0xC0u) == 0x80u) --end;
  }
  std::string out;
  for (const char c : key.substr(0, end)) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  if (end < key.size()) out += "...";
  return out;
}

/// Collects offending fields: the first kMaxFieldErrors by name, the others by number.
class Problems {
 public:
  void add(std::string pointer, std::string detail) {
    if (fields_.size() < kMaxFieldErrors) {
      fields_.push_back({std::move(pointer), std::move(detail)});
    }
    ++count_;
  }
  bool none() const noexcept { return count_ == 0; }
  std::size_t count() const noexcept { return count_; }

  /// Invalid; "the mission has 3 wrong values, first /items/3/lat must …".
  base::Error error(const std::string& subject) && {
    std::string front = subject + " has " + std::to_string(count_) +
                        (count_ == 1 ? " wrong value: " : " wrong values, first ");
    return {base::Code::Invalid, std::move(front) + first(), std::move(fields_)};
  }
  /// Invalid; "/speed_mps must …": the first of them.
  base::Error error() && { return {base::Code::Invalid, first(), std::move(fields_)}; }

 private:
  std::string first() const {
    if (fields_.empty()) return {};
    const std::string& place = fields_.front().pointer;
    return (place.empty() ? "the document" : place) + " " + fields_.front().detail;
  }

  std::vector<base::FieldError> fields_;
  std::size_t count_ = 0;
};

}  // namespace roverd::mission
