#include "nav/sense/hills.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace roverd::nav::sense {

namespace {

/// A voxel's cell, and its height in O.
class Lies {
 public:
  explicit Lies(const Reduced& in)
      : in_(in),
        c_(std::cos(in.pose.yaw_rad)),
        s_(std::sin(in.pose.yaw_rad)),
        up_(up_in_body(in.lie)) {}

  std::int32_t column(const Voxel& v) const noexcept {
    return cell(in_.pose.x_m + c_ * static_cast<double>(v.x_m) - s_ * static_cast<double>(v.y_m));
  }
  std::int32_t row(const Voxel& v) const noexcept {
    return cell(in_.pose.y_m + s_ * static_cast<double>(v.x_m) + c_ * static_cast<double>(v.y_m));
  }
  float height_m(const Voxel& v) const noexcept {
    return static_cast<float>(in_.lie.z_m + up_[0] * static_cast<double>(v.x_m) +
                              up_[1] * static_cast<double>(v.y_m) +
                              up_[2] * static_cast<double>(v.z_m));
  }

 private:
  static std::int32_t cell(double m) noexcept {
    return static_cast<std::int32_t>(std::floor(m / Hills::kCell_m));
  }
  const Reduced& in_;
  double c_;
  double s_;
  std::array<double, 3> up_;
};

}  // namespace

Hills::Hills(double range_m, double low_m) : low_m_(static_cast<float>(low_m)) {
  const auto wide = static_cast<std::uint32_t>(std::ceil(2.0 * range_m / kCell_m)) + 8;
  mask_ = static_cast<std::int32_t>(std::bit_ceil(std::clamp(wide, 16U, 1024U))) - 1;
  const auto side = static_cast<std::size_t>(mask_) + 1;
  places_.resize(side * side);
}

std::size_t Hills::index(std::int32_t x, std::int32_t y) const noexcept {
  return static_cast<std::size_t>(y & mask_) * (static_cast<std::size_t>(mask_) + 1) +
         static_cast<std::size_t>(x & mask_);
}

void Hills::forget() noexcept {
  std::fill(places_.begin(), places_.end(), Place{});
  begun_ = false;
}

void Hills::learn(const Reduced& in) {
  // A float of seconds is a millisecond's for some hours: then all of it is learned anew.
  constexpr double kAnew_s = 8192.0;
  if (!begun_ || base::seconds(in.stamp - begin_) > kAnew_s) {
    forget();
    begun_ = true;
    begin_ = in.stamp;
  }
  const auto now_s = static_cast<float>(base::seconds(in.stamp - begin_));
  const Lies lies(in);
  for (const Voxel& v : in.voxels) {
    if (v.kind != Kind::Ground) continue;
    Place& p = places_[index(lies.column(v), lies.row(v))];
    const float z = lies.height_m(v);
    p = {p.at_s == now_s ? std::max(p.z_m, z) : z, now_s};
  }
}

std::size_t Hills::judge(Reduced& in) const {
  if (!begun_) return 0;
  const auto since_s = static_cast<float>(base::seconds(in.stamp - begin_) - kKnown_s);
  const Lies lies(in);
  std::size_t count = 0;
  for (Voxel& v : in.voxels) {
    if (v.kind != Kind::Obstacle) continue;
    const std::int32_t x = lies.column(v);
    const std::int32_t y = lies.row(v);
    bool known = false;
    float ground = 0.0F;
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dx = -1; dx <= 1; ++dx) {
        const Place& p = places_[index(x + dx, y + dy)];
        if (p.at_s < since_s) continue;
        ground = known ? std::max(ground, p.z_m) : p.z_m;
        known = true;
      }
    }
    const float above = lies.height_m(v) - ground;
    if (!known || above > low_m_ || above < -kInside_m) continue;
    v.kind = Kind::Ground;
    ++count;
  }
  return count;
}

}  // namespace roverd::nav::sense
