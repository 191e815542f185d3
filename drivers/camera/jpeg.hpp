#pragma once
// JPEG pictures (ITU-T T.81): what one is without decoding it, to grey and from grey, by
// libjpeg-turbo. Any thread; allocates. Nothing is kept between calls.

#include <cstdint>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "base/result.hpp"

namespace roverd::camera {

using base::Bytes;

inline constexpr int kLargest_px = 4096;

struct JpegShape {
  int width = 0;  ///< pixels, 1..kLargest_px
  int height = 0;
  std::size_t scan = 0;  ///< where the coded pixels begin: before it stand tables and comments
  std::size_t size = 0;  ///< bytes to its end; what follows is no part of it
};

/// Reads its markers only: pixels may still be damaged. Invalid: what is wrong, in words: not
/// begun, not ended, of a kind that browsers do not show, larger than kLargest_px.
base::Result<JpegShape> shape_of(Bytes jpeg);

/// Row by row, without gaps.
struct Grey {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;  ///< width · height
};

/// Its brightness. Malformed: damaged, also where a part of it could be shown.
base::Result<Grey> grey_of(Bytes jpeg);

/// @param bytes stride · (height − 1) + width at least. @param quality 1..100.
base::Result<std::vector<std::uint8_t>> jpeg_of_grey(Bytes bytes, int width, int height, int stride,
                                                     int quality);
/// As the kernel's YUYV: two pixels in four bytes, Y U Y V. @param width even.
base::Result<std::vector<std::uint8_t>> jpeg_of_yuyv(Bytes bytes, int width, int height, int stride,
                                                     int quality);

/// The same picture with 1/divisor of its width and height, for a slow link. @param divisor 2, 4
/// or 8. @param quality 1..100.
base::Result<std::vector<std::uint8_t>> smaller(Bytes jpeg, int divisor, int quality);

}  // namespace roverd::camera
