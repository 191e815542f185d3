#pragma once
// Frames for tests.

#include <limits>
#include <vector>

#include "cloud/codec.hpp"

namespace roverd::cloud {

using Blob = std::vector<std::uint8_t>;

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline Header header_of(std::uint32_t sequence, std::int64_t stamp_ns = 1'000'000'000) {
  Header h;
  h.sequence = sequence;
  h.stamp_ns = stamp_ns;
  return h;
}
inline Blob cloud_frame(const Header& h, const std::vector<float>& xyz) {
  const Blob data = bytes_of(xyz);
  return encode(h, Cloud{static_cast<std::uint32_t>(xyz.size() / 3), 0.005F, data});
}
inline Blob depth_frame(const Header& h, std::uint16_t width,
                        const std::vector<std::uint16_t>& pixels, float f = 100.0F) {
  const Blob data = bytes_of(pixels);
  const auto height = static_cast<std::uint16_t>(pixels.size() / width);
  return encode(h,
                Depth{width, height, f, f, (width - 1) / 2.0F, (height - 1) / 2.0F, 0.001F, data});
}
inline Blob ranges_frame(const Header& h, float first_rad, float step_rad,
                         const std::vector<float>& ranges) {
  const Blob data = bytes_of(ranges);
  return encode(h, Ranges{static_cast<std::uint32_t>(ranges.size()), first_rad, step_rad, data});
}
inline Blob operator+(Blob a, const Blob& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace roverd::cloud
