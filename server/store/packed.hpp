#pragma once
// Text in few bytes, for what the database keeps of every revision. Pure.

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd::store {

inline constexpr std::size_t kMaxUnpacked = 256u << 20;  ///< bytes

/// One zstd frame with a checksum. @param prefix text that the reader will have too (it may be
/// empty): what `text` has in common with it costs next to nothing.
/// Throws std::runtime_error if there is no memory.
std::string pack(std::string_view text, std::string_view prefix = {});

/// Malformed if it is not what pack() made with this prefix, or is larger than kMaxUnpacked.
base::Result<std::string> unpack(std::string_view packed, std::string_view prefix = {});

}  // namespace roverd::store
