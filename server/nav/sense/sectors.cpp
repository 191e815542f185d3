#include "nav/sense/sectors.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav::sense {

namespace {

constexpr auto kPerRad = static_cast<float>(Sectors::kSectors / (2.0 * base::kPi));
constexpr auto kPi_f = static_cast<float>(base::kPi);

/// Bits for all steps that lie wholly between the two, in steps.
std::uint64_t steps_between(float from, float to) noexcept {
  const int a = std::max(0, static_cast<int>(std::ceil(from - 1e-4F)));
  const int b =
      std::min(static_cast<int>(Sectors::kSteps), static_cast<int>(std::floor(to + 1e-4F)));
  if (b <= a) return 0;
  const int count = b - a;
  const std::uint64_t ones = count >= 64 ? ~0ULL : (1ULL << static_cast<unsigned>(count)) - 1ULL;
  return ones << static_cast<unsigned>(a);
}

/// From where on a ray from height `from_m` to `to_m` at distance d lies below a height.
float below_from(float from_m, float to_m, float d, float height) noexcept {
  if (from_m <= height) return to_m <= height ? 0.0F : d;  // rises out of it: not looked at further
  if (to_m >= height) return d;
  return d * (from_m - height) / (from_m - to_m);
}

}  // namespace

double bearing_rad(std::size_t sector) noexcept {
  return (static_cast<double>(sector) + 0.5) * 2.0 * base::kPi / Sectors::kSectors - base::kPi;
}

void sight_sectors(const Reduced& in, float half_step_rad, const SightedParams& params,
                   Sectors& out) {
  out.of.fill({});
  out.range_m = static_cast<float>(params.range_m);
  out.x_m = in.origin_m[0];
  out.y_m = in.origin_m[1];
  const float z0 = in.origin_m[2];
  // What the plane met reaches as high as the plane, give or take a rounding.
  out.tall_m = params.planar ? z0 - 0.03F : static_cast<float>(params.vouch_m);
  const auto blind = static_cast<float>(params.blind_m);
  const auto vouch = static_cast<float>(params.vouch_m);
  const auto low = static_cast<float>(params.low_m);
  const float per_m = static_cast<float>(Sectors::kSteps) / out.range_m;
  // A voxel stands for many rays: at least for its own width.
  for (const Voxel& v : in.voxels) {
    if (v.kind == Kind::Drop) continue;
    const float dx = v.x_m - out.x_m;
    const float dy = v.y_m - out.y_m;
    const float d = std::sqrt(dx * dx + dy * dy);
    if (d < 0.01F) continue;
    const float at = (std::atan2(dy, dx) + kPi_f) * kPerRad;
    const float half = std::min(half_step_rad * kPerRad, 30.0F) * 0.999F;
    std::uint64_t seen = 0;
    std::uint64_t down = 0;
    std::uint64_t here = 0;
    if (params.planar) {
      seen = steps_between(blind * per_m, d * per_m);
      if (z0 <= low) down = seen;
    } else {
      seen = steps_between(std::max(blind, below_from(z0, v.z_m, d, vouch)) * per_m, d * per_m);
      down = steps_between(std::max(blind, below_from(z0, v.z_m, d, low)) * per_m, d * per_m);
      // The step that ground lies in was looked at, if not as a whole.
      if (v.kind == Kind::Ground && d >= blind) {
        here = 1ULL << std::min(static_cast<unsigned>(d * per_m), 63U);
      }
    }
    const auto first = static_cast<int>(std::floor(at - half));
    const auto last = static_cast<int>(std::floor(at + half));
    for (int i = first; i <= last; ++i) {
      constexpr int n = static_cast<int>(Sectors::kSectors);
      Sector& sector = out.of[static_cast<std::size_t>((i % n + n) % n)];
      sector.seen |= seen | here;
      sector.tall |= seen;
      sector.low |= down;
      if (v.kind == Kind::Obstacle && (sector.hit_m == 0.0F || d < sector.hit_m)) sector.hit_m = d;
    }
  }
}

}  // namespace roverd::nav::sense
