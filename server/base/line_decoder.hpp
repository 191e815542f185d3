#pragma once
// Messages that are a line each, out of bytes however they are cut: an unfinished line waits, an
// endless one is dropped, blank ones are no fault. Pure state; bounded.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/bytes.hpp"

namespace roverd::base {

/// @tparam kLongest bytes of a line. @tparam kParse a line without its end to a Message; empty: it
/// is none.
template <class Message, std::size_t kLongest,
          std::optional<Message> (*kParse)(std::string_view) noexcept>
class LineDecoder {
 public:
  /// @param on_message called with each intact one.
  template <class OnMessage>
  void feed(Bytes bytes, OnMessage&& on_message) {
    for (const std::uint8_t b : bytes) {
      if (b == '\n') {
        if (const auto message = line_done()) on_message(*message);
      } else if (size_ < line_.size()) {
        line_[size_++] = static_cast<char>(b);
      } else {
        too_long_ = true;
      }
    }
  }
  void forget() noexcept {
    size_ = 0;
    too_long_ = false;
  }
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  std::optional<Message> line_done() noexcept {
    std::string_view line(line_.data(), size_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool blank = line.empty() && !too_long_;
    const auto message = too_long_ ? std::nullopt : kParse(line);
    forget();
    if (!message && !blank) ++refused_;
    return message;
  }

  std::array<char, kLongest> line_{};
  std::size_t size_ = 0;
  bool too_long_ = false;
  std::uint64_t refused_ = 0;
};

}  // namespace roverd::base
