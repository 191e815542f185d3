#pragma once
// Small pictures that differ, and the bytes of a camera that sends them.

#include <cstdint>
#include <string>
#include <vector>

#include "camera/jpeg.hpp"

namespace roverd::camera {

inline constexpr int kSide = 16;

/// 16x16, of one brightness.
inline std::string picture(std::uint8_t grey) {
  const std::vector<std::uint8_t> pixels(std::size_t{kSide} * kSide, grey);
  const auto jpeg = jpeg_of_grey(pixels, kSide, kSide, kSide, 90).value();
  return {jpeg.begin(), jpeg.end()};
}

inline const std::string kStream =
    "HTTP/1.0 200 OK\r\nServer: cam\r\nContent-Type: multipart/x-mixed-replace; "
    "boundary=frame\r\n\r\n";

inline std::string sized_part(const std::string& jpeg) {
  return "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) +
         "\r\n\r\n" + jpeg + "\r\n";
}
inline std::string open_part(const std::string& jpeg) {
  return "--frame\r\nContent-Type: image/jpeg\r\n\r\n" + jpeg + "\r\n";
}

}  // namespace roverd::camera
