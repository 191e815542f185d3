#pragma once
// LZF, the packing of `binary_compressed` PCD files. Bounded by what the caller says.
//
//   000lllll  l + 1 literal bytes follow
//   lllddddd [more] dddddddd   copy l + 2 bytes (l = 7: 9 + `more`) from d + 1 bytes back
// Source: the description in the head of liblzf.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::nav::cells {

/// So much longer than what is packed it can be at most: three bytes give 264.
inline constexpr std::size_t kLzfMostTimes = 88;
/// So far back a copy reaches.
inline constexpr std::size_t kLzfFarthest = 8192;

/// What is packed, piece by piece: of what came out before it holds the last 8 kB alone.
class LzfStream {
 public:
  /// @param packed outlives it
  explicit LzfStream(base::Bytes packed) : packed_(packed) {}

  /// The next `size_bytes`. @param out null: they are passed over
  /// @return Malformed, with the byte of `packed` at which it went wrong
  base::Result<void> read(std::uint8_t* out, std::size_t size_bytes);
  /// Nothing more comes out.
  bool ended() const noexcept { return at_ == packed_.size() && literals_ + copied_ == 0; }
  /// The byte of `packed` at which what comes next begins.
  std::size_t at() const noexcept { return literals_ + copied_ > 0 ? begun_ : at_; }

 private:
  base::Result<void> next_run();
  std::size_t take_literals(std::uint8_t* out, std::size_t most) noexcept;
  std::size_t take_copied(std::uint8_t* out, std::size_t most) noexcept;

  base::Bytes packed_;
  std::size_t at_ = 0;
  std::size_t begun_ = 0;     ///< first byte of the run that was begun
  std::size_t literals_ = 0;  ///< of it, still to come
  std::size_t copied_ = 0;    ///< likewise
  std::size_t back_ = 0;
  std::size_t out_ = 0;  ///< bytes that came out
  std::array<std::uint8_t, kLzfFarthest> last_{};
};

/// @param size_bytes of what comes out, exactly; allocated only where so many can come out.
/// @return Malformed, with the byte of `packed` at which it went wrong.
base::Result<std::vector<std::uint8_t>> unpack_lzf(base::Bytes packed, std::size_t size_bytes);
/// The same without keeping any of it.
base::Result<void> check_lzf(base::Bytes packed, std::size_t size_bytes);

/// Never longer than a 32nd more than what is packed. Deterministic. What is packed apart may be
/// joined: it comes out one after the other.
std::vector<std::uint8_t> pack_lzf(base::Bytes plain);

}  // namespace roverd::nav::cells
