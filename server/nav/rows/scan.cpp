#include "nav/rows/scan.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav::rows {
namespace {

std::size_t bearing_at(double rad) noexcept {
  const auto deg = static_cast<long>(std::floor(base::deg_from_rad(base::wrap_rad(rad)) + 180.0));
  const auto n = static_cast<long>(RowScan::kBearings);
  return static_cast<std::size_t>(((deg % n) + n) % n);
}

/// A piece in which so much ground is seen looks, however much of it goes into the sky.
constexpr std::size_t kGround = 20;

/// How much of the way to a voxel lies at the height of plants: all of it, or from the eye to where
/// the ray leaves that height. 0: the eye is not at it, and the voxel neither.
double part_at_height(double eye_m, double z_m, double low_m, double high_m) noexcept {
  if (z_m >= low_m && z_m <= high_m) return 1.0;
  if (eye_m <= low_m || eye_m >= high_m) return 0.0;
  return z_m < low_m ? (eye_m - low_m) / (eye_m - z_m) : (high_m - eye_m) / (z_m - eye_m);
}

}  // namespace

double RowScan::reach_to(double x_m, double y_m) const noexcept {
  const double rad = std::atan2(y_m - eye_y_m, x_m - eye_x_m);
  return double(reach_m[bearing_at(rad)]);
}

void scan_of(const sense::Reduced& in, const RowParams& params, RowScan& out) {
  out.stamp = in.stamp;
  out.pose = in.pose;
  out.eye_x_m = double(in.origin_m[0]);
  out.eye_y_m = double(in.origin_m[1]);
  const auto eye_z_m = double(in.origin_m[2]);
  const sense::Counts& n = in.counts;
  std::size_t ground = 0;
  out.points.clear();
  out.reach_m.fill(0.0F);
  for (const sense::Voxel& v : in.voxels) {
    if (v.kind == sense::Kind::Ground) ++ground;
    const double part = part_at_height(eye_z_m, double(v.z_m), params.low_m, params.high_m);
    if (part <= 0.0) continue;
    const bool level = part >= 1.0;
    if (level && v.kind == sense::Kind::Obstacle) out.points.push_back({v.x_m, v.y_m});
    const double dx = double(v.x_m) - out.eye_x_m;
    const double dy = double(v.y_m) - out.eye_y_m;
    float& reach = out.reach_m[bearing_at(std::atan2(dy, dx))];
    reach = std::max(reach, static_cast<float>(part * std::hypot(dx, dy)));
  }
  const bool unknown = double(n.unknown) > params.blind_part * double(n.points);
  out.blind = n.points == 0 || (unknown && ground < kGround);
  const auto half = static_cast<long>(params.rays_fan_deg);
  long looked = 0;
  for (long deg = -half; deg <= half; ++deg) {
    if (out.reach_m[bearing_at(base::rad_from_deg(double(deg) + 0.5))] > 0.0F) ++looked;
  }
  out.ahead = 2 * looked > 2 * half + 1;
  sense::RaysParams fan;
  fan.fan_deg = params.rays_fan_deg;
  fan.band_m = params.rays_band_m;
  fan.far_m = params.rays_far_m;
  fan.far_as_m = params.rays_far_m + 1.0;
  sense::rays_of(in, fan, out.rays);
}

}  // namespace roverd::nav::rows
