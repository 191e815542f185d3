#pragma once
// Reads the columns of a PCD file whose DATA is binary_compressed: u32 compressed size, u32 size,
// then LZF. Written from the formats' descriptions (pointclouds.org, "The PCD file format"; the
// head of liblzf's own file): a control byte below 32 is followed by that many literals and one
// more; else its upper three bits are a length (7: one more byte to be added) less two, its lower
// five and the next byte the distance less one.

#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

namespace roverd::tests {

inline std::optional<std::vector<std::uint8_t>> unlzf(const std::uint8_t* in, std::size_t n,
                                                      std::size_t size) {
  std::vector<std::uint8_t> out;
  out.reserve(size);
  std::size_t i = 0;
  while (i < n) {
    const unsigned control = in[i++];
    if (control < 32) {
      const std::size_t run = control + 1U;
      if (i + run > n || out.size() + run > size) return std::nullopt;
      out.insert(out.end(), in + i, in + i + run);
      i += run;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7 && i < n) length += in[i++];
    if (i >= n) return std::nullopt;
    const std::size_t back = ((static_cast<std::size_t>(control) & 31U) << 8U) + in[i++] + 1U;
    length += 2;
    if (back > out.size() || out.size() + length > size) return std::nullopt;
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

/// All columns one after the other, as they lie in the file once it is unpacked.
inline std::optional<std::vector<std::uint8_t>> pcd_columns(const std::vector<std::uint8_t>& file) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  constexpr std::string_view kMark = "DATA binary_compressed\n";
  const std::size_t mark = text.find(kMark);
  if (mark == std::string_view::npos || mark + kMark.size() + 8 > file.size()) return std::nullopt;
  const std::uint8_t* p = file.data() + mark + kMark.size();
  const auto u32 = [](const std::uint8_t* b) {
    return static_cast<std::size_t>(b[0]) | static_cast<std::size_t>(b[1]) << 8U |
           static_cast<std::size_t>(b[2]) << 16U | static_cast<std::size_t>(b[3]) << 24U;
  };
  const std::size_t packed = u32(p);
  if (packed > file.size() - (mark + kMark.size() + 8)) return std::nullopt;
  return unlzf(p + 8, packed, u32(p + 4));
}

}  // namespace roverd::tests
