#pragma once
// Settings of a depth camera at this computer, beside those of the cloud driver, which hears it.

#include <string>

#include "base/params.hpp"

namespace roverd::v4l2 {

struct Params {
  int width = 640;
  int height = 480;
  int images_hz = 30;
  double fx = 0.0;
  double fy = 0.0;
  double cx = -1.0;
  double cy = -1.0;
  double depth_unit_m = 0.001;
};

template <class V>
void fields(V& v, Params& p) {
  v("width", p.width, 16, 4096, "pixels of the image that is wanted; another one is refused");
  v("height", p.height, 16, 4096, "its rows");
  v("images_hz", p.images_hz, 1, 120, "wanted of the camera, which may give fewer");
  v("fx", p.fx, 0.0, 10'000.0,
    "focal length in pixels at that size, from the camera's calibration; it must be said");
  v("fy", p.fy, 0.0, 10'000.0, "the same downwards; 0: as fx");
  v("cx", p.cx, -1.0, 4096.0, "column of the optical axis; -1: the middle");
  v("cy", p.cy, -1.0, 4096.0, "its row; -1: the middle");
  v("depth_unit_m", p.depth_unit_m, 1e-5, 0.1,
    "metres of one unit of depth: 0.001 of most RealSense");
}

inline base::Result<void> validate(const Params& p) {
  const auto no = [](const char* field, const char* why) {
    return base::fail(base::Code::Invalid, std::string(field) + " " + why, {{field, why}});
  };
  if (p.fx < 1.0) return no("fx", "must be said: focal length in pixels, 1 or more");
  if (p.fy != 0.0 && p.fy < 1.0) return no("fy", "must be 1 or more, or 0: as fx");
  if (p.cx > p.width) return no("cx", "must lie within the image");
  if (p.cy > p.height) return no("cy", "must lie within the image");
  return {};
}

}  // namespace roverd::v4l2
