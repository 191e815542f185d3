#pragma once
// The kernel's letters for how pixels lie in memory, for who must not see its headers.

#include <cstdint>

namespace roverd::v4l2 {

constexpr std::uint32_t fourcc(char a, char b, char c, char d) noexcept {
  return static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b) << 8U |
         static_cast<std::uint32_t>(c) << 16U | static_cast<std::uint32_t>(d) << 24U;
}

inline constexpr std::uint32_t kMjpg = fourcc('M', 'J', 'P', 'G');  ///< a JPEG each
inline constexpr std::uint32_t kJpeg = fourcc('J', 'P', 'E', 'G');
inline constexpr std::uint32_t kYuyv = fourcc('Y', 'U', 'Y', 'V');  ///< Y U Y V: two pixels
inline constexpr std::uint32_t kGrey = fourcc('G', 'R', 'E', 'Y');  ///< 8 bits each

}  // namespace roverd::v4l2
