#pragma once
// LZF, the packing of `binary_compressed` PCD files. Bounded by what the caller says.
//
//   000lllll  l + 1 literal bytes follow
//   lllddddd [more] dddddddd   copy l + 2 bytes (l = 7: 9 + `more`) from d + 1 bytes back
// Source: the description in the head of liblzf.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::nav::cells {

/// So much longer than what is packed it can be at most: three bytes give 264.
inline constexpr std::size_t kLzfMostTimes = 88;

/// @param size_bytes of what comes out, exactly; allocated only where so many can come out.
/// @return Malformed, with the byte of `packed` at which it went wrong.
base::Result<std::vector<std::uint8_t>> unpack_lzf(base::Bytes packed, std::size_t size_bytes);

/// Never longer than a 32nd more than what is packed. Deterministic.
std::vector<std::uint8_t> pack_lzf(base::Bytes plain);

}  // namespace roverd::nav::cells
