#include "nav/rows/rays.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav::rows {
namespace {

constexpr double kRaysSigma_m = 0.10;  // of one side: foliage, a few rays
const double kRaysSigma_rad = base::rad_from_deg(5.0);
constexpr double kMiddleSigma_m = 0.07;  // of the middle between two
const double kMiddleSigma_rad = base::rad_from_deg(2.5);
const double kLookedBeside_rad = base::rad_from_deg(0.25);

/// How far to the side, and how far ahead, the outermost rays of one side end.
struct Outermost {
  double ahead_m = 0.0;
  double aside_m = 0.0;  ///< without sign
  int rays = 0;
  int counted = 0;  ///< endless ones, too
  int looked = 0;   ///< of those: something is known of that bearing at all

  /// Endless because nothing stands there, not because nobody looked.
  bool open() const noexcept { return rays == 0 && 4 * looked >= 3 * counted; }
};

/// A bearing may lie between two pieces of reach_m.
bool looked_at(const RowScan& scan, double rad) {
  const auto reach = [&](double at_rad) {
    return scan.reach_to(scan.eye_x_m + std::cos(at_rad), scan.eye_y_m + std::sin(at_rad));
  };
  return reach(rad - kLookedBeside_rad) > 0.0 || reach(rad + kLookedBeside_rad) > 0.0;
}

Outermost outermost(const RowScan& scan, int side, int n) {
  Outermost out;
  const auto size = scan.rays.size();
  for (std::size_t i = 0; i < std::min(size, static_cast<std::size_t>(n)); ++i) {
    const sense::Ray& ray = side > 0 ? scan.rays[size - 1 - i] : scan.rays[i];
    const auto rad = double(ray.bearing_rad);
    ++out.counted;
    if (looked_at(scan, rad)) ++out.looked;
    if (ray.endless) continue;
    out.ahead_m += scan.eye_x_m + double(ray.range_m) * std::cos(rad);
    out.aside_m += std::abs(scan.eye_y_m + double(ray.range_m) * std::sin(rad));
    ++out.rays;
  }
  if (out.rays > 0) {
    out.ahead_m /= out.rays;
    out.aside_m /= out.rays;
  }
  return out;
}

}  // namespace

RowView view_by_rays(const RowScan& scan, const RowOrder& order, const RowParams& params) {
  const bool both = order.sides == Sides::Both;
  const int n = both ? params.rays_side : 2 * params.rays_side;
  const Outermost left = order.sides == Sides::Right ? Outermost{} : outermost(scan, 1, n);
  const Outermost right = order.sides == Sides::Left ? Outermost{} : outermost(scan, -1, n);
  double ahead_m = 1.0;
  double aside_m = 0.0;
  if (both && left.rays > 0 && right.rays > 0) {
    ahead_m = 0.5 * (left.ahead_m + right.ahead_m);
    aside_m = 0.5 * (left.aside_m - right.aside_m);
  } else if (order.sides == Sides::Left && left.rays > 0) {
    ahead_m = left.ahead_m;
    aside_m = left.aside_m - order.gap_m;
  } else if (order.sides == Sides::Right && right.rays > 0) {
    ahead_m = right.ahead_m;
    aside_m = order.gap_m - right.aside_m;
  }
  RowView view;
  view.stamp = scan.stamp;
  view.by_rays = true;
  view.line = scan.pose * Pose2{0.0, 0.0, std::atan2(aside_m, std::max(0.3, ahead_m))};
  if (both && left.rays > 0 && right.rays > 0) view.width_m = left.aside_m + right.aside_m;
  const bool middle = left.rays > 0 && right.rays > 0;
  const double sigma_m = middle ? kMiddleSigma_m : kRaysSigma_m;
  const double sigma_rad = middle ? kMiddleSigma_rad : kRaysSigma_rad;
  view.covariance[0] = sigma_m * sigma_m;
  view.covariance[4] = sigma_rad * sigma_rad;
  view.left = left.rays;
  view.right = right.rays;
  if (left.counted + right.counted > 0 && left.open() && right.open()) view.to_end_m = 0.0;
  return view;
}

}  // namespace roverd::nav::rows
