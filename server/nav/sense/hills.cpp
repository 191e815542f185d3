#include "nav/sense/hills.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/angle.hpp"
#include "nav/sense/lies.hpp"

namespace roverd::nav::sense {

namespace {

constexpr float kNoGroundBefore = std::numeric_limits<float>::infinity();
constexpr std::size_t kNowhereOut = std::numeric_limits<std::size_t>::max();
// A face and what its noise throws behind it are nearer to each other.
constexpr std::size_t kBehind = 3;
// What a ring does that meets an edge: it jumps by more than a ray falls over this much of height.
constexpr float kRingEdge_m = 0.06F;
// Of the directions about one that must have met ground.
constexpr float kRingPart = 0.8F;
// Whatever the settings say of the grass.
constexpr double kMostOver_m = 0.18;

// So long after the last that told ground the way is counted by others.
constexpr double kSilent_s = 1.0;
// Cells about one whose ground tells of it,
constexpr std::int32_t kAbout = 1;
// and where no place among them is known.
constexpr std::int32_t kNear = 3;
// and where what stands there was seen to be as thin as grass.
constexpr std::int32_t kFar = 6;

std::int32_t hill_cell(double m) noexcept {
  return static_cast<std::int32_t>(std::floor(m / Hills::kCell_m));
}

/// Places that have a cell; what is not a number has none.
bool has_cell(double x_m, double y_m) noexcept {
  return std::abs(x_m) < Hills::kFarthest_m && std::abs(y_m) < Hills::kFarthest_m;
}

}  // namespace

Hills::Hills(double range_m, double low_m)
    : low_m_(static_cast<float>(std::min(low_m, kMostOver_m))),
      steps_(static_cast<std::size_t>(std::ceil(range_m / static_cast<double>(kStep_m))) + 1),
      lowest_(kDirections * steps_),
      highest_(kDirections * steps_),
      first_(kDirections) {
  const auto wide = static_cast<std::uint32_t>(std::ceil(2.0 * range_m / kCell_m)) + 8;
  mask_ = static_cast<std::int32_t>(std::bit_ceil(std::clamp(wide, 16U, 1024U))) - 1;
  const auto side = static_cast<std::size_t>(mask_) + 1;
  places_.resize(side * side);
  grown_.resize(side * side);
}

std::size_t Hills::index(std::int32_t x, std::int32_t y) const noexcept {
  return static_cast<std::size_t>(y & mask_) * (static_cast<std::size_t>(mask_) + 1) +
         static_cast<std::size_t>(x & mask_);
}

std::int32_t Hills::half_of(base::Time t) const noexcept {
  return static_cast<std::int32_t>(
      std::floor(2.0 * (base::seconds(t - begin_) / kKnown_s + way_m_ / kKnown_m)));
}

void Hills::forget() noexcept {
  if (begun_) {
    std::fill(places_.begin(), places_.end(), Place{});
    std::fill(grown_.begin(), grown_.end(), Grown{});
  }
  begun_ = false;
}

std::size_t Hills::step_of(const Voxel& v) const noexcept {
  const float out = std::hypot(v.x_m, v.y_m) / kStep_m;
  if (!(out < static_cast<float>(steps_))) return kNowhereOut;
  const double turn = (std::atan2(v.y_m, v.x_m) / base::kPi + 1.0) * 0.5;
  const auto direction =
      static_cast<std::size_t>(turn * static_cast<double>(kDirections)) % kDirections;
  return direction * steps_ + static_cast<std::size_t>(out);
}

void Hills::meet(const Voxel& v, const Reduced& in) noexcept {
  const std::size_t i = step_of(v);
  if (i == kNowhereOut) return;
  lowest_[i] = std::min(lowest_[i], v.z_m);
  First& first = first_[i / steps_];
  const float out = std::hypot(v.x_m, v.y_m);
  if (first.out_m > 0.0F && first.out_m <= out) return;
  const float ray = std::hypot(v.x_m - in.origin_m[0], v.y_m - in.origin_m[1]);
  first = {out, v.z_m, (in.origin_m[2] - v.z_m) / std::max(ray, kStep_m)};
}

bool Hills::on_wide_ground(std::size_t direction) const noexcept {
  const First& at = first_[direction];
  if (!(at.falls > 0.0F) || !(at.out_m > kBeside_m)) return false;
  if (at.z_m > kSteepest * (at.out_m - kBeside_m)) return false;
  constexpr auto kTurn_rad = static_cast<float>(2.0 * base::kPi / kDirections);
  const auto aside = static_cast<int>(std::ceil(kWide_m / (at.out_m * kTurn_rad)));
  if (aside > static_cast<int>(kDirections) / 6) return false;
  // How far ahead it lies over how far aside: a parabola by least squares, even part only.
  float n = 0.0F, xs = 0.0F, y2s = 0.0F, y4s = 0.0F, xy2s = 0.0F;
  const First* before = nullptr;
  for (int k = -aside; k <= aside; ++k) {
    const First& f = first_[(direction + kDirections + static_cast<std::size_t>(k)) % kDirections];
    if (f.out_m <= 0.0F) continue;
    if (before != nullptr && std::abs(f.out_m - before->out_m) > kRingEdge_m / at.falls)
      return false;
    before = &f;
    const float turn = static_cast<float>(k) * kTurn_rad;
    const float x = f.out_m * std::cos(turn);
    const float y2 = f.out_m * f.out_m * std::sin(turn) * std::sin(turn);
    n += 1.0F;
    xs += x;
    y2s += y2;
    y4s += y2 * y2;
    xy2s += x * y2;
  }
  if (n < kRingPart * static_cast<float>(2 * aside + 1)) return false;
  const float bend = (n * xy2s - xs * y2s) / std::max(n * y4s - y2s * y2s, 1e-6F);
  return bend < -0.25F / at.out_m;
}

void Hills::look_out(const Reduced& in) noexcept {
  std::fill(lowest_.begin(), lowest_.end(), kNoGroundBefore);
  std::fill(highest_.begin(), highest_.end(), -kNoGroundBefore);
  std::fill(first_.begin(), first_.end(), First{});
  for (const Voxel& v : in.voxels) {
    if (v.kind == Kind::Ground) meet(v, in);
  }
  for (std::size_t direction = 0; direction < kDirections; ++direction) look_out(direction);
}

void Hills::look_out(std::size_t direction) noexcept {
  float* const low = lowest_.data() + direction * steps_;
  float* const high = highest_.data() + direction * steps_;
  // What the ground can be at most, seen from the body.
  float most = 0.0F;
  bool begun = false;
  const bool wide = on_wide_ground(direction);
  for (std::size_t i = 0; i < steps_; ++i) {
    if (begun) most += kSteepest * kStep_m;
    const float first_m =
        wide ? kSteepest * (static_cast<float>(i + 1) * kStep_m - kBeside_m) : 0.0F;
    const float upto = begun ? most + kRough_m : std::max(static_cast<float>(kMostLow_m), first_m);
    if (low[i] > upto) {
      low[i] = kNoGroundBefore;
      continue;
    }
    // From a hill around the robot it goes on from there.
    const bool from_hill = !begun && low[i] > static_cast<float>(kMostLow_m);
    most = from_hill ? low[i] : std::min(most, low[i]);
    begun = true;
    high[i] = upto;
  }
  // And between what lies before and behind it.
  std::size_t before = 0;
  float before_m = 0.0F;
  for (std::size_t i = 0; i < steps_; ++i) {
    if (low[i] == kNoGroundBefore) continue;
    std::size_t behind = i + kBehind;
    while (behind < steps_ && low[behind] == kNoGroundBefore) ++behind;
    if (behind >= steps_) {
      high[i] = -kNoGroundBefore;
      continue;
    }
    const float part = static_cast<float>(i - before) / static_cast<float>(behind - before);
    high[i] = std::min(high[i], before_m + part * (low[behind] - before_m) + kRough_m);
    if (low[i] > high[i]) continue;
    before = i;
    before_m = low[i];
  }
}

void Hills::count_way(const Reduced& in) noexcept {
  if (in.stamp <= last_at_) return;
  way_m_ += std::hypot(in.pose.x_m - last_.x_m, in.pose.y_m - last_.y_m);
  last_ = in.pose;
  last_at_ = in.stamp;
}

void Hills::drive(const Reduced& in) noexcept {
  // Who tells ground counts the way as well; seldom is often enough.
  if (begun_ && base::seconds(in.stamp - last_at_) > kSilent_s) count_way(in);
}

void Hills::learn(const Reduced& in) {
  if (!in.lie.told) return forget();
  if (!begun_) {
    begun_ = true;
    begin_ = in.stamp;
    last_ = in.pose;
    last_at_ = in.stamp;
    way_m_ = 0.0;
  }
  count_way(in);
  const std::int32_t half = half_of(in.stamp);
  const Lies lies(in);
  look_out(in);
  for (const Voxel& v : in.voxels) {
    if (v.kind != Kind::Ground || !has_cell(lies.x_m(v), lies.y_m(v))) continue;
    const std::int32_t x = hill_cell(lies.x_m(v));
    const std::int32_t y = hill_cell(lies.y_m(v));
    const float z = lies.height_m(v);
    Place& p = places_[index(x, y)];
    const std::size_t step = step_of(v);
    if (step == kNowhereOut || v.z_m > highest_[step]) {
      renew(p, x, y, half, z);
      continue;
    }
    if (p.x != x || p.y != y || p.half < half - 1) {
      p = {x, y, half, z, kNoGroundBefore};
    } else if (p.half < half) {
      p = {x, y, half, z, p.z_m};
    } else {
      p.z_m = std::min(p.z_m, z);
    }
  }
}

void Hills::renew(Place& p, std::int32_t x, std::int32_t y, std::int32_t half, float z_m) noexcept {
  if (p.x != x || p.y != y || p.half < half - 1) return;
  const float lowest = p.half < half ? p.z_m : std::min(p.z_m, p.before_m);
  if (std::abs(z_m - lowest) > kRough_m) return;
  p = {x, y, half, std::min(lowest, z_m), kNoGroundBefore};
}

std::optional<float> Hills::lowest_m(std::int32_t x, std::int32_t y,
                                     std::int32_t half) const noexcept {
  const Place& p = places_[index(x, y)];
  if (p.x != x || p.y != y || p.half < half - 1) return std::nullopt;
  return p.half < half ? p.z_m : std::min(p.z_m, p.before_m);
}

float Hills::lowest_about(std::int32_t x, std::int32_t y, std::int32_t half,
                          std::int32_t cells) const noexcept {
  float ground = kNoGroundBefore;
  for (std::int32_t dy = -cells; dy <= cells; ++dy) {
    for (std::int32_t dx = -cells; dx <= cells; ++dx) {
      const auto lowest = lowest_m(x + dx, y + dy, half);
      if (!lowest) continue;
      const float off_m =
          static_cast<float>(kCell_m) * std::hypot(static_cast<float>(dx), static_cast<float>(dy));
      ground = std::min(ground, *lowest + kSteepest * off_m);
    }
  }
  return ground;
}

bool Hills::is_ground(double x_m, double y_m, float z_m, base::Time now) const noexcept {
  if (!begun_ || !has_cell(x_m, y_m)) return false;
  const std::int32_t half = half_of(now);
  const std::int32_t x = hill_cell(x_m);
  const std::int32_t y = hill_cell(y_m);
  // Lower ground beside it may be down the slope.
  float ground = lowest_about(x, y, half, kAbout);
  if (ground == kNoGroundBefore) ground = lowest_about(x, y, half, kNear);
  if (ground == kNoGroundBefore && is_grown(x, y, half)) {
    ground = lowest_about(x, y, half, kFar);
  }
  return lies_on(ground, z_m);
}

/// Nothing known is infinitely high: below it.
bool Hills::lies_on(float ground_m, float z_m) const noexcept {
  return z_m <= ground_m + low_m_ && z_m >= ground_m - kInside_m;
}

bool Hills::is_grown(std::int32_t x, std::int32_t y, std::int32_t half) const noexcept {
  const Grown& g = grown_[index(x, y)];
  return g.x == x && g.y == y && g.half >= half - 1;
}

bool Hills::may_be_grass(double x_m, double y_m, float z_m, base::Time now) const noexcept {
  if (!begun_ || !has_cell(x_m, y_m)) return false;
  const std::int32_t half = half_of(now);
  const std::int32_t x = hill_cell(x_m);
  const std::int32_t y = hill_cell(y_m);
  return lowest_about(x, y, half, kNear) == kNoGroundBefore &&
         lies_on(lowest_about(x, y, half, kFar), z_m);
}

void Hills::grows(double x_m, double y_m, base::Time now) noexcept {
  if (!begun_ || !has_cell(x_m, y_m)) return;
  const std::int32_t x = hill_cell(x_m);
  const std::int32_t y = hill_cell(y_m);
  grown_[index(x, y)] = {x, y, half_of(now)};
}

void Hills::stands(double x_m, double y_m) noexcept {
  if (!has_cell(x_m, y_m)) return;
  Grown& g = grown_[index(hill_cell(x_m), hill_cell(y_m))];
  if (g.x == hill_cell(x_m) && g.y == hill_cell(y_m)) g = {};
}

bool Hills::grown_at(double x_m, double y_m, base::Time now) const noexcept {
  return begun_ && has_cell(x_m, y_m) && is_grown(hill_cell(x_m), hill_cell(y_m), half_of(now));
}

std::size_t Hills::deny(Reduced& in) const {
  if (!begun_ || !in.lie.told) return 0;
  const Lies lies(in);
  const std::int32_t half = half_of(in.stamp);
  std::size_t count = 0;
  for (Voxel& v : in.voxels) {
    if (v.kind != Kind::Ground || !has_cell(lies.x_m(v), lies.y_m(v))) continue;
    const float known = lowest_about(hill_cell(lies.x_m(v)), hill_cell(lies.y_m(v)), half, kAbout);
    if (known == kNoGroundBefore || lies.height_m(v) <= known + kStands_m) continue;
    v.kind = Kind::Obstacle;
    ++count;
  }
  return count;
}

std::size_t Hills::judge(Reduced& in) const {
  if (!begun_ || !in.lie.told) return 0;
  const Lies lies(in);
  std::size_t count = 0;
  for (Voxel& v : in.voxels) {
    if (v.kind != Kind::Obstacle) continue;
    if (!is_ground(lies.x_m(v), lies.y_m(v), lies.height_m(v), in.stamp)) continue;
    v.kind = Kind::Ground;
    ++count;
  }
  return count;
}

}  // namespace roverd::nav::sense
