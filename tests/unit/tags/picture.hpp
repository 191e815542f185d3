#pragma once
// Pictures of tags under known poses: every pixel looks along its rays at the plane of the tag.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include "nav/tags/finder.hpp"

namespace roverd::nav::tags {

/// Cells of the tag with its white border, 10 by 10, as the family has them.
class Cells {
 public:
  explicit Cells(int id) {
    apriltag_family_t* family = tag36h11_create();
    image_u8_t* image = apriltag_to_image(family, id);
    side_ = image->width;
    border_ = family->width_at_border;
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x) grey_.push_back(image->buf[y * image->stride + x]);
    }
    image_u8_destroy(image);
    tag36h11_destroy(family);
  }
  /// @param x, y on the tag, in sides of its black border from its middle. Grey beside it.
  double at(double x, double y) const {
    const int u = static_cast<int>(std::floor(x * border_ + 0.5 * side_));
    const int v = static_cast<int>(std::floor(y * border_ + 0.5 * side_));
    if (u < 0 || v < 0 || u >= side_ || v >= side_) return 120.0;
    return grey_[static_cast<std::size_t>(v * side_ + u)] > 127 ? 220.0 : 30.0;
  }

 private:
  int side_ = 0;
  int border_ = 0;
  std::vector<std::uint8_t> grey_;
};

struct Shot {
  int width = 320;
  int height = 240;
  Lens lens{300.0, 300.0, 160.0, 120.0};
  double size_m = 0.16;
  double blur_px = 0.5;  ///< half width of what a pixel sees
  double noise = 3.0;    ///< grey levels
  std::uint64_t seed = 1;
};

struct Truth {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R_CT, camera axes
  Eigen::Vector3d place{0.0, 0.0, 1.0};
};

inline std::vector<std::uint8_t> picture(const Cells& cells, const Truth& truth, const Shot& shot) {
  std::vector<std::uint8_t> out;
  std::mt19937_64 random(shot.seed);
  std::normal_distribution<double> noise(0.0, shot.noise);
  const Eigen::Vector3d normal = truth.rotation.col(2);
  constexpr int kRays = 4;
  for (int y = 0; y < shot.height; ++y) {
    for (int x = 0; x < shot.width; ++x) {
      double sum = 0.0;
      for (int k = 0; k < kRays * kRays; ++k) {
        const double du = ((k % kRays + 0.5) / kRays - 0.5) * 2.0 * shot.blur_px;
        const double dv = ((k / kRays + 0.5) / kRays - 0.5) * 2.0 * shot.blur_px;
        const Eigen::Vector3d ray{(x + 0.5 + du - shot.lens.cx) / shot.lens.fx,
                                  (y + 0.5 + dv - shot.lens.cy) / shot.lens.fy, 1.0};
        const double along = normal.dot(truth.place) / normal.dot(ray);
        const Eigen::Vector3d on = truth.rotation.transpose() * (along * ray - truth.place);
        sum += along > 0.0 ? cells.at(on.x() / shot.size_m, on.y() / shot.size_m) : 120.0;
      }
      const double grey = sum / (kRays * kRays) + noise(random);
      out.push_back(static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0)));
    }
  }
  return out;
}

inline GreyImage image_of(const std::vector<std::uint8_t>& bytes, const Shot& shot) {
  return {shot.width, shot.height, shot.width, bytes};
}

/// Camera axes to S.
inline Eigen::Matrix3d to_s() {
  Eigen::Matrix3d m;
  m << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return m;
}

}  // namespace roverd::nav::tags
