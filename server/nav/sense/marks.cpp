#include "nav/sense/marks.hpp"

#include <algorithm>

namespace roverd::nav::sense {

namespace {

constexpr std::uint64_t kEven = 0x5555'5555'5555'5555;
constexpr std::uint64_t kOdd = ~kEven;

/// Up to 64 cells, two bits each, the even ones apart from the odd ones; what is missing is
/// Unknown.
struct Pairs {
  std::uint64_t even = 0;
  std::uint64_t odd = 0;
};

Pairs pairs_of(const Patch::Cell* cells, std::size_t n) noexcept {
  static_assert(static_cast<int>(Known::Unknown) == 0 && static_cast<int>(Known::Free) == 1 &&
                static_cast<int>(Known::Occupied) == 2 && static_cast<int>(Known::Drop) == 3);
  Pairs p;
  const auto put = [](std::uint64_t& word, const Patch::Cell& cell) {
    word = (word >> 2U) | (static_cast<std::uint64_t>(cell.known) << 62U);
  };
  for (std::size_t i = 0; i + 1 < n; i += 2) {
    put(p.even, cells[i]);
    put(p.odd, cells[i + 1]);
  }
  if (n % 2 == 1) {
    put(p.even, cells[n - 1]);
    p.odd >>= 2U;
  }
  const std::size_t missing = 2 * (32 - (n + 1) / 2);
  if (missing > 0 && n > 0) {
    p.even >>= missing;
    p.odd >>= missing;
  }
  return p;
}

}  // namespace

void Marks::mark(const Patch& patch) {
  side_ = patch.side;
  x0_ = patch.x0;
  y0_ = patch.y0;
  const auto side = static_cast<std::size_t>(side_);
  words_ = (side + kBits - 1) / kBits;
  taken_.assign(side * words_, 0);
  // Beyond the patch all is unknown, so is what fills the last word of a row.
  near_[0].assign(side * words_, 0);
  for (std::size_t y = 0; y < side; ++y) {
    const Patch::Cell* row = patch.cells.data() + y * side;
    for (std::size_t w = 0; w < words_; ++w) {
      const std::size_t from = w * kBits;
      const Pairs p = pairs_of(row + from, std::min(kBits, side - from));
      taken_[y * words_ + w] = ((p.even >> 1) & kEven) | (p.odd & kOdd);
      near_[0][y * words_ + w] =
          (~(p.even | (p.even >> 1)) & kEven) | (~(p.odd | (p.odd << 1)) & kOdd);
    }
  }
  for (std::size_t k = 1; k < kAbout.size(); ++k) widen(k);
}

/// What lies within n cells lies within m cells of what lies within n - m: squares add up. As every
/// run of bits is 2 (n - m) + 1 long at least, three shifts leave no hole.
void Marks::widen(std::size_t k) {
  const auto by = static_cast<std::size_t>(kAbout[k] - kAbout[k - 1]);
  const auto side = static_cast<std::size_t>(side_);
  const std::vector<Word>& from = near_[k - 1];
  wide_.resize(from.size());
  for (std::size_t y = 0; y < side; ++y) {
    const Word* in = from.data() + y * words_;
    Word* out = wide_.data() + y * words_;
    Word before = ~Word{0};
    for (std::size_t w = 0; w < words_; ++w) {
      const Word after = w + 1 < words_ ? in[w + 1] : ~Word{0};
      out[w] = in[w] | (in[w] << by) | (before >> (kBits - by)) | (in[w] >> by) |
               (after << (kBits - by));
      before = in[w];
    }
  }
  std::vector<Word>& to = near_[k];
  to.assign(from.size(), ~Word{0});
  for (std::size_t y = by; y + by < side; ++y) {
    const Word* low = wide_.data() + (y - by) * words_;
    const Word* middle = wide_.data() + y * words_;
    const Word* high = wide_.data() + (y + by) * words_;
    Word* out = to.data() + y * words_;
    for (std::size_t w = 0; w < words_; ++w) out[w] = low[w] | middle[w] | high[w];
  }
}

}  // namespace roverd::nav::sense
