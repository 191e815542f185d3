#include "sick/cola.hpp"

#include <algorithm>

namespace roverd::sick {
namespace {

constexpr std::uint8_t kStx = 0x02;
constexpr std::uint8_t kEtx = 0x03;
constexpr std::size_t kMagic = 4;
constexpr std::size_t kHeader = 8;
constexpr std::size_t kShortest = 3;  // "sFA"

}  // namespace

std::string_view to_string(Dialect d) noexcept {
  return d == Dialect::A ? "CoLa A" : "CoLa B";
}

std::vector<std::uint8_t> frame(Dialect dialect, Bytes body) {
  std::vector<std::uint8_t> out;
  out.reserve(body.size() + kHeader + 1);
  if (dialect == Dialect::A) {
    out.push_back(kStx);
    out.insert(out.end(), body.begin(), body.end());
    out.push_back(kEtx);
    return out;
  }
  out.assign(kMagic, kStx);
  for (int shift = 24; shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(body.size() >> shift));
  }
  out.insert(out.end(), body.begin(), body.end());
  std::uint8_t sum = 0;
  for (const std::uint8_t b : body) sum = static_cast<std::uint8_t>(sum ^ b);
  out.push_back(sum);
  return out;
}

void Framer::append(Bytes bytes) {
  for (const std::uint8_t b : bytes) {
    bytes_.push_back(b);
    sums_.push_back(static_cast<std::uint8_t>(sums_.back() ^ b));
  }
}

void Framer::forget() noexcept {
  counts_.skipped_bytes += bytes_.size() - head_;
  head_ = bytes_.size();
  looked_ = 0;
}

void Framer::drop_used() {
  const auto used = static_cast<std::ptrdiff_t>(head_);
  dropped_ += head_;
  bytes_.erase(bytes_.begin(), bytes_.begin() + used);
  sums_.erase(sums_.begin(), sums_.begin() + used);
  looked_ = looked_ > head_ ? looked_ - head_ : 0;
  head_ = 0;
}

void Framer::skip(std::size_t n) noexcept {
  head_ += n;
  looked_ = 0;
  counts_.skipped_bytes += n;
}

/// At head_, at most four.
std::size_t Framer::run_of_stx() const noexcept {
  std::size_t n = 0;
  while (n < kMagic && head_ + n < bytes_.size() && bytes_[head_ + n] == kStx) ++n;
  return n;
}

std::optional<Telegram> Framer::next() {
  for (;;) {
    const auto from = bytes_.begin() + static_cast<std::ptrdiff_t>(head_);
    const auto stx = std::find(from, bytes_.end(), kStx);
    if (stx != from) skip(static_cast<std::size_t>(stx - from));
    const std::size_t run = run_of_stx();
    if (run == bytes_.size() - head_ && run < kMagic) return {};
    Telegram out;
    switch (run == kMagic ? look_binary(out) : look_text(run, out)) {
      case Look::Found:
        ++counts_.telegrams;
        looked_ = 0;
        return out;
      case Look::More:
        return {};
      case Look::Again:
        break;
    }
  }
}

Framer::Look Framer::look_binary(Telegram& out) {
  const std::size_t there = bytes_.size() - head_;
  if (there < kHeader) return Look::More;
  std::size_t length = 0;
  for (std::size_t i = kMagic; i < kHeader; ++i) length = length << 8U | bytes_[head_ + i];
  if (length > kMaxBody || length < kShortest) {
    ++counts_.bad_length;
    skip(1);
    return Look::Again;
  }
  if (there < kHeader + length + 1) return Look::More;
  const std::size_t begin = head_ + kHeader;
  const std::size_t end = begin + length;
  if ((sums_[begin] ^ sums_[end]) != bytes_[end]) {
    ++counts_.bad_checksum;
    skip(1);
    return Look::Again;
  }
  out = {Dialect::B, Bytes(bytes_).subspan(begin, length)};
  head_ = end + 1;
  return Look::Found;
}

Framer::Look Framer::look_text(std::size_t run, Telegram& out) {
  const std::size_t begin = head_ + run;
  if (bytes_[begin] != 's') {  // every telegram's first letter
    skip(run);
    return Look::Again;
  }
  for (std::size_t i = std::max(begin, looked_); i < bytes_.size(); ++i) {
    const std::uint8_t b = bytes_[i];
    if (i - begin > kMaxBody) {
      ++counts_.bad_length;
      skip(i - head_);
      return Look::Again;
    }
    if (b >= 0x20) continue;
    if (b != kEtx || i - begin < kShortest) {
      ++counts_.cut;
      skip(i - head_);
      return Look::Again;
    }
    counts_.skipped_bytes += run - 1;
    out = {Dialect::A, Bytes(bytes_).subspan(begin, i - begin)};
    head_ = i + 1;
    return Look::Found;
  }
  looked_ = bytes_.size();
  return Look::More;
}

}  // namespace roverd::sick
