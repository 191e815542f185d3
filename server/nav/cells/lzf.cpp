#include "nav/cells/lzf.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace roverd::nav::cells {

namespace {

constexpr std::size_t kMostLiterals = 32;
constexpr std::size_t kMostCopied = 264;
constexpr std::size_t kHashBits = 14;

tl::unexpected<base::Error> wrong_at(std::size_t byte, const std::string& what) {
  return base::fail(base::Code::Malformed, "packed data: " + what,
                    {{"byte " + std::to_string(byte), what}});
}

void put_literals(base::Bytes plain, std::size_t from, std::size_t to,
                  std::vector<std::uint8_t>& out) {
  while (from < to) {
    const std::size_t run = std::min(to - from, kMostLiterals);
    out.push_back(static_cast<std::uint8_t>(run - 1));
    const auto part = plain.subspan(from, run);
    out.insert(out.end(), part.begin(), part.end());
    from += run;
  }
}

void put_copy(std::size_t length, std::size_t back, std::vector<std::uint8_t>& out) {
  const std::size_t l = length - 2;
  const std::size_t d = back - 1;
  out.push_back(static_cast<std::uint8_t>(std::min<std::size_t>(l, 7) << 5U | d >> 8U));
  if (l >= 7) out.push_back(static_cast<std::uint8_t>(l - 7));
  out.push_back(static_cast<std::uint8_t>(d & 0xFFU));
}

}  // namespace

base::Result<void> LzfStream::next_run() {
  begun_ = at_;
  if (at_ == packed_.size()) return wrong_at(begun_, "less comes out than was said");
  const std::size_t control = packed_[at_++];
  if (control < kMostLiterals) {
    if (control + 1 > packed_.size() - at_) return wrong_at(begun_, "ends within literals");
    literals_ = control + 1;
    return {};
  }
  std::size_t length = control >> 5U;
  if (length == 7 && at_ < packed_.size()) length += packed_[at_++];
  if (at_ >= packed_.size()) return wrong_at(begun_, "ends within a copy");
  const std::size_t back = ((control & 31U) << 8U | packed_[at_++]) + 1;
  if (back > out_) return wrong_at(begun_, "copies from before the beginning");
  copied_ = length + 2;
  back_ = back;
  return {};
}

std::size_t LzfStream::take_literals(std::uint8_t* out, std::size_t most) noexcept {
  const std::size_t run = std::min(literals_, most);
  for (std::size_t k = 0; k < run; ++k) last_[out_++ % kLzfFarthest] = packed_[at_ + k];
  if (out != nullptr) std::copy_n(packed_.data() + at_, run, out);
  at_ += run;
  literals_ -= run;
  return run;
}

/// Byte by byte: what is copied may be what was just written.
std::size_t LzfStream::take_copied(std::uint8_t* out, std::size_t most) noexcept {
  const std::size_t run = std::min(copied_, most);
  for (std::size_t k = 0; k < run; ++k, ++out_) {
    const std::uint8_t byte = last_[(out_ - back_) % kLzfFarthest];
    last_[out_ % kLzfFarthest] = byte;
    if (out != nullptr) out[k] = byte;
  }
  copied_ -= run;
  return run;
}

base::Result<void> LzfStream::read(std::uint8_t* out, std::size_t size_bytes) {
  while (size_bytes > 0) {
    if (literals_ + copied_ == 0) {
      if (auto begun = next_run(); !begun) return begun;
    }
    const std::size_t run =
        literals_ > 0 ? take_literals(out, size_bytes) : take_copied(out, size_bytes);
    if (out != nullptr) out += run;
    size_bytes -= run;
  }
  return {};
}

namespace {

base::Result<void> can_hold(base::Bytes packed, std::size_t size_bytes) {
  if (size_bytes / kLzfMostTimes <= packed.size()) return {};
  return wrong_at(
      0, std::to_string(packed.size()) + " bytes cannot hold " + std::to_string(size_bytes));
}

base::Result<void> read_all(base::Bytes packed, std::uint8_t* out, std::size_t size_bytes) {
  LzfStream stream(packed);
  if (auto read = stream.read(out, size_bytes); !read) return read;
  if (!stream.ended()) return wrong_at(stream.at(), "more comes out than was said");
  return {};
}

}  // namespace

base::Result<void> check_lzf(base::Bytes packed, std::size_t size_bytes) {
  if (auto can = can_hold(packed, size_bytes); !can) return can;
  return read_all(packed, nullptr, size_bytes);
}

base::Result<std::vector<std::uint8_t>> unpack_lzf(base::Bytes packed, std::size_t size_bytes) {
  if (auto can = can_hold(packed, size_bytes); !can)
    return tl::unexpected<base::Error>(can.error());
  std::vector<std::uint8_t> out(size_bytes);
  if (auto read = read_all(packed, out.data(), size_bytes); !read) {
    return tl::unexpected<base::Error>(read.error());
  }
  return out;
}

std::vector<std::uint8_t> pack_lzf(base::Bytes plain) {
  std::vector<std::uint8_t> out;
  out.reserve(plain.size() + plain.size() / kMostLiterals + 1);
  std::vector<std::size_t> last(std::size_t{1} << kHashBits, plain.size());  // place of three bytes
  std::size_t waiting = 0;  // first literal not out
  std::size_t i = 0;
  while (i + 3 <= plain.size()) {
    const std::uint32_t three = static_cast<std::uint32_t>(plain[i]) << 16U |
                                static_cast<std::uint32_t>(plain[i + 1]) << 8U | plain[i + 2];
    std::size_t& slot = last[three * 2654435769U >> (32U - kHashBits)];
    const std::size_t before = slot;
    slot = i;
    std::size_t length = 0;
    if (before < i && i - before <= kLzfFarthest) {
      const std::size_t most = std::min(plain.size() - i, kMostCopied);
      while (length < most && plain[before + length] == plain[i + length]) ++length;
    }
    if (length < 3) {
      ++i;
      continue;
    }
    put_literals(plain, waiting, i, out);
    put_copy(length, i - before, out);
    i += length;
    waiting = i;
  }
  put_literals(plain, waiting, plain.size(), out);
  return out;
}

}  // namespace roverd::nav::cells
