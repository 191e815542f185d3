#include "nav/sense/sectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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

constexpr float kBeyond_m = 0.10F;  // less may be the same thing's other side, or noise

constexpr float kSame_m = 0.0005F;  // the same height: what two looks from one place differ by

/// Where voxels stand, in O.
class Heights {
 public:
  explicit Heights(const Lie3& lie)
      : z_m_(static_cast<float>(lie.z_m)), level_(lie.roll_rad == 0.0 && lie.pitch_rad == 0.0) {
    const auto up = up_in_body(lie);
    for (std::size_t i = 0; i < 3; ++i) up_[i] = static_cast<float>(up[i]);
  }
  float of(float x, float y, float z) const noexcept {
    return level_ ? z_m_ + z : z_m_ + up_[0] * x + up_[1] * y + up_[2] * z;
  }

 private:
  std::array<float, 3> up_{};
  float z_m_;
  bool level_;
};

std::size_t sector_at(float at) noexcept {
  constexpr int n = static_cast<int>(Sectors::kSectors);
  return static_cast<std::size_t>((static_cast<int>(std::floor(at)) % n + n) % n);
}

/// Sorted by their sectors: counted first, then laid in.
void keep_rays(const Reduced& in, const std::vector<float>& at, Sectors& out) {
  out.begin.fill(0);
  for (const float a : at) {
    if (a >= 0.0F) ++out.begin[sector_at(a) + 1];
  }
  for (std::size_t i = 0; i < Sectors::kSectors; ++i) out.begin[i + 1] += out.begin[i];
  out.rays.resize(out.begin.back());
  auto next = out.begin;
  const Heights heights(in.lie);
  for (std::size_t i = 0; i < in.voxels.size(); ++i) {
    if (at[i] < 0.0F) continue;
    const Voxel& v = in.voxels[i];
    const auto& from = v.from < in.from_m.size() ? in.from_m[v.from] : in.origin_m;
    const float dx = v.x_m - out.x_m;
    const float dy = v.y_m - out.y_m;
    const float d = std::sqrt(dx * dx + dy * dy);
    const float back = ((out.x_m - from[0]) * dx + (out.y_m - from[1]) * dy) / d;
    out.rays[next[sector_at(at[i])]++] = {at[i],
                                          d,
                                          back,
                                          heights.of(from[0], from[1], from[2]),
                                          heights.of(v.x_m, v.y_m, v.z_m),
                                          from[2],
                                          v.z_m,
                                          v.points};
  }
}

}  // namespace

Sectors::Pass Sectors::passes(std::size_t sector, float d_m, const Band& band) const noexcept {
  if (d_m < blind_m) return Pass::None;
  Pass out = Pass::None;
  const auto middle = static_cast<float>(sector) + 0.5F;
  const auto round = static_cast<float>(kSectors);
  const auto beside = static_cast<std::size_t>(std::ceil(half_sectors));
  for (std::size_t n = 0; n <= 2 * beside; ++n) {
    const std::size_t k = (sector + kSectors - beside + n) % kSectors;
    for (std::uint32_t i = begin[k]; i < begin[k + 1]; ++i) {
      const Ray& ray = rays[i];
      if (ray.end_m <= d_m + kBeyond_m) continue;
      const float off = std::abs(ray.at - middle);
      if (std::min(off, round - off) > half_sectors + 0.5F) continue;
      const float part = (d_m + ray.back_m) / (ray.end_m + ray.back_m);
      const float z = ray.from_z_m + (ray.end_z_m - ray.from_z_m) * part;
      const float body = ray.from_body_m + (ray.end_body_m - ray.from_body_m) * part;
      if (body > band.top_body_m) continue;
      const float in = std::min(z - band.low_m, band.top_m - z);
      if (in >= band.along_m) return Pass::Through;
      if (in >= -kSame_m) {
        out = Pass::Along;
      } else if (in >= -band.beside_m) {
        out = std::max(out, Pass::Beside);
      }
    }
  }
  return out;
}

Sectors::Share Sectors::share(double from, double to, float d_m, float about_m,
                              float top_m) const noexcept {
  constexpr auto n = static_cast<int>(kSectors);
  Share out;
  for (int k = static_cast<int>(std::floor(from)); k <= static_cast<int>(std::floor(to)); ++k) {
    const auto sector = static_cast<std::size_t>((k % n + n) % n);
    for (std::uint32_t i = begin[sector]; i < begin[sector + 1]; ++i) {
      const Ray& ray = rays[i];
      const double at = static_cast<double>(ray.at) + (k - static_cast<int>(sector));
      if (at < from || at > to || ray.end_m < d_m - about_m) continue;
      const float part = (d_m + ray.back_m) / (ray.end_m + ray.back_m);
      if (ray.end_m <= d_m + about_m) {
        out.met += ray.points;
      } else if (ray.from_z_m + (ray.end_z_m - ray.from_z_m) * part <= top_m) {
        out.through += ray.points;
      }
    }
  }
  return out;
}

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
  const float half = std::min(half_step_rad * kPerRad, 30.0F) * 0.999F;
  out.half_sectors = half;
  out.blind_m = static_cast<float>(params.blind_m);
  out.planar = params.planar;
  out.thin = params.thin;
  out.meets_m = static_cast<float>(params.low_m);
  std::vector<float> directions(in.voxels.size(), -1.0F);
  const auto blind = static_cast<float>(params.blind_m);
  const auto vouch = static_cast<float>(params.vouch_m);
  const auto low = static_cast<float>(params.low_m);
  const float per_m = static_cast<float>(Sectors::kSteps) / out.range_m;
  // A voxel stands for many rays: at least for its own width.
  for (std::size_t n = 0; n < in.voxels.size(); ++n) {
    const Voxel& v = in.voxels[n];
    if (v.kind == Kind::Drop) continue;
    const float dx = v.x_m - out.x_m;
    const float dy = v.y_m - out.y_m;
    const float d = std::sqrt(dx * dx + dy * dy);
    if (d < 0.01F) continue;
    const float at = (std::atan2(dy, dx) + kPi_f) * kPerRad;
    directions[n] = std::max(0.0F, at);
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
      constexpr int all = static_cast<int>(Sectors::kSectors);
      Sector& sector = out.of[static_cast<std::size_t>((i % all + all) % all)];
      sector.far_m = std::max(sector.far_m, d);
      sector.seen |= seen | here;
      sector.low |= down;
      if (v.kind == Kind::Obstacle && (sector.hit_m == 0.0F || d < sector.hit_m)) sector.hit_m = d;
    }
  }
  keep_rays(in, directions, out);
}

}  // namespace roverd::nav::sense
