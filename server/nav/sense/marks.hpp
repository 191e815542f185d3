#pragma once
// A patch in bits, for who asks it in every control tick: which cells are taken, and how far from a
// cell nothing is unknown. Made beside the patch by who made that; 100 kB for 280 x 280 cells, of
// which a look reads a few lines.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "nav/sense/grid.hpp"

namespace roverd::nav::sense {

/// Not shared between threads while it is made; then read by any.
class Marks {
 public:
  /// About 40 us for 280 x 280 cells. @param patch its cells are a square of its side
  void mark(const Patch& patch);
  /// They were made of a patch of this place and size.
  bool fit(const Patch& patch) const noexcept {
    return side_ > 0 && side_ == patch.side && x0_ == patch.x0 && y0_ == patch.y0;
  }

  bool unknown(std::int32_t ix, std::int32_t iy) const noexcept { return near(0, ix, iy); }
  /// So many cells from this one, to all sides (the corners of the square, too), none is unknown:
  /// never more than there are, and kMost at most. Outside of the patch all is unknown.
  int seen_about(std::int32_t ix, std::int32_t iy) const noexcept {
    for (std::size_t k = kAbout.size(); k-- > 1;) {
      if (!near(k, ix, iy)) return kAbout[k];
    }
    return 0;
  }

  /// Calls back with (ix, iy) of every cell of the rectangle, its edges too, that is Occupied or
  /// Drop; row by row, upwards. The rectangle lies within the patch.
  template <class Each>
  void each_taken(std::int32_t x_from, std::int32_t x_to, std::int32_t y_from, std::int32_t y_to,
                  const Each& each) const noexcept {
    if (x_from > x_to) return;
    const auto low = static_cast<std::size_t>(x_from - x0_);
    const auto high = static_cast<std::size_t>(x_to - x0_);
    for (std::int32_t iy = y_from; iy <= y_to; ++iy) {
      const Word* row = taken_.data() + static_cast<std::size_t>(iy - y0_) * words_;
      for (std::size_t w = low / kBits; w <= high / kBits; ++w) {
        Word bits = row[w];
        if (w == low / kBits) bits &= ~Word{0} << (low % kBits);
        if (w == high / kBits) bits &= ~Word{0} >> (kBits - 1 - high % kBits);
        for (; bits != 0; bits &= bits - 1) {
          const auto x = w * kBits + static_cast<std::size_t>(std::countr_zero(bits));
          each(x0_ + static_cast<std::int32_t>(x), iy);
        }
      }
    }
  }

  /// Told apart by seen_about(). Each at most three times the one before, and one.
  static constexpr std::array<int, 10> kAbout{0, 1, 2, 4, 6, 8, 12, 16, 24, 32};
  static constexpr int kMost = kAbout.back();

 private:
  using Word = std::uint64_t;
  static constexpr std::size_t kBits = 64;

  /// Within kAbout[k] cells of it one is unknown.
  bool near(std::size_t k, std::int32_t ix, std::int32_t iy) const noexcept {
    const auto x = static_cast<std::uint32_t>(ix - x0_);
    const auto y = static_cast<std::uint32_t>(iy - y0_);
    if (x >= static_cast<std::uint32_t>(side_) || y >= static_cast<std::uint32_t>(side_)) {
      return true;
    }
    return ((near_[k][y * words_ + x / kBits] >> (x % kBits)) & 1U) != 0;
  }
  void widen(std::size_t k);

  std::int32_t side_ = 0;
  std::int32_t x0_ = 0;
  std::int32_t y0_ = 0;
  std::size_t words_ = 0;  ///< a row
  std::vector<Word> taken_;
  std::array<std::vector<Word>, kAbout.size()> near_;
  std::vector<Word> wide_;  ///< along the rows only
};

}  // namespace roverd::nav::sense
