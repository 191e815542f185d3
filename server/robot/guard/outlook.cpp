#include "robot/guard/outlook.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "nav/sense/clusters.hpp"
#include "nav/sense/polar.hpp"

namespace roverd::robot {
namespace {

using nav::sense::Kind;
using nav::sense::Patch;
using nav::sense::Pose2;

constexpr double kShownCell_m = 0.1;
constexpr double kMostSide = 200;  // cells: 40 kB at most

std::optional<Outlook::Dot> dot_of(Kind kind) noexcept {
  switch (kind) {
    case Kind::Obstacle:
      return Outlook::Dot::Obstacle;
    case Kind::Overhang:
      return Outlook::Dot::Overhang;
    case Kind::Drop:
      return Outlook::Dot::Drop;
    case Kind::Passing:
      return Outlook::Dot::Passing;
    case Kind::Ground:
    case Kind::Clear:
      return std::nullopt;
  }
  return std::nullopt;
}

Outlook::Grid grid_of(const Patch& patch) {
  // So coarse that its size is bounded, however far the sensors are set to see.
  const double finest_m = std::max(kShownCell_m, patch.cell_m * patch.side / kMostSide);
  const auto n = static_cast<std::int32_t>(std::ceil(finest_m / patch.cell_m - 1e-6));
  const Patch shown = coarser(patch, std::max(1, n));
  return {.cell_m = shown.cell_m,
          .x_m = shown.x0 * shown.cell_m,
          .y_m = shown.y0 * shown.cell_m,
          .side = shown.side,
          .runs = run_lengths(shown)};
}

/// The nearest hit of the two directions in a degree, and as far as both are free.
void fill_rays(const nav::sense::Polar& polar, std::array<Outlook::Ray, Outlook::kRays>& rays) {
  constexpr std::size_t kEach = nav::sense::Polar::kBearings / Outlook::kRays;
  for (std::size_t i = 0; i < Outlook::kRays; ++i) {
    Outlook::Ray& ray = rays[Outlook::kRays - 1 - i];  // theirs turn to the left
    ray = {0.0F, 1e9F};
    for (std::size_t k = i * kEach; k < (i + 1) * kEach; ++k) {
      const nav::sense::Bearing& b = polar.of[k];
      if (b.hit_m > 0.0F && (ray.hit_m <= 0.0F || b.hit_m < ray.hit_m)) ray.hit_m = b.hit_m;
      ray.free_m = std::min(ray.free_m, b.free_m);
    }
  }
}

Outlook::Scan scan_of(std::string name, const KeptScan& kept, const Pose2& body) {
  Outlook::Scan out{std::move(name), kept.seen, {}};
  const Pose2 moved = inverse(body) * kept.pose;
  for (const nav::sense::Voxel& v : kept.voxels) {
    const Pose2 p = moved * Pose2{double(v.x_m), double(v.y_m), 0.0};
    out.spots.push_back({static_cast<float>(p.x_m), static_cast<float>(p.y_m),
                         dot_of(v.kind).value_or(Outlook::Dot::Obstacle)});
  }
  return out;
}

/// All together no more than kMostDots, each in proportion, and none without any.
void thin(std::vector<Outlook::Scan>& scans) {
  std::size_t all = 0;
  for (const auto& scan : scans) all += scan.spots.size();
  if (all <= Outlook::kMostDots) return;
  const std::size_t room = Outlook::kMostDots - scans.size();  // rounding up costs one each
  const std::size_t step = (all + room - 1) / room;
  for (auto& scan : scans) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < scan.spots.size(); i += step) scan.spots[kept++] = scan.spots[i];
    scan.spots.resize(kept);
  }
}

}  // namespace

void KeptScan::keep(const nav::sense::Reduced& in, base::Time when) {
  seen = when;
  pose = in.pose;
  voxels.clear();
  const auto told = [](const nav::sense::Voxel& v) { return dot_of(v.kind).has_value(); };
  const auto all = static_cast<std::size_t>(std::ranges::count_if(in.voxels, told));
  const std::size_t step = all / Outlook::kMostDots + 1;
  std::size_t i = 0;
  for (const nav::sense::Voxel& v : in.voxels) {
    if (told(v) && i++ % step == 0) voxels.push_back(v);
  }
}

Outlook outlook_of(const nav::sense::Chain& chain, const std::vector<KeptScan>& scans,
                   const nav::sense::Odometry& body, const OutlookParams& params, base::Time now) {
  Outlook out;
  out.stamp = body.stamp;
  out.at = {body.pose.x_m, body.pose.y_m, body.pose.yaw_rad};
  Patch patch;
  chain.grid().patch(body.pose, params.range_m, now, patch);
  out.grid = grid_of(patch);
  const nav::sense::Way way{{body.v_mps, body.yaw_rate_radps}, params.side_m, params.horizon_s};
  for (const auto& c : clusters_of(patch, body.pose, params.body, way, Outlook::kMostThings)) {
    out.things.push_back({.drop = c.known == nav::sense::Known::Drop,
                          .ahead_m = c.nearest.x,
                          .left_m = c.nearest.y,
                          .clearance_m = c.clearance_m,
                          .size_m = c.size_m,
                          .age_s = 0.1 * c.age_ds,
                          .sensor = c.sensor < chain.sensors() ? chain.sensor(c.sensor).name : "",
                          .on_way = c.on_way});
  }
  auto polar = std::make_unique<nav::sense::Polar>();
  polar_of(patch, body.pose, params.body, params.range_m, *polar);
  fill_rays(*polar, out.rays);
  for (std::size_t i = 0; i < scans.size() && i < chain.sensors(); ++i) {
    if (scans[i].seen == base::Time{}) continue;
    if (!out.seen || scans[i].seen > *out.seen) out.seen = scans[i].seen;
    out.scans.push_back(scan_of(chain.sensor(i).name, scans[i], body.pose));
  }
  thin(out.scans);
  return out;
}

}  // namespace roverd::robot
