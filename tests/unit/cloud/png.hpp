#pragma once
// Depth images as files, for tests.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "frames.hpp"
#include "real_data.hpp"

namespace roverd::cloud {

inline std::uint32_t big32(const std::uint8_t* at) {
  return static_cast<std::uint32_t>(at[0] << 24 | at[1] << 16 | at[2] << 8 | at[3]);
}

struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint16_t> pixels;
};

inline int paeth(int a, int b, int c) {
  const int p = a + b - c;
  const int pa = std::abs(p - a);
  const int pb = std::abs(p - b);
  const int pc = std::abs(p - c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// 16-bit grey PNG (ISO 15948), not interlaced.
inline Image png_of(const std::filesystem::path& path) {
  const auto file = tests::read_file(path);
  Image out;
  Blob packed;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::uint32_t size = big32(file.data() + at);
    const std::string type(file.begin() + static_cast<std::ptrdiff_t>(at + 4),
                           file.begin() + static_cast<std::ptrdiff_t>(at + 8));
    const std::uint8_t* data = file.data() + at + 8;
    if (type == "IHDR") {
      out.width = big32(data);
      out.height = big32(data + 4);
      EXPECT_EQ(data[8], 16);
      EXPECT_EQ(data[9], 0);
    }
    if (type == "IDAT") packed.insert(packed.end(), data, data + size);
    at += 12 + size;
  }
  const std::size_t stride = std::size_t{out.width} * 2;
  Blob raw((stride + 1) * out.height);
  uLongf raw_size = raw.size();
  EXPECT_EQ(::uncompress(raw.data(), &raw_size, packed.data(), packed.size()), Z_OK);
  Blob above(stride, 0);
  for (std::size_t v = 0; v < out.height; ++v) {
    std::uint8_t* row = raw.data() + v * (stride + 1) + 1;
    const int filter = raw[v * (stride + 1)];
    for (std::size_t i = 0; i < stride; ++i) {
      const int a = i >= 2 ? row[i - 2] : 0;
      const int b = above[i];
      const int c = i >= 2 ? above[i - 2] : 0;
      const int add = filter == 1   ? a
                      : filter == 2 ? b
                      : filter == 3 ? (a + b) / 2
                      : filter == 4 ? paeth(a, b, c)
                                    : 0;
      row[i] = static_cast<std::uint8_t>(row[i] + add);
    }
    above.assign(row, row + stride);
    for (std::size_t u = 0; u < out.width; ++u) {
      out.pixels.push_back(static_cast<std::uint16_t>(row[2 * u] << 8 | row[2 * u + 1]));
    }
  }
  return out;
}

}  // namespace roverd::cloud
