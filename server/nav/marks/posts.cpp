#include "nav/marks/posts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace roverd::nav::marks {
namespace {

constexpr std::size_t kFewest = 3;
constexpr double kRangeNoise_m = 0.015;

double apart(Vec2 a, Vec2 b) noexcept {
  return std::hypot(a.x - b.x, a.y - b.y);
}

struct Round {
  Vec2 middle{};
  double radius_m = 0.0;
  double rms_m = 0.0;
};

/// A circle by least squares over its equation, then its residuals. Source: I. Kåsa 1976.
std::optional<Round> circle_of(std::span<const Vec2> points) noexcept {
  const double n = static_cast<double>(points.size());
  Vec2 mean{};
  for (const Vec2 p : points) mean = mean + (1.0 / n) * p;
  double suu = 0.0, svv = 0.0, suv = 0.0, su = 0.0, sv = 0.0;
  for (const Vec2 p : points) {
    const Vec2 d = p - mean;
    const double square = d.x * d.x + d.y * d.y;
    suu += d.x * d.x;
    svv += d.y * d.y;
    suv += d.x * d.y;
    su += 0.5 * d.x * square;
    sv += 0.5 * d.y * square;
  }
  const double det = suu * svv - suv * suv;
  if (std::abs(det) < 1e-12) return std::nullopt;
  const Vec2 c{(su * svv - sv * suv) / det, (sv * suu - su * suv) / det};
  Round out;
  out.middle = mean + c;
  out.radius_m = std::sqrt(c.x * c.x + c.y * c.y + (suu + svv) / n);
  for (const Vec2 p : points) {
    const double off = apart(p, out.middle) - out.radius_m;
    out.rms_m += off * off / n;
  }
  out.rms_m = std::sqrt(out.rms_m);
  return out;
}

/// The span of hits [first, last] stands apart of what is beside it.
bool stands_apart(const PlanarScan& scan, std::size_t first, std::size_t last, double by_m) {
  const auto far = [&](std::size_t i, Vec2 edge) {
    return !scan.beams[i].hit || apart(scan.beams[i].at, edge) > by_m;
  };
  // Some beams beyond the edge: a thing that goes on behind a lost echo stands not alone.
  for (std::size_t k = 1; k <= 3; ++k) {
    if (first >= k && !far(first - k, scan.beams[first].at)) return false;
    if (last + k < scan.beams.size() && !far(last + k, scan.beams[last].at)) return false;
  }
  return true;
}

std::optional<Post> post_of(const PlanarScan& scan, std::span<const Vec2> points,
                            const LandmarkParams& params) noexcept {
  const double width_m = apart(points.front(), points.back());
  if (points.size() < kFewest || width_m > 2.0 * params.max_radius_m) return std::nullopt;
  Vec2 mean{};
  for (const Vec2 p : points) mean = mean + (1.0 / static_cast<double>(points.size())) * p;
  const double range_m = apart(mean, scan.eye);
  if (range_m > params.max_range_m || range_m < 1e-3) return std::nullopt;
  const Vec2 ray = (1.0 / range_m) * (mean - scan.eye);
  Post post;
  post.points = points.size();
  // What is seen of a circle is its width: it tells the radius better than the small bulge does.
  const double step_m = width_m / static_cast<double>(points.size() - 1);
  const double radius_m = 0.5 * (width_m + step_m);
  double nearest_m = 1e9;
  for (const Vec2 p : points) nearest_m = std::min(nearest_m, sense::dot(p - scan.eye, ray));
  post.radius_m = radius_m;
  post.at = scan.eye + (sense::dot(mean - scan.eye, ray) + 0.785 * radius_m) * ray;
  post.sigma_m = kRangeNoise_m / std::sqrt(static_cast<double>(points.size())) + 0.25 * step_m;
  const auto round = points.size() >= 7 ? circle_of(points) : std::nullopt;
  if (round && round->radius_m < 1.5 * radius_m && round->radius_m > 0.67 * radius_m &&
      round->rms_m < kRangeNoise_m) {
    post.radius_m = round->radius_m;
    post.at = round->middle;
  }
  // A flat thing as wide as that, or one that is seen edge on, bulges away from a circle's front.
  double depth_m = 0.0;
  for (const Vec2 p : points) {
    depth_m = std::max(depth_m, sense::dot(p - scan.eye, ray) - nearest_m);
  }
  if (depth_m > 1.2 * radius_m + 3.0 * kRangeNoise_m) return std::nullopt;
  if (post.radius_m < params.min_radius_m || post.radius_m > params.max_radius_m) {
    return std::nullopt;
  }
  return post;
}

}  // namespace

std::vector<Post> posts_of(const PlanarScan& scan, const LandmarkParams& params) {
  std::vector<Post> out;
  std::vector<Vec2> points;
  const std::size_t n = scan.beams.size();
  std::size_t first = 0;
  while (first < n) {
    if (!scan.beams[first].hit) {
      ++first;
      continue;
    }
    std::size_t last = first;
    points.assign(1, scan.beams[first].at);
    const double join_m = std::min(params.isolated_m, 0.5 * params.max_radius_m + 0.05);
    while (last + 1 < n && scan.beams[last + 1].hit &&
           apart(scan.beams[last + 1].at, points.back()) <= join_m) {
      points.push_back(scan.beams[++last].at);
    }
    const bool whole = first > 0 && last + 1 < n;
    if (whole && stands_apart(scan, first, last, params.isolated_m)) {
      if (const auto post = post_of(scan, points, params)) out.push_back(*post);
    }
    first = last + 1;
  }
  return out;
}

}  // namespace roverd::nav::marks
