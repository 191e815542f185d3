#include "cloud/eye.hpp"

#include <algorithm>
#include <cmath>

namespace roverd::cloud {
namespace {

constexpr float kLeastRange_m = 1e-4F;

Vec3 plus(const Vec3& a, const Vec3& b) noexcept {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec3 times(const Vec3& a, float s) noexcept {
  return {a[0] * s, a[1] * s, a[2] * s};
}
float norm(const Vec3& a) noexcept {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}
/// From the camera's axes into the mount's.
Vec3 turned(const Stand& s, const Vec3& p) noexcept {
  return plus(plus(times(s.x, p[0]), times(s.y, p[1])), times(s.z, p[2]));
}

base::SightPoint point(const Vec3& p, base::Echo echo) noexcept {
  base::SightPoint out;
  out.x_m = p[0];
  out.y_m = p[1];
  out.z_m = p[2];
  out.echo = echo;
  return out;
}

/// The nearest pixel of a square with its lower right corner outside; depth 0: none.
struct Nearest {
  std::uint16_t depth = 0;
  std::uint16_t u = 0;
  std::uint16_t v = 0;
};
Nearest nearest_of(const Depth& d, std::size_t u0, std::size_t v0, std::size_t side) noexcept {
  const std::size_t u1 = std::min<std::size_t>(u0 + side, d.width);
  const std::size_t v1 = std::min<std::size_t>(v0 + side, d.height);
  Nearest out{0, static_cast<std::uint16_t>((u0 + u1) / 2),
              static_cast<std::uint16_t>((v0 + v1) / 2)};
  for (std::size_t v = v0; v < v1; ++v) {
    const std::uint8_t* row = d.data.data() + 2 * (v * d.width);
    for (std::size_t u = u0; u < u1; ++u) {
      const std::uint16_t depth = u16_at(row + 2 * u);
      if (depth == 0 || (out.depth != 0 && depth >= out.depth)) continue;
      out = {depth, static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v)};
    }
  }
  return out;
}

}  // namespace

Stand stand_of(const std::optional<base::Mount>& pose) noexcept {
  if (!pose) return {};
  const double cr = std::cos(pose->roll_rad);
  const double sr = std::sin(pose->roll_rad);
  const double cp = std::cos(pose->pitch_rad);
  const double sp = std::sin(pose->pitch_rad);
  const double cy = std::cos(pose->yaw_rad);
  const double sy = std::sin(pose->yaw_rad);
  const auto vec = [](double x, double y, double z) {
    return Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  };
  // The columns of Rz(yaw) Ry(pitch) Rx(roll).
  return {vec(cy * cp, sy * cp, -sp), vec(cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
          vec(cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr),
          vec(pose->x_m, pose->y_m, pose->z_m)};
}

Eye::Seen Eye::look(const Frame& frame, base::Sight& sight) {
  sight.good = frame.header.good;
  sight.clear_to_m = static_cast<float>(params_.clear_to_m);
  const Stand stand = stand_of(frame.header.pose);
  if (const auto* cloud = std::get_if<Cloud>(&frame.body)) {
    return look_at(*cloud, frame.header.optical, stand, sight);
  }
  if (const auto* depth = std::get_if<Depth>(&frame.body)) return look_at(*depth, stand, sight);
  return look_at(std::get<Ranges>(frame.body), stand, sight);
}

/// @return true: it is missing.
bool Eye::put_missing(const Vec3& ray, const Vec3& at, base::Sight& sight) const {
  const bool clear = params_.clear_to_m > 0.0;
  const float to_m = clear ? static_cast<float>(params_.clear_to_m) : 1.0F;
  sight.points.push_back(point(plus(times(ray, to_m / norm(ray)), at),
                               clear ? base::Echo::Clear : base::Echo::Unknown));
  return true;
}

/// @param ray towards the point, of any length. @param scale ray to metres. @return true: missing.
bool Eye::put(const Vec3& ray, float scale, float range_m, const Stand& stand,
              base::Sight& sight) const {
  if (range_m > static_cast<float>(params_.max_range_m)) return put_missing(ray, stand.at, sight);
  if (range_m < static_cast<float>(params_.min_range_m)) {
    sight.points.push_back(
        point(plus(times(ray, 1.0F / norm(ray)), stand.at), base::Echo::Unknown));
    return true;
  }
  sight.points.push_back(point(plus(times(ray, scale), stand.at), base::Echo::Hit));
  return false;
}

Eye::Seen Eye::look_at(const Cloud& cloud, bool optical, const Stand& stand,
                       base::Sight& sight) const {
  sight.half_step_rad = cloud.half_step_rad;
  sight.points.reserve(cloud.count);
  Seen seen{cloud.count, 0};
  const std::uint8_t* at = cloud.data.data();
  for (std::uint32_t i = 0; i < cloud.count; ++i, at += 12) {
    Vec3 p{f32_at(at), f32_at(at + 4), f32_at(at + 8)};
    if (optical) p = {p[2], -p[0], -p[1]};
    const float range_m = norm(p);
    // NaN, infinity, and the camera itself: nearer than this a point has no direction.
    if (!(range_m > kLeastRange_m && range_m < 1e6F)) {
      ++seen.missing;
      continue;
    }
    if (put(turned(stand, p), 1.0F, range_m, stand, sight)) ++seen.missing;
  }
  return seen;
}

void Eye::prepare(const Depth& d, const Stand& stand) {
  const std::array<float, 4> lens{d.fx, d.fy, d.cx, d.cy};
  if (rays_.width == d.width && rays_.height == d.height && rays_.lens == lens &&
      rays_.stand == stand) {
    return;
  }
  rays_ = {d.width, d.height, lens, stand, {}, {}};
  rays_.columns.reserve(d.width);
  rays_.rows.reserve(d.height);
  for (unsigned u = 0; u < d.width; ++u) {
    const float left = (d.cx - static_cast<float>(u)) / d.fx;
    rays_.columns.push_back(plus(stand.x, times(stand.y, left)));
  }
  for (unsigned v = 0; v < d.height; ++v) {
    rays_.rows.push_back(times(stand.z, (d.cy - static_cast<float>(v)) / d.fy));
  }
}

Eye::Seen Eye::look_at(const Depth& d, const Stand& stand, base::Sight& sight) {
  prepare(d, stand);
  const auto side = static_cast<std::size_t>(params_.decimate);
  const std::size_t columns = (d.width + side - 1) / side;
  const std::size_t rows = (d.height + side - 1) / side;
  sight.half_step_rad = std::min(0.5F, 0.5F * static_cast<float>(side) / std::min(d.fx, d.fy));
  sight.points.reserve(columns * rows);
  Seen seen{columns * rows, 0};
  for (std::size_t v = 0; v < d.height; v += side) {
    for (std::size_t u = 0; u < d.width; u += side) {
      const Nearest n = nearest_of(d, u, v, side);
      const Vec3 ray = plus(rays_.columns[n.u], rays_.rows[n.v]);
      const float depth_m = static_cast<float>(n.depth) * d.unit_m;
      const bool missing = n.depth == 0 ? put_missing(ray, stand.at, sight)
                                        : put(ray, depth_m, depth_m, stand, sight);
      if (missing) ++seen.missing;
    }
  }
  return seen;
}

Eye::Seen Eye::look_at(const Ranges& r, const Stand& stand, base::Sight& sight) const {
  sight.half_step_rad = std::abs(r.step_rad) / 2.0F;
  sight.points.reserve(r.count);
  Seen seen{r.count, 0};
  for (std::uint32_t i = 0; i < r.count; ++i) {
    const double angle_rad = r.first_rad + static_cast<double>(i) * r.step_rad;
    const Vec3 ray = turned(stand, {static_cast<float>(std::cos(angle_rad)),
                                    static_cast<float>(std::sin(angle_rad)), 0.0F});
    const float range_m = f32_at(r.data.data() + 4 * std::size_t{i});
    bool missing = false;
    if (range_m > 0.0F && !std::isinf(range_m)) {
      missing = put(ray, range_m, range_m, stand, sight);
    } else if (range_m > 0.0F) {
      missing = put_missing(ray, stand.at, sight);
    } else {  // also NaN
      missing = true;
      sight.points.push_back(point(plus(ray, stand.at), base::Echo::Unknown));
    }
    if (missing) ++seen.missing;
  }
  return seen;
}

}  // namespace roverd::cloud
