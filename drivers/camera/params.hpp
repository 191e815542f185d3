#pragma once
// Settings of a camera of pictures: section [cameras.NAME].

#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "base/params.hpp"
#include "base/picture.hpp"

namespace roverd::camera {

struct Params {
  int width = 640;
  int height = 480;
  double fov_deg = 0.0;
  double fx = 0.0;
  double fy = 0.0;
  double cx = -1.0;
  double cy = -1.0;
  double images_hz = 10.0;
  double silent_after_s = 1.0;
  double silent_reopen_s = 5.0;
  double retry_first_s = 0.5;
  double retry_max_s = 5.0;
};

template <class V>
void fields(V& v, Params& p) {
  v("width", p.width, 16, 4096,
    "pixels across: the size for which the lens is told, and that is wanted of a V4L2 camera");
  v("height", p.height, 16, 4096, "its rows");
  v("fov_deg", p.fov_deg, 0.0, 170.0,
    "angle of view across, where fx is not known; 0: no lens is told, the pictures are for people");
  v("fx", p.fx, 0.0, 10'000.0, "focal length in pixels at that size; 0: from fov_deg");
  v("fy", p.fy, 0.0, 10'000.0, "the same downwards; 0: as fx");
  v("cx", p.cx, -1.0, 4096.0,
    "column of the optical axis, the middle of the first pixel is 0.5; -1: the middle");
  v("cy", p.cy, -1.0, 4096.0, "its row; -1: the middle");
  v("images_hz", p.images_hz, 0.1, 60.0,
    "pictures a second that are wanted of a V4L2 camera, or fetched one by one from an address "
    "that gives a single one");
  v("silent_after_s", p.silent_after_s, 0.2, 60.0, "without a new picture for so long it is lost");
  v("silent_reopen_s", p.silent_reopen_s, 0.5, 600.0, "then its connection is made anew");
  v("retry_first_s", p.retry_first_s, 0.05, 60.0, "first wait before opening again");
  v("retry_max_s", p.retry_max_s, 0.05, 600.0,
    "longest wait before opening again; a refused login waits so long at once");
}

inline base::Result<void> validate(const Params& p) {
  const auto no = [](const char* field, const char* why) {
    return base::fail(base::Code::Invalid, std::string(field) + " " + why, {{field, why}});
  };
  if (p.fx != 0.0 && p.fx < 1.0) return no("fx", "must be 1 or more, or 0: from fov_deg");
  if (p.fx > 0.0 && p.fov_deg > 0.0) return no("fov_deg", "must be 0 where fx is told");
  if (p.fov_deg != 0.0 && p.fov_deg < 1.0) return no("fov_deg", "must be 1 or more, or 0: unknown");
  if (p.fy != 0.0 && p.fy < 1.0) return no("fy", "must be 1 or more, or 0: as fx");
  if (p.cx > p.width) return no("cx", "must lie within the picture");
  if (p.cy > p.height) return no("cy", "must lie within the picture");
  return {};
}

/// The lens for a picture of this size: a camera that gives half the pixels has half the focal
/// length. Empty: none was told, or the picture is cut otherwise (another ratio of its sides).
inline std::optional<base::Lens> lens_of(const Params& p, int width, int height) noexcept {
  if ((p.fx <= 0.0 && p.fov_deg <= 0.0) || width <= 0 || height <= 0) return {};
  const double scale = static_cast<double>(width) / p.width;
  if (std::abs(p.height * scale - height) > 1.0) return {};
  const double fx =
      p.fx > 0.0 ? p.fx : p.width / 2.0 / std::tan(p.fov_deg * std::numbers::pi / 360.0);
  return base::Lens{.fx = fx * scale,
                    .fy = (p.fy > 0.0 ? p.fy : fx) * scale,
                    .cx = (p.cx >= 0.0 ? p.cx : p.width / 2.0) * scale,
                    .cy = (p.cy >= 0.0 ? p.cy : p.height / 2.0) * scale};
}

}  // namespace roverd::camera
