#include "sim/world/terrain.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "sim/world/draw.hpp"

namespace roverd::sim::world {

/// One square of a layer's knots, kept from one place to the next: rays go on in small steps.
struct Knots {
  std::int64_t column = std::numeric_limits<std::int64_t>::min();
  std::int64_t row = 0;
  double a = 0.0;  ///< south-west, and what the others differ from it
  double east = 0.0;
  double north = 0.0;
  double both = 0.0;
};

/// As many layers as a file may have.
struct Terrain::Squares {
  std::array<Knots, 8> of;
};

namespace {

constexpr double kClose_m = 2e-4;
constexpr int kMostSteps = 4'000;
constexpr double kEdge_m = 1e-6;

double knot_of(std::uint64_t seed, std::int64_t column, std::int64_t row) noexcept {
  const auto c = static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15u;
  const auto r = static_cast<std::uint64_t>(row) * 0xC2B2AE3D27D4EB4Fu;
  return 2.0 * share_of(spread(seed ^ c ^ (r << 1 | r >> 63))) - 1.0;
}

std::int64_t floor_of(double x) noexcept {
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

/// −1 .. 1
double eased_noise(std::uint64_t seed, double x, double y, Knots& square) noexcept {
  const std::int64_t i = floor_of(x);
  const std::int64_t k = floor_of(y);
  if (square.column != i || square.row != k) {
    const double a = knot_of(seed, i, k);
    const double b = knot_of(seed, i + 1, k);
    const double c = knot_of(seed, i, k + 1);
    const double d = knot_of(seed, i + 1, k + 1);
    square = {i, k, a, b - a, c - a, a - b - c + d};
  }
  const auto ease = [](double s) { return s * s * (3.0 - 2.0 * s); };
  const double across = ease(x - static_cast<double>(i));
  const double up = ease(y - static_cast<double>(k));
  return square.a + across * square.east + up * (square.north + across * square.both);
}

/// Where the ray leaves the polygon first after begin_m, in plan; max_m if it does not.
double leaves_at(const std::vector<Vec2>& polygon, Vec3 from, Vec3 dir, double begin_m,
                 double max_m) noexcept {
  const Vec2 o{from.x, from.y};
  const Vec2 d{dir.x, dir.y};
  double nearest = max_m;
  for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    const Vec2 edge = polygon[i] - polygon[k];
    const double across = cross(d, edge);
    if (across == 0.0) continue;
    const Vec2 to = polygon[k] - o;
    const double t = cross(to, edge) / across;
    const double s = cross(to, d) / across;
    if (s >= 0.0 && s <= 1.0 && t > begin_m && t < nearest) nearest = t;
  }
  return nearest;
}

}  // namespace

bool inside(const std::vector<Vec2>& polygon, Vec2 at) noexcept {
  bool in = false;
  for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    const Vec2 a = polygon[i];
    const Vec2 b = polygon[k];
    if ((a.y > at.y) == (b.y > at.y)) continue;
    if (at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

Terrain::Terrain(const Ground& ground, std::uint64_t seed)
    : rise_x_(std::tan(ground.slope_rad) * std::cos(ground.uphill_rad)),
      rise_y_(std::tan(ground.slope_rad) * std::sin(ground.uphill_rad)),
      bumps_(ground.bumps),
      drops_(ground.drops) {
  for (std::size_t i = 0; i < std::min<std::size_t>(8, ground.uneven.size()); ++i) {
    const Uneven& u = ground.uneven[i];
    layers_.push_back({u.height_m, 1.0 / u.patch_m, spread(seed + i)});
    low_m_ -= u.height_m;
    high_m_ += u.height_m;
    // 1.5 is the steepest of the easing; neighbouring knots differ by two heights at most, and
    // where they do so to one side they cannot to the other.
    steep_ += 3.0 * u.height_m / u.patch_m;
    step_m_ = std::min(step_m_, u.patch_m / 16.0);
  }
  for (const Bump& b : bumps_) {
    (b.height_m > 0.0 ? high_m_ : low_m_) += b.height_m;
    steep_ += std::abs(b.height_m) / b.radius_m * std::numbers::pi / 2.0;
    step_m_ = std::min(step_m_, b.radius_m / 16.0);
  }
  for (const Drop& d : drops_) {
    Sides s{d.points.front(), d.points.front()};
    for (const Vec2 p : d.points) {
      s.low = {std::min(s.low.x, p.x), std::min(s.low.y, p.y)};
      s.high = {std::max(s.high.x, p.x), std::max(s.high.y, p.y)};
    }
    drop_sides_.push_back(s);
  }
}

double Terrain::detail_m(Vec2 at, Squares& squares) const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& l = layers_[i];
    sum += l.height_m * eased_noise(l.seed, at.x * l.per_m, at.y * l.per_m, squares.of[i]);
  }
  for (const Bump& b : bumps_) {
    const double off2 = dot(at - b.at, at - b.at);
    if (off2 >= b.radius_m * b.radius_m) continue;
    sum += b.height_m * 0.5 * (1.0 + std::cos(std::numbers::pi * std::sqrt(off2) / b.radius_m));
  }
  return sum;
}

double Terrain::surface_m(Vec2 at) const noexcept {
  Squares squares;
  return rise_x_ * at.x + rise_y_ * at.y + detail_m(at, squares);
}

const Drop* Terrain::drop_at(Vec2 at) const noexcept {
  for (std::size_t i = 0; i < drops_.size(); ++i) {
    const Sides& s = drop_sides_[i];
    if (at.x < s.low.x || at.x > s.high.x || at.y < s.low.y || at.y > s.high.y) continue;
    if (inside(drops_[i].points, at)) return &drops_[i];
  }
  return nullptr;
}

double Terrain::depth_m(Vec2 at) const noexcept {
  const Drop* drop = drop_at(at);
  return drop != nullptr ? drop->depth_m : 0.0;
}

double Terrain::height_m(Vec2 at) const noexcept {
  return surface_m(at) - depth_m(at);
}

double Terrain::facing(Vec3 dir, Vec2 at) const noexcept {
  double dx = rise_x_;
  double dy = rise_y_;
  if (!layers_.empty() || !bumps_.empty()) {
    constexpr double kAside_m = 0.01;
    Squares squares;
    const double here = detail_m(at, squares);
    dx += (detail_m({at.x + kAside_m, at.y}, squares) - here) / kAside_m;
    dy += (detail_m({at.x, at.y + kAside_m}, squares) - here) / kAside_m;
  }
  const double steep = std::sqrt(1.0 + dx * dx + dy * dy);
  return std::clamp(-(dir.z - dx * dir.x - dy * dir.y) / steep, 0.0, 1.0);
}

/// Range at which the ray comes below surface + shift.
std::optional<double> Terrain::march(Vec3 from, Vec3 dir, double begin_m, double max_m,
                                     double shift_m) const noexcept {
  // Over the plane: above(t) = a + b·t. Detail lies in low .. high, so nothing is met before the
  // ray is `high` over the plane, and it is certainly below when it is `low` over it.
  const double a = from.z - rise_x_ * from.x - rise_y_ * from.y - shift_m;
  const double b = dir.z - rise_x_ * dir.x - rise_y_ * dir.y;
  double t = begin_m;
  if (a + b * t > high_m_) {
    if (b >= 0.0) return std::nullopt;
    t = (high_m_ - a) / b;
  }
  if (t >= max_m) return std::nullopt;
  if (layers_.empty() && bumps_.empty()) return t;
  const double flat = std::hypot(dir.x, dir.y);
  const double closing = std::abs(b) + steep_ * flat;
  const double least_m = step_m_ / std::max(flat, 0.05);
  Squares squares;
  const auto gap = [&](double at_m) {
    return a + b * at_m - detail_m({from.x + at_m * dir.x, from.y + at_m * dir.y}, squares);
  };
  double before = t;
  for (int i = 0; i < kMostSteps; ++i) {
    const double g = gap(t);
    if (g <= 0.0) {
      double low = before;
      double high = t;
      while (high - low > kClose_m) {
        const double middle = 0.5 * (low + high);
        (gap(middle) <= 0.0 ? high : low) = middle;
      }
      return high;
    }
    if (b > 0.0 && a + b * t > high_m_) return std::nullopt;
    before = t;
    t += std::max(g / closing, least_m);
    if (t >= max_m) {
      if (before >= max_m - kClose_m || gap(max_m) > 0.0) return std::nullopt;
      t = max_m;
    }
  }
  return std::nullopt;
}

std::optional<Terrain::Met> Terrain::meet(Vec3 from, Vec3 dir, double max_m,
                                          double raise_m) const noexcept {
  double begin_m = 0.0;
  // Each drop is left at most once for good; a bound keeps odd polygons from holding us.
  for (int tries = 0; tries < 64; ++tries) {
    const auto t = march(from, dir, begin_m, max_m, raise_m);
    if (!t) return std::nullopt;
    const Vec2 at{from.x + *t * dir.x, from.y + *t * dir.y};
    const Drop* drop = drops_.empty() ? nullptr : drop_at(at);
    if (drop == nullptr) return Met{*t, facing(dir, at)};
    const double wall_m = leaves_at(drop->points, from, dir, *t + kEdge_m, max_m);
    const auto floor_m = march(from, dir, *t, wall_m, raise_m - drop->depth_m);
    if (floor_m) {
      return Met{*floor_m, facing(dir, {from.x + *floor_m * dir.x, from.y + *floor_m * dir.y})};
    }
    if (wall_m >= max_m) return std::nullopt;
    const Vec2 edge{from.x + wall_m * dir.x, from.y + wall_m * dir.y};
    if (from.z + wall_m * dir.z <= surface_m(edge) + raise_m &&
        depth_m({edge.x + kEdge_m * dir.x, edge.y + kEdge_m * dir.y}) == 0.0) {
      return Met{wall_m, std::hypot(dir.x, dir.y)};
    }
    begin_m = wall_m + kEdge_m;
  }
  return std::nullopt;
}

Pose Terrain::stand(Vec2 at, double yaw_rad, double half_length_m, double half_width_m,
                    double ahead_m) const noexcept {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  const auto under = [&](double forward, double left) {
    return height_m({at.x + c * forward - s * left, at.y + s * forward + c * left});
  };
  const double front_left = under(ahead_m + half_length_m, half_width_m);
  const double front_right = under(ahead_m + half_length_m, -half_width_m);
  const double rear_left = under(ahead_m - half_length_m, half_width_m);
  const double rear_right = under(ahead_m - half_length_m, -half_width_m);
  const double rise = (front_left + front_right - rear_left - rear_right) / (4.0 * half_length_m);
  const double lean = (front_left + rear_left - front_right - rear_right) / (4.0 * half_width_m);
  Pose out;
  out.x_m = at.x;
  out.y_m = at.y;
  out.z_m = (front_left + front_right + rear_left + rear_right) / 4.0 - ahead_m * rise;
  // Nose up is a negative turn about left; the left axis then rises by sin(roll)·cos(pitch).
  out.pitch_rad = -std::atan(rise);
  out.roll_rad = std::atan(lean * std::cos(out.pitch_rad));
  out.yaw_rad = yaw_rad;
  return out;
}

}  // namespace roverd::sim::world
