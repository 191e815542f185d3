#include "nav/sense/rays_rule.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angle.hpp"

namespace roverd::nav::sense {

base::Result<void> check(const RaysParams& p) {
  const auto refuse = [](const std::string& key, const std::string& detail) {
    return base::fail(base::Code::Invalid, key + " " + detail, {{key, detail}});
  };
  if (p.instead && !p.enabled) return refuse("instead", "needs enabled: nothing would stop it");
  if (p.far_as_m < p.far_m) return refuse("far_as_m", "must not be less than far_m");
  if (p.stop_m > p.far_m) return refuse("stop_m", "must not be more than far_m");
  if (p.blind_m >= p.stop_m) return refuse("blind_m", "must be less than stop_m");
  if (p.stop_fan_deg > p.fan_deg) return refuse("stop_fan_deg", "must not be more than fan_deg");
  const double most = 2.0 * std::floor(p.stop_fan_deg / p.step_deg) + 1.0;
  if (p.stop_rays > most) {
    return refuse("stop_rays", "must not be more than the " + std::to_string(std::lround(most)) +
                                   " rays within stop_fan_deg");
  }
  return {};
}

void rays_of(const Reduced& in, const RaysParams& params, std::vector<Ray>& out) {
  const double fan = base::rad_from_deg(params.fan_deg);
  const double step = base::rad_from_deg(params.step_deg);
  const auto steps = static_cast<int>(std::lround(fan / step));
  out.resize(static_cast<std::size_t>(2 * steps + 1));
  for (int i = -steps; i <= steps; ++i) {
    out[static_cast<std::size_t>(i + steps)] = {static_cast<float>(i * step),
                                                static_cast<float>(params.far_as_m), true};
  }
  const auto band = static_cast<float>(params.band_m);
  const auto far = static_cast<float>(params.far_m);
  const auto blind = static_cast<float>(params.blind_m);
  const auto per_step = static_cast<float>(1.0 / step);
  for (const Voxel& v : in.voxels) {
    if (v.kind == Kind::Clear || v.kind == Kind::Passing) continue;
    if (!(std::abs(v.z_m - in.origin_m[2]) <= band)) continue;
    const float dx = v.x_m - in.origin_m[0];
    const float dy = v.y_m - in.origin_m[1];
    const float d = std::sqrt(dx * dx + dy * dy);
    if (d < blind || d > far) continue;
    const auto i = static_cast<int>(std::lround(std::atan2(dy, dx) * per_step));
    if (i < -steps || i > steps) continue;
    Ray& ray = out[static_cast<std::size_t>(i + steps)];
    if (ray.endless || d < ray.range_m) {
      ray.range_m = d;
      ray.endless = false;
    }
  }
}

Counted count_rays(const std::vector<Ray>& rays, const RaysParams& params) noexcept {
  Counted c;
  const double fan = base::rad_from_deg(params.stop_fan_deg);
  for (const Ray& ray : rays) {
    if (ray.endless || std::abs(static_cast<double>(ray.bearing_rad)) > fan) continue;
    if (ray.range_m >= static_cast<float>(params.stop_m)) continue;
    ++c.rays;
    if (c.nearest_m > 0.0F && ray.range_m >= c.nearest_m) continue;
    c.nearest_m = ray.range_m;
    c.nearest_rad = ray.bearing_rad;
  }
  c.stop = c.rays >= params.stop_rays;
  return c;
}

Nearing nearing(const std::vector<Ray>& rays, const RaysParams& params,
                std::vector<float>& ranges) {
  Nearing n;
  ranges.clear();
  const double fan = base::rad_from_deg(params.stop_fan_deg);
  for (const Ray& ray : rays) {
    if (ray.endless || std::abs(static_cast<double>(ray.bearing_rad)) > fan) continue;
    if (ray.range_m >= static_cast<float>(params.slow_m)) continue;
    ranges.push_back(ray.range_m);
    if (n.nearest_m > 0.0F && ray.range_m >= n.nearest_m) continue;
    n.nearest_m = ray.range_m;
    n.nearest_rad = ray.bearing_rad;
  }
  n.rays = static_cast<int>(ranges.size());
  n.slows = n.rays >= params.stop_rays;
  if (!n.slows) return n;
  const auto last = ranges.begin() + (params.stop_rays - 1);
  std::nth_element(ranges.begin(), last, ranges.end());
  n.way_m = std::max(0.0F, *last - static_cast<float>(params.stop_m));
  return n;
}

Sides sides_of(const std::vector<Ray>& rays, int n) noexcept {
  Sides s;
  const std::size_t count = std::min(rays.size(), static_cast<std::size_t>(std::max(n, 0)));
  for (std::size_t i = 0; i < count; ++i) {
    const Ray& right = rays[i];
    const Ray& left = rays[rays.size() - 1 - i];
    if (!right.endless) s.right_m += right.range_m, ++s.right;
    if (!left.endless) s.left_m += left.range_m, ++s.left;
  }
  if (s.right > 0) s.right_m /= static_cast<float>(s.right);
  if (s.left > 0) s.left_m /= static_cast<float>(s.left);
  return s;
}

}  // namespace roverd::nav::sense
