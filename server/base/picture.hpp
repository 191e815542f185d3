#pragma once
// What a camera of pictures took: compressed, as it came, for whoever shows or reads it.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/time.hpp"

namespace roverd::base {

/// One picture, immutable once told.
struct Picture {
  std::string camera;  ///< name of its driver
  /// When its first byte arrived here (of a camera of this computer: when it was taken, if the
  /// kernel tells). What it shows is older than that, by the camera's own delay.
  Time stamp;
  std::uint64_t count = 0;  ///< of this camera, from 0; only pictures that differ are counted
  int width = 0;            ///< pixels
  int height = 0;
  std::vector<std::uint8_t> jpeg;  ///< whole, 4 MB at most; its pixels were not looked at
};

using PicturePtr = std::shared_ptr<const Picture>;
using OnPicture = std::function<void(PicturePtr)>;

/// How a camera without distortion sees: column = cx + fx · right / ahead, row = cy + fy · down /
/// ahead. Pixels; the middle of the first pixel is 0.5.
struct Lens {
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
};

}  // namespace roverd::base
