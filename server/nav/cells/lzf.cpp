#include "nav/cells/lzf.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace roverd::nav::cells {

namespace {

constexpr std::size_t kMostLiterals = 32;
constexpr std::size_t kMostCopied = 264;
constexpr std::size_t kFarthest = 8192;
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

base::Result<std::vector<std::uint8_t>> unpack_lzf(base::Bytes packed, std::size_t size_bytes) {
  if (size_bytes / kLzfMostTimes > packed.size()) {
    return wrong_at(
        0, std::to_string(packed.size()) + " bytes cannot hold " + std::to_string(size_bytes));
  }
  std::vector<std::uint8_t> out;
  out.reserve(size_bytes);
  std::size_t i = 0;
  while (i < packed.size()) {
    const std::size_t at = i;
    const std::size_t control = packed[i++];
    if (control < kMostLiterals) {
      const std::size_t run = control + 1;
      if (run > packed.size() - i) return wrong_at(at, "ends within literals");
      if (run > size_bytes - out.size()) return wrong_at(at, "more comes out than was said");
      const auto part = packed.subspan(i, run);
      out.insert(out.end(), part.begin(), part.end());
      i += run;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7 && i < packed.size()) length += packed[i++];
    if (i >= packed.size()) return wrong_at(at, "ends within a copy");
    const std::size_t back = ((control & 31U) << 8U | packed[i++]) + 1;
    length += 2;
    if (back > out.size()) return wrong_at(at, "copies from before the beginning");
    if (length > size_bytes - out.size()) return wrong_at(at, "more comes out than was said");
    // Byte by byte: what is copied may be what was just written.
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size_bytes) return wrong_at(packed.size(), "less comes out than was said");
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
    if (before < i && i - before <= kFarthest) {
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
