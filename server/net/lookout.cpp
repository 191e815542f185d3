#include "net/lookout.hpp"

#include <algorithm>

namespace roverd::net {

namespace {

constexpr std::uint8_t kWholeText = 0x81;
constexpr std::uint8_t kReservedBits = 0x70;
constexpr std::uint8_t kMasked = 0x80;
constexpr std::uint8_t kTwoBytes = 126;

}  // namespace

void Lookout::feed(std::string_view bytes, const std::function<void(std::string_view)>& see) {
  while (!bytes.empty() && phase_ != Phase::Blind) {
    const bool skips = phase_ == Phase::Payload && !shown_;
    const std::size_t n =
        skips ? static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size())) : 1;
    if (skips) {
      left_ -= n;
      if (left_ == 0) end_frame(see);
    } else {
      byte(static_cast<std::uint8_t>(bytes.front()), see);
    }
    bytes.remove_prefix(n);
  }
}

void Lookout::byte(std::uint8_t b, const std::function<void(std::string_view)>& see) {
  switch (phase_) {
    case Phase::Head:
      if (head_bytes_++ == 0) {
        shown_ = b == kWholeText;
        if ((b & kReservedBits) != 0) phase_ = Phase::Blind;
        return;
      }
      head_bytes_ = 0;
      if ((b & kMasked) == 0) {
        phase_ = Phase::Blind;
        return;
      }
      length_ = b & 0x7FU;
      left_ = length_ < kTwoBytes ? 0 : length_ == kTwoBytes ? 2 : 8;
      shown_ = shown_ && left_ == 0;
      phase_ = left_ > 0 ? Phase::Length : Phase::Mask;
      if (left_ > 0) length_ = 0;
      if (left_ == 0) left_ = mask_.size();
      return;
    case Phase::Length:
      length_ = length_ << 8U | b;
      if (--left_ > 0) return;
      phase_ = Phase::Mask;
      left_ = mask_.size();
      return;
    case Phase::Mask:
      mask_[mask_.size() - left_] = b;
      if (--left_ == 0) begin_payload(see);
      return;
    case Phase::Payload:
      text_.push_back(static_cast<char>(b ^ mask_[at_++ % mask_.size()]));
      if (--left_ == 0) end_frame(see);
      return;
    case Phase::Blind:
      return;
  }
}

void Lookout::begin_payload(const std::function<void(std::string_view)>& see) {
  phase_ = Phase::Payload;
  left_ = length_;
  at_ = 0;
  text_.clear();
  if (left_ == 0) end_frame(see);
}

void Lookout::end_frame(const std::function<void(std::string_view)>& see) {
  phase_ = Phase::Head;
  if (shown_) see(text_);
}

}  // namespace roverd::net
