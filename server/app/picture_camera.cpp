#include "app/picture_camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/jpeg.hpp"
#include "v4l2/camera.hpp"
#include "v4l2/formats.hpp"

namespace roverd {
namespace {

/// Corners of tags stay where they are to a few hundredths of a pixel.
constexpr int kQuality = 92;

v4l2::Packed as_jpeg(const v4l2::Image& image) {
  if (image.format == v4l2::kMjpg || image.format == v4l2::kJpeg) {
    return {{image.bytes.begin(), image.bytes.end()}, true};
  }
  const auto width = static_cast<int>(image.width);
  const auto height = static_cast<int>(image.height);
  const auto stride = static_cast<int>(image.stride);
  auto made = image.format == v4l2::kYuyv
                  ? camera::jpeg_of_yuyv(image.bytes, width, height, stride, kQuality)
                  : camera::jpeg_of_grey(image.bytes, width, height, stride, kQuality);
  if (!made) return {{}, true, made.error().detail};
  return {std::move(*made), true};
}

}  // namespace

base::Result<std::unique_ptr<link::ByteLink>> open_picture_camera(boost::asio::io_context& io,
                                                                  const CameraSetup& camera) {
  v4l2::Wanted wanted;
  wanted.width = camera.params.width;
  wanted.height = camera.params.height;
  wanted.images_hz = std::max(1, static_cast<int>(std::lround(camera.params.images_hz)));
  wanted.formats = {{v4l2::kMjpg, 0}, {v4l2::kJpeg, 0}, {v4l2::kYuyv, 2}, {v4l2::kGrey, 1}};
  wanted.what = "pictures (MJPG, YUYV or GREY)";
  return std::make_unique<v4l2::Camera>(io, v4l2::path_of(camera.said.link), std::move(wanted),
                                        as_jpeg);
}

}  // namespace roverd
