#pragma once
// From a voxel's place in the body frame to the odometry's frame O, heights included.

#include <array>
#include <cmath>

#include "nav/sense/reduce.hpp"

namespace roverd::nav::sense {

/// Where a voxel lies in O.
class Lies {
 public:
  explicit Lies(const Reduced& in)
      : in_(in),
        c_(std::cos(in.pose.yaw_rad)),
        s_(std::sin(in.pose.yaw_rad)),
        up_(up_in_body(in.lie)) {}

  double x_m(const Voxel& v) const noexcept {
    return in_.pose.x_m + c_ * static_cast<double>(v.x_m) - s_ * static_cast<double>(v.y_m);
  }
  double y_m(const Voxel& v) const noexcept {
    return in_.pose.y_m + s_ * static_cast<double>(v.x_m) + c_ * static_cast<double>(v.y_m);
  }
  float height_m(const Voxel& v) const noexcept {
    return static_cast<float>(in_.lie.z_m + up_[0] * static_cast<double>(v.x_m) +
                              up_[1] * static_cast<double>(v.y_m) +
                              up_[2] * static_cast<double>(v.z_m));
  }

 private:
  const Reduced& in_;
  double c_;
  double s_;
  std::array<double, 3> up_;
};

}  // namespace roverd::nav::sense
