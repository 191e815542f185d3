#include "nav/sense/grass.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "nav/sense/lies.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kForgets_s = 1.0;
// The rays pass no higher than this over what was met: higher they say nothing of it.
constexpr float kOver_m = 0.02F;

std::size_t slot_of(std::int32_t x, std::int32_t y, std::size_t slots) noexcept {
  const auto mixed =
      static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U;
  return mixed % slots;
}

}  // namespace

void Grass::forget() noexcept {
  std::fill(places_.begin(), places_.end(), Place{});
}

void Grass::see(const Reduced& in, const Sectors& rays, Hills& hills) {
  if (!in.lie.told) return forget();
  meet(in, hills);
  look_through(in, rays);
  judge(in.stamp, hills);
}

void Grass::judge(base::Time now, Hills& hills) {
  const auto due = [&](const Place& p) {
    return p.taken && base::seconds(now - p.since) >= kSees_s;
  };
  // What stands beside tips has the last word on the place that they share.
  for (const Thin thin : {Thin::Yes, Thin::No}) {
    for (const Place& p : places_) {
      if (!due(p) || thin_of(p) != thin) continue;
      const double x_m = (p.x + 0.5) * kCell_m;
      const double y_m = (p.y + 0.5) * kCell_m;
      if (thin == Thin::Yes) {
        hills.grows(x_m, y_m, now);
      } else {
        hills.stands(x_m, y_m);
      }
    }
  }
  for (Place& p : places_) {
    if (!due(p)) continue;
    // Half of it counts on.
    for (Sectors::Share& share : p.shares) share = {0.5 * share.met, 0.5 * share.through};
    p.since = now;
  }
}

Grass::Thin Grass::thin_of(const Place& p) noexcept {
  bool few = true;
  for (const Sectors::Share& share : p.shares) {
    const double all = share.met + share.through;
    if (all >= kRays && share.met > kMany * all) return Thin::No;
    few = few && all >= kRays && share.met <= kFew * all;
  }
  return few ? Thin::Yes : Thin::Unknown;
}

void Grass::meet(const Reduced& in, const Hills& hills) {
  const Lies lies(in);
  for (const Voxel& v : in.voxels) {
    const bool ground = v.kind == Kind::Ground;
    if (!ground && v.kind != Kind::Obstacle && v.kind != Kind::Passing) continue;
    const double x_m = lies.x_m(v);
    const double y_m = lies.y_m(v);
    const float z_m = lies.height_m(v);
    // Where grass was found, what is met is asked on: somebody may have put a board there.
    if (ground ? !hills.grown_at(x_m, y_m, in.stamp) : !hills.may_be_grass(x_m, y_m, z_m, in.stamp))
      continue;
    const auto x = static_cast<std::int32_t>(std::floor(x_m / kCell_m));
    const auto y = static_cast<std::int32_t>(std::floor(y_m / kCell_m));
    Place& p = places_[slot_of(x, y, places_.size())];
    const bool here = p.taken && p.x == x && p.y == y;
    if (ground && p.taken && !here) continue;  // what is not known yet goes before
    if (!here) p = {x, y, z_m, true, {}, in.stamp, in.stamp};
    p.top_m = std::max(p.top_m, z_m);
    p.last = in.stamp;
  }
}

void Grass::look_through(const Reduced& in, const Sectors& rays) {
  constexpr double kPerRad = Sectors::kSectors / (2.0 * base::kPi);
  const double c = std::cos(in.pose.yaw_rad);
  const double s = std::sin(in.pose.yaw_rad);
  for (Place& p : places_) {
    if (!p.taken) continue;
    p.taken = base::seconds(in.stamp - p.last) < kForgets_s;
    const double x = (p.x + 0.5) * kCell_m - in.pose.x_m;
    const double y = (p.y + 0.5) * kCell_m - in.pose.y_m;
    const double ahead = c * x + s * y - static_cast<double>(rays.x_m);
    const double left = -s * x + c * y - static_cast<double>(rays.y_m);
    const double d = std::hypot(ahead, left);
    if (d < kCell_m + static_cast<double>(rays.blind_m)) continue;
    const double at = (std::atan2(left, ahead) + base::kPi) * kPerRad;
    const double wide = kCell_m / d * kPerRad;
    double from = at - 1.5 * wide;
    for (Sectors::Share& share : p.shares) {
      const auto now =
          rays.share(from, from + wide, static_cast<float>(d), kAbout_m, p.top_m + kOver_m);
      share = {share.met + now.met, share.through + now.through};
      from += 0.5 * wide;
    }
  }
}

}  // namespace roverd::nav::sense
