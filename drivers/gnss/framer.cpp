#include "gnss/framer.hpp"

#include <algorithm>
#include <cstring>

#include "rtcm/crc24q.hpp"

namespace roverd::gnss {

namespace {

constexpr std::uint8_t kUbx1 = 0xB5;
constexpr std::uint8_t kUbx2 = 0x62;
constexpr std::uint8_t kRtcm3 = 0xD3;

/// Bytes that end or interrupt a line: all but printable ASCII without '$'.
constexpr std::array<bool, 256> kSpecial = [] {
  std::array<bool, 256> special{};
  for (std::size_t c = 0; c < special.size(); ++c) special[c] = c < 0x20 || c > 0x7E || c == '$';
  return special;
}();

/// 8-bit Fletcher over class, id, length and payload.
bool ubx_checksum_is_right(Bytes frame) noexcept {
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  for (const std::uint8_t c : frame.subspan(2, frame.size() - 4)) {
    a = static_cast<std::uint8_t>(a + c);
    b = static_cast<std::uint8_t>(b + a);
  }
  return frame[frame.size() - 2] == a && frame[frame.size() - 1] == b;
}

constexpr bool is_line_end(std::uint8_t c) noexcept {
  return c == '\r' || c == '\n' || c == 0;
}

}  // namespace

std::size_t Framer::take(Bytes bytes, Time now) noexcept {
  compact();
  const std::size_t n = std::min(bytes.size(), buffer_.size() - end_);
  std::memcpy(buffer_.data() + end_, bytes.data(), n);
  end_ += n;
  counts_.bytes += n;
  const std::uint64_t stream_end = dropped_ + end_;
  // With no room for another mark the bytes count as having come with those before them.
  if (mark_count_ == marks_.size()) {
    marks_.back().end = stream_end;
  } else {
    marks_[mark_count_++] = {stream_end, now};
  }
  return n;
}

void Framer::compact() noexcept {
  std::memmove(buffer_.data(), buffer_.data() + at_, waiting());
  dropped_ += at_;
  end_ -= at_;
  at_ = 0;
  const auto first = std::find_if(marks_.begin(), marks_.begin() + mark_count_,
                                  [&](const Mark& m) { return m.end > dropped_; });
  mark_count_ = static_cast<std::size_t>(
      std::move(first, marks_.begin() + mark_count_, marks_.begin()) - marks_.begin());
}

Time Framer::stamp_of(std::size_t at) const noexcept {
  for (std::size_t i = 0; i < mark_count_; ++i) {
    if (dropped_ + at < marks_[i].end) return marks_[i].stamp;
  }
  return {};
}

bool Framer::next(Cut& cut) noexcept {
  while (at_ < end_) {
    Look look = Look::Skip;
    const std::uint8_t first = buffer_[at_];
    if (first == '$') {
      look = look_line(cut);
    } else if (first == kUbx1) {
      look = look_ubx(cut);
    } else if (first == kRtcm3) {
      look = look_rtcm3(cut);
    }
    if (look == Look::Cut) {
      cut.end = position();
      return true;
    }
    if (look == Look::More) return false;
    if (!is_line_end(first)) ++counts_.skipped_bytes;
    ++at_;
  }
  return false;
}

Framer::Look Framer::look_line(Cut& cut) noexcept {
  std::size_t i = at_ + std::max<std::size_t>(scanned_, 1);
  for (;; ++i) {
    while (i < end_ && !kSpecial[buffer_[i]]) ++i;
    if (i - at_ > kMaxLine) {
      finish_line(at_ + kMaxLine, Flaw::TooLong, cut);
      return Look::Cut;
    }
    if (i == end_) {
      scanned_ = i - at_;
      return Look::More;
    }
    const std::uint8_t c = buffer_[i];
    if (c == 0) {
      nul_ = true;
      continue;
    }
    if (c == '\r' || c == '\n') {
      finish_line(i, Flaw::None, cut);
    } else {
      finish_line(i, c == '$' ? Flaw::CutShort : Flaw::NotText, cut);
    }
    return Look::Cut;
  }
}

void Framer::finish_line(std::size_t stop, Flaw flaw, Cut& cut) noexcept {
  const auto* from = reinterpret_cast<const char*>(buffer_.data()) + at_ + 1;
  std::size_t n = stop - at_ - 1;
  if (nul_) {
    n = static_cast<std::size_t>(
        std::copy_if(from, from + n, line_.begin(), [](char c) { return c != 0; }) - line_.begin());
    from = line_.data();
  }
  cut = {.piece = flaw == Flaw::None ? Piece::Line : Piece::Broken,
         .flaw = flaw,
         .text = {from, n},
         .stamp = stamp_of(at_)};
  at_ = stop;
  scanned_ = 0;
  nul_ = false;
}

Framer::Look Framer::look_ubx(Cut& cut) noexcept {
  if (waiting() < 2) return Look::More;
  if (buffer_[at_ + 1] != kUbx2) return Look::Skip;
  if (waiting() < 6) return Look::More;
  const std::size_t payload = buffer_[at_ + 4] | (std::size_t{buffer_[at_ + 5]} << 8U);
  if (payload > kMaxUbxPayload) return look_binary(0, false, Piece::Ubx, cut);
  const std::size_t total = payload + 8;
  if (waiting() < total) return Look::More;
  return look_binary(total, ubx_checksum_is_right({buffer_.data() + at_, total}), Piece::Ubx, cut);
}

Framer::Look Framer::look_rtcm3(Cut& cut) noexcept {
  if (waiting() < 3) return Look::More;
  if ((buffer_[at_ + 1] & 0xFCU) != 0) return Look::Skip;  // six reserved bits
  const std::size_t payload = (std::size_t{buffer_[at_ + 1]} << 8U) | buffer_[at_ + 2];
  const std::size_t total = payload + 6;
  if (waiting() < total) return Look::More;
  // The CRC over the frame and its own CRC is zero.
  const bool good = rtcm::crc24q({buffer_.data() + at_, total}) == 0;
  return look_binary(total, good, Piece::Rtcm3, cut);
}

Framer::Look Framer::look_binary(std::size_t total, bool good, Piece piece, Cut& cut) noexcept {
  if (!good) {
    ++counts_.broken_binary;
    return Look::Skip;
  }
  cut = {.piece = piece, .bytes = {buffer_.data() + at_, total}, .stamp = stamp_of(at_)};
  at_ += total;
  return Look::Cut;
}

bool Framer::stalled_since(Time then) const noexcept {
  return at_ < end_ && (buffer_[at_] == kUbx1 || buffer_[at_] == kRtcm3) && stamp_of(at_) <= then;
}

void Framer::skip_first() noexcept {
  ++counts_.skipped_bytes;
  ++at_;
}

}  // namespace roverd::gnss
