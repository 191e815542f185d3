#include "nav/sense/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/angle.hpp"

namespace roverd::nav::sense {

namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
// The pull towards the slope of the whole, as m² of spread: a third of a dense window's.
constexpr float kRidge_m2 = 0.3F;
constexpr float kFewest = 3.0F;
constexpr int kWindow = 2;            // cells to each side
constexpr std::uint32_t kLonely = 8;  // so many times more voxels lie higher

}  // namespace

Ground::Ground(const GroundParams& params, double range_m, const Footprint& body)
    : p_(params),
      body_(body),
      range_m_(static_cast<float>(range_m)),
      cell_m_(static_cast<float>(params.cell_m)),
      slope_(static_cast<float>(std::tan(base::rad_from_deg(params.max_slope_deg)))),
      side_(static_cast<std::size_t>(std::ceil(2.0 * range_m / params.cell_m)) + 1) {
  low_.resize(side_ * side_);
  top_.resize(side_ * side_);
  sums_.resize(side_ * side_);
  planes_.resize(side_ * side_);
  counts_.resize(side_ * side_);
  limit_.assign(side_ * side_, -kNone);
}

void Ground::Sums::add(const Sums& o, float dx, float dy) noexcept {
  n += o.n;
  x += o.x + o.n * dx;
  y += o.y + o.n * dy;
  z += o.z;
  xx += o.xx + 2.0F * dx * o.x + o.n * dx * dx;
  yy += o.yy + 2.0F * dy * o.y + o.n * dy * dy;
  xy += o.xy + dx * o.y + dy * o.x + o.n * dx * dy;
  xz += o.xz + dx * o.z;
  yz += o.yz + dy * o.z;
}

std::size_t Ground::cell(float x, float y) const noexcept {
  if (!(x >= -range_m_ && x <= range_m_ && y >= -range_m_ && y <= range_m_)) return kNowhere;
  const auto ix = static_cast<std::size_t>((x + range_m_) / cell_m_);
  const auto iy = static_cast<std::size_t>((y + range_m_) / cell_m_);
  return iy * side_ + ix;
}

float Ground::middle(std::size_t i) const noexcept {
  return (static_cast<float>(i) + 0.5F) * cell_m_ - range_m_;
}

void Ground::judge(std::vector<Voxel>& voxels) {
  lowest(voxels);
  spread();
  slope_x_ = 0.0F;
  slope_y_ = 0.0F;
  lay(voxels, false);
  lay(voxels, true);
  const auto high = static_cast<float>(p_.min_height_m);
  const auto pass = static_cast<float>(p_.pass_below_m);
  for (Voxel& v : voxels) {
    if (v.kind == Kind::Clear) continue;
    const float above = v.z_m - height_m(v.x_m, v.y_m);
    v.kind = above > pass ? Kind::Overhang : above > high ? Kind::Obstacle : Kind::Ground;
  }
  if (p_.drop) drops(voxels);
}

float Ground::height_m(float x_m, float y_m) const noexcept {
  const std::size_t c = cell(x_m, y_m);
  if (c == kNowhere) return kNone;
  const Plane& plane = planes_[c];
  if (!plane.laid) return top_[c];
  return plane.z + plane.a * (x_m - middle(c % side_)) + plane.b * (y_m - middle(c / side_));
}

void Ground::lowest(const std::vector<Voxel>& voxels) {
  std::fill(low_.begin(), low_.end(), kNone);
  std::fill(counts_.begin(), counts_.end(), Count{});
  used_.clear();
  for (const Voxel& v : voxels) {
    if (v.kind == Kind::Clear) continue;
    const std::size_t c = cell(v.x_m, v.y_m);
    if (c == kNowhere) continue;
    if (counts_[c].all == 0) used_.push_back(c);
    counts_[c].all += v.points;  // not voxels: a mirror's points each have one of their own
    low_[c] = std::min(low_[c], v.z_m);
  }
  leave_lonely(voxels);
  top_ = low_;
  const auto rough = static_cast<float>(p_.rough_m);
  for (std::size_t i = 0; i < top_.size(); ++i) {
    const float x = middle(i % side_);
    const float y = middle(i / side_);
    if (x * x + y * y > 25.0F) continue;
    if (body_.distance_m({static_cast<double>(x), static_cast<double>(y)}) <= 0.0) {
      top_[i] = std::min(top_[i], rough);
    }
  }
}

// A few points far below all around them are mirrors in a puddle or mixed pixels: they must not
// pull down the ground.
void Ground::leave_lonely(const std::vector<Voxel>& voxels) {
  const float near = 2.0F * static_cast<float>(p_.rough_m) + slope_ * cell_m_;
  for (const Voxel& v : voxels) {
    if (v.kind == Kind::Clear) continue;
    const std::size_t c = cell(v.x_m, v.y_m);
    if (c != kNowhere && v.z_m <= low_[c] + near) counts_[c].low += v.points;
  }
  lonely_.clear();
  for (const std::size_t c : used_) {
    std::uint32_t low = 0;
    std::uint32_t all = 0;
    for (std::size_t j = 0; j < 5; ++j) {
      for (std::size_t i = 0; i < 5; ++i) {
        const std::size_t x = c % side_ + i - 2;  // below 0 it wraps to far above
        const std::size_t y = c / side_ + j - 2;
        if (x >= side_ || y >= side_) continue;
        const std::size_t o = y * side_ + x;
        all += counts_[o].all;
        if (low_[o] <= low_[c] + 2.0F * near) low += counts_[o].low;
      }
    }
    if (all > kLonely * low || (low <= 2 && all >= 3 * low)) lonely_.push_back(c);
  }
  for (const std::size_t c : lonely_) {
    limit_[c] = low_[c] + near;
    low_[c] = kNone;
  }
  for (const Voxel& v : voxels) {
    if (lonely_.empty()) break;
    if (v.kind == Kind::Clear) continue;
    const std::size_t c = cell(v.x_m, v.y_m);
    if (c != kNowhere && v.z_m > limit_[c]) low_[c] = std::min(low_[c], v.z_m);
  }
  for (const std::size_t c : lonely_) limit_[c] = -kNone;
}

void Ground::spread() noexcept {
  const float straight = slope_ * cell_m_;
  const float across = straight * std::sqrt(2.0F);
  const std::size_t n = side_;
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) {
      float& t = top_[y * n + x];
      if (x > 0) t = std::min(t, top_[y * n + x - 1] + straight);
      if (y == 0) continue;
      t = std::min(t, top_[(y - 1) * n + x] + straight);
      if (x > 0) t = std::min(t, top_[(y - 1) * n + x - 1] + across);
      if (x + 1 < n) t = std::min(t, top_[(y - 1) * n + x + 1] + across);
    }
  }
  for (std::size_t y = n; y-- > 0;) {
    for (std::size_t x = n; x-- > 0;) {
      float& t = top_[y * n + x];
      if (x + 1 < n) t = std::min(t, top_[y * n + x + 1] + straight);
      if (y + 1 == n) continue;
      t = std::min(t, top_[(y + 1) * n + x] + straight);
      if (x > 0) t = std::min(t, top_[(y + 1) * n + x - 1] + across);
      if (x + 1 < n) t = std::min(t, top_[(y + 1) * n + x + 1] + across);
    }
  }
}

void Ground::lay(const std::vector<Voxel>& voxels, bool again) {
  for (Sums& s : sums_) s = {};
  Sums all;
  const auto rough = static_cast<float>(p_.rough_m);
  const auto near = 2.0F * rough + slope_ * cell_m_;
  const auto beside = rough + 0.02F;
  for (const Voxel& v : voxels) {
    if (v.kind == Kind::Clear) continue;
    const std::size_t c = cell(v.x_m, v.y_m);
    if (c == kNowhere) continue;
    const Plane& before = planes_[c];
    const float dx = v.x_m - middle(c % side_);
    const float dy = v.y_m - middle(c / side_);
    if (again && before.laid) {
      if (std::abs(v.z_m - before.z - before.a * dx - before.b * dy) > beside) continue;
    } else if (v.z_m > top_[c] + near || v.z_m < top_[c] - near - slope_ * cell_m_) {
      continue;
    }
    Sums s{1.0F, dx, dy, v.z_m, dx * dx, dx * dy, dy * dy, dx * v.z_m, dy * v.z_m};
    sums_[c].add(s, 0.0F, 0.0F);
    all.add(s, middle(c % side_), middle(c / side_));
  }
  std::fill(planes_.begin(), planes_.end(), Plane{});
  if (all.n >= kFewest) {
    const float mx = all.x / all.n;
    const float my = all.y / all.n;
    const float mz = all.z / all.n;
    const float pull = 0.02F * all.n + 1.0F;  // towards the body's own plane
    const float xx = all.xx - all.n * mx * mx + pull;
    const float yy = all.yy - all.n * my * my + pull;
    const float xy = all.xy - all.n * mx * my;
    const float xz = all.xz - all.n * mx * mz;
    const float yz = all.yz - all.n * my * mz;
    const float det = std::max(xx * yy - xy * xy, 1e-6F);
    slope_x_ = std::clamp((xz * yy - yz * xy) / det, -slope_, slope_);
    slope_y_ = std::clamp((yz * xx - xz * xy) / det, -slope_, slope_);
  }
  for (const std::size_t c : used_) planes_[c] = fit(c % side_, c / side_);
}

Ground::Plane Ground::fit(std::size_t ix, std::size_t iy) const noexcept {
  Sums s;
  for (int j = -kWindow; j <= kWindow; ++j) {
    for (int i = -kWindow; i <= kWindow; ++i) {
      const std::size_t x = ix + static_cast<std::size_t>(i);  // below 0 it wraps to far above
      const std::size_t y = iy + static_cast<std::size_t>(j);
      if (x >= side_ || y >= side_) continue;
      const Sums& o = sums_[y * side_ + x];
      if (o.n > 0.0F) s.add(o, static_cast<float>(i) * cell_m_, static_cast<float>(j) * cell_m_);
    }
  }
  if (s.n < kFewest) return {};
  const float mx = s.x / s.n;
  const float my = s.y / s.n;
  const float mz = s.z / s.n;
  const float xx = s.xx - s.n * mx * mx + kRidge_m2;
  const float yy = s.yy - s.n * my * my + kRidge_m2;
  const float xy = s.xy - s.n * mx * my;
  const float xz = s.xz - s.n * mx * mz + kRidge_m2 * slope_x_;
  const float yz = s.yz - s.n * my * mz + kRidge_m2 * slope_y_;
  const float det = std::max(xx * yy - xy * xy, 1e-6F);
  Plane p;
  p.a = std::clamp((xz * yy - yz * xy) / det, -slope_, slope_);
  p.b = std::clamp((yz * xx - xz * xy) / det, -slope_, slope_);
  p.z = mz - p.a * mx - p.b * my;
  p.laid = true;
  return p;
}

// Outwards in every sector of two degrees, from one piece of ground to the next.
void Ground::drops(std::vector<Voxel>& voxels) const {
  constexpr std::size_t kSectors = 180;
  constexpr float kStep_m = 0.1F;
  const auto steps = static_cast<std::size_t>(range_m_ / kStep_m) + 1;
  std::vector<float> highest(kSectors * steps, -kNone);
  for (const Voxel& v : voxels) {
    if (v.kind == Kind::Clear || v.kind == Kind::Overhang) continue;
    const float d = std::sqrt(v.x_m * v.x_m + v.y_m * v.y_m);
    const auto turn = static_cast<float>((std::atan2(v.y_m, v.x_m) / base::kPi + 1.0) * 0.5);
    const auto sector = static_cast<std::size_t>(turn * static_cast<float>(kSectors)) % kSectors;
    const auto step = static_cast<std::size_t>(d / kStep_m);
    if (step < steps) {
      float& h = highest[sector * steps + step];
      h = std::max(h, v.z_m);
    }
  }
  const float step_down = static_cast<float>(p_.drop_m);
  const float uneven = 2.0F * static_cast<float>(p_.rough_m);
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    float last_d = 0.0F;  // the ground below the body
    float last_z = 0.0F;
    for (std::size_t i = 0; i < steps; ++i) {
      const float z = highest[sector * steps + i];
      if (z == -kNone) continue;
      const float d = (static_cast<float>(i) + 0.5F) * kStep_m;
      // Deeper than a step, and steeper than a slope.
      if (z < last_z - uneven - std::max(step_down, slope_ * (d - last_d))) {
        const auto angle = static_cast<float>(
            ((static_cast<double>(sector) + 0.5) / (0.5 * kSectors) - 1.0) * base::kPi);
        const float edge = last_d + kStep_m;
        voxels.push_back({edge * std::cos(angle), edge * std::sin(angle), last_z, 1, Kind::Drop});
        break;
      }
      last_d = d;
      last_z = z;
    }
  }
}

}  // namespace roverd::nav::sense
