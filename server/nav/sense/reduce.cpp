#include "nav/sense/reduce.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#include "nav/sense/mount.hpp"

namespace roverd::nav::sense {

namespace {

constexpr double kKnot_s = 0.002;
constexpr double kLongest_s = 2.0;            // of one piece
constexpr std::uint32_t kCellsAcross = 2047;  // 11 bits in x and y, 9 in z, one for Clear
constexpr std::uint32_t kCellsUp = 511;
constexpr float kInSensor_m = 0.01F;
constexpr float kGlass_m = 0.15F;  // a dirty window echoes from about there

/// B to the level frame with its yaw: nose up is a turn about the left, to the right.
Eigen::Matrix3d leaning(const Lie3& lie) {
  return (Eigen::AngleAxisd(-lie.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(lie.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

std::uint32_t hashed(std::uint32_t key) noexcept {
  return key * 2654435769U;  // Knuth's multiplicative hash: the upper bits are the good ones
}

}  // namespace

Reducer::Reducer(const ReduceParams& params, const Footprint& body,
                 const std::optional<Footprint>& pulled)
    : p_(params), body_(body), pulled_(pulled) {
  // Keys have room for so many cells; a finer voxel than that is made coarser.
  const double across = 2.0 * p_.max_range_m / static_cast<double>(kCellsAcross - 2);
  const double up = (p_.high_m - p_.low_m) / static_cast<double>(kCellsUp - 2);
  p_.voxel_m = std::max({p_.voxel_m, across, up});
}

base::Result<void> Reducer::reduce(const base::Sight& sight, const base::Mount& mount,
                                   const PoseHistory& history, Reduced& out) {
  out.voxels.clear();
  out.counts = {};
  out.counts.points = static_cast<std::uint32_t>(std::min(sight.points.size(), kMaxPoints + 1));
  if (sight.points.size() > kMaxPoints) {
    return base::fail(base::Code::TooLarge, sight.sensor + " gave " +
                                                std::to_string(sight.points.size()) +
                                                " points in one piece: more than a million");
  }
  if (auto laid = lay_knots(sight, mount, history, out); !laid) return laid;
  const std::size_t wanted = std::bit_ceil(std::max<std::size_t>(sight.points.size() / 8, 1024));
  slots_.assign(wanted, Slot{});
  keys_.clear();
  points(sight, out);
  for (Voxel& v : out.voxels) {
    const float part = 1.0F / static_cast<float>(v.points);
    v.x_m *= part;
    v.y_m *= part;
    v.z_m *= part;
  }
  return {};
}

base::Result<void> Reducer::lay_knots(const base::Sight& sight, const base::Mount& mount,
                                      const PoseHistory& history, Reduced& out) {
  // In the order in which they were measured; one out of its order is moved by the nearest knot.
  float first = 0.0F;
  float last = 0.0F;
  if (!sight.points.empty()) {
    first = std::min(sight.points.front().after_s, sight.points.back().after_s);
    last = std::max(sight.points.front().after_s, sight.points.back().after_s);
  }
  if (!(last - first <= kLongest_s)) {
    return base::fail(base::Code::Invalid, sight.sensor + " gave a piece longer than 2 s");
  }
  first_s_ = first;
  out.stamp = sight.stamp + base::from_seconds(last);
  const auto reference = history.at(out.stamp);
  if (!reference) {
    return base::fail(base::Code::Unavailable,
                      "where the body was when " + sight.sensor + " looked is not known");
  }
  out.pose = *reference;
  out.lie = history.lie_at(out.stamp);
  const Pose2 x_bo = inverse(*reference);
  const Eigen::Matrix3d level_to_body = leaning(out.lie).transpose();
  const Eigen::Matrix3d r = rotation(mount);
  const auto knots = static_cast<std::size_t>((last - first) / kKnot_s) + 2;
  knots_.resize(last > first ? knots : 1);
  for (std::size_t i = 0; i < knots_.size(); ++i) {
    const double after_s = std::min<double>(first + kKnot_s * static_cast<double>(i), last);
    const base::Time when = sight.stamp + base::from_seconds(after_s);
    const auto then = history.at(when);
    if (!then) {
      return base::fail(base::Code::Unavailable,
                        "where the body was when " + sight.sensor + " began is not known");
    }
    const Pose2 moved = x_bo * *then;
    const double c = std::cos(moved.yaw_rad);
    const double s = std::sin(moved.yaw_rad);
    Eigen::Matrix3d turn;
    turn << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
    const Lie3 lie = history.lie_at(when);
    turn = level_to_body * turn * leaning(lie);
    const Eigen::Matrix3d all = turn * r;
    const Eigen::Vector3d at =
        turn * Eigen::Vector3d(mount.x_m, mount.y_m, mount.z_m) +
        level_to_body * Eigen::Vector3d(moved.x_m, moved.y_m, lie.z_m - out.lie.z_m);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        knots_[i].r[static_cast<std::size_t>(3 * row + column)] =
            static_cast<float>(all(row, column));
      }
      knots_[i].t[static_cast<std::size_t>(row)] = static_cast<float>(at(row));
    }
  }
  out.origin_m = knots_.back().t;
  out.from_m.clear();
  for (const Knot& k : knots_) out.from_m.push_back(k.t);
  return {};
}

void Reducer::points(const base::Sight& sight, Reduced& out) {
  const auto max_range = static_cast<float>(p_.max_range_m);
  const float max2 = max_range * max_range;
  const auto low = static_cast<float>(p_.low_m);
  const auto high = static_cast<float>(p_.high_m);
  const auto per_m = static_cast<float>(1.0 / p_.voxel_m);
  const auto per_knot = static_cast<float>(1.0 / kKnot_s);
  const auto first = static_cast<float>(first_s_);
  const auto last_knot = static_cast<std::uint32_t>(knots_.size() - 1);
  const double reach_m = std::max(body_.reach_m(), pulled_ ? pulled_->reach_m() : 0.0);
  const float near = static_cast<float>(reach_m + p_.body_margin_m);
  const float near2 = near * near;
  const bool dirty = sight.window == base::Window::Dirty || sight.window == base::Window::Blocked;
  const float glass2 = dirty ? kGlass_m * kGlass_m : 0.0F;
  Counts& n = out.counts;
  std::uint32_t last_key = 0;
  std::uint32_t at = 0;

  for (const base::SightPoint& p : sight.points) {
    if (p.echo == base::Echo::Unknown) {
      ++n.unknown;
      continue;
    }
    const float s2 = p.x_m * p.x_m + p.y_m * p.y_m + p.z_m * p.z_m;
    if (p.echo == base::Echo::Hit && s2 < glass2) {
      ++n.unknown;
      continue;
    }
    // Also false for NaN; infinity and what is farther than any sensor sees fail the other side.
    if (!(s2 > kInSensor_m * kInSensor_m && s2 < 1e8F)) {
      ++n.bad;
      continue;
    }
    const Knot* k = knots_.data();
    if (last_knot != 0) {
      // NaN becomes the first knot.
      const float steps = (p.after_s - first) * per_knot + 0.5F;
      k += std::min(static_cast<std::uint32_t>(std::max(0.0F, steps)), last_knot);
    }
    float x = k->r[0] * p.x_m + k->r[1] * p.y_m + k->r[2] * p.z_m + k->t[0];
    float y = k->r[3] * p.x_m + k->r[4] * p.y_m + k->r[5] * p.z_m + k->t[1];
    float z = k->r[6] * p.x_m + k->r[7] * p.y_m + k->r[8] * p.z_m + k->t[2];
    const float d2 = x * x + y * y;
    bool clear = p.echo == base::Echo::Clear;
    if (clear || d2 > max2) {
      ++n.clear;
      if (d2 > max2) {  // pulled back along its ray, to where that leaves the crop
        const float ux = x - k->t[0];
        const float uy = y - k->t[1];
        const float a = ux * ux + uy * uy;
        const float b = k->t[0] * ux + k->t[1] * uy;
        const float c = k->t[0] * k->t[0] + k->t[1] * k->t[1] - max2;
        const float part = 0.999F * (std::sqrt(b * b - a * c) - b) / a;
        x = k->t[0] + ux * part;
        y = k->t[1] + uy * part;
        z = k->t[2] + (z - k->t[2]) * part;
        clear = true;
        if (!(x * x + y * y <= max2)) continue;  // a sensor that stands outside of the crop itself
      }
      if (z > high || z < low) continue;
    } else {
      if (z > high || z < low) {
        ++n.outside;
        continue;
      }
      if (d2 < near2 && is_body(x, y, z)) {
        ++n.body;
        continue;
      }
      ++n.kept;
    }
    const auto ix = static_cast<std::uint32_t>((x + max_range) * per_m);
    const auto iy = static_cast<std::uint32_t>((y + max_range) * per_m);
    const auto iz = static_cast<std::uint32_t>((z - low) * per_m);
    const std::uint32_t key =
        ((ix << 20U) | (iy << 9U) | iz | (clear ? 0x80000000U : 0U)) + 1U;  // 0 is empty
    if (key != last_key) {
      last_key = key;
      at = find(key, out.voxels);
      if (clear) out.voxels[at].kind = Kind::Clear;
      if (out.voxels[at].points == 0) {
        out.voxels[at].from = static_cast<std::uint16_t>(k - knots_.data());  // 1001 at most
      }
    }
    Voxel& v = out.voxels[at];
    v.x_m += x;
    v.y_m += y;
    v.z_m += z;
    ++v.points;
  }
}

bool Reducer::is_body(float x, float y, float z) const noexcept {
  if (z > static_cast<float>(p_.body_height_m + p_.body_margin_m)) return false;
  const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
  return body_.distance_m(p) <= p_.body_margin_m ||
         (pulled_ && pulled_->distance_m(p) <= p_.body_margin_m);
}

std::uint32_t Reducer::find(std::uint32_t key, std::vector<Voxel>& voxels) {
  const auto shift = static_cast<std::uint32_t>(32 - std::countr_zero(slots_.size()));
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hashed(key) >> shift;
  while (slots_[i].key != 0) {
    if (slots_[i].key == key) return slots_[i].at;
    i = (i + 1) & mask;
  }
  const auto at = static_cast<std::uint32_t>(voxels.size());
  slots_[i] = {key, at};
  voxels.emplace_back();
  keys_.push_back(key);
  if (voxels.size() * 2 > slots_.size()) grow(voxels);
  return at;
}

void Reducer::grow(const std::vector<Voxel>& voxels) {
  slots_.assign(slots_.size() * 4, Slot{});
  const auto shift = static_cast<std::uint32_t>(32 - std::countr_zero(slots_.size()));
  const std::size_t mask = slots_.size() - 1;
  for (std::uint32_t at = 0; at < voxels.size(); ++at) {
    std::size_t i = hashed(keys_[at]) >> shift;
    while (slots_[i].key != 0) i = (i + 1) & mask;
    slots_[i] = {keys_[at], at};
  }
}

}  // namespace roverd::nav::sense
