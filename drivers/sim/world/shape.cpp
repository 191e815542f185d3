#include "sim/world/shape.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "sim/world/terrain.hpp"

namespace roverd::sim::world {
namespace {

constexpr double kTip_m = 1e-9;  ///< a ray straight down on a point meets it
constexpr double kAll = std::numeric_limits<double>::infinity();

/// low <= o + t·d <= high
Span slab(double o, double d, double low, double high) noexcept {
  if (d == 0.0) return o >= low && o <= high ? Span{-kAll, kAll} : Span{};
  const double one = (low - o) / d;
  const double two = (high - o) / d;
  return one < two ? Span{one, two} : Span{two, one};
}

Span both(Span one, Span two) noexcept {
  return {std::max(one.from, two.from), std::min(one.to, two.to)};
}

/// a·t² + 2·b·t + c <= 0, a >= 0
Span under_parabola(double a, double b, double c) noexcept {
  if (a <= 0.0) return c <= 0.0 ? Span{-kAll, kAll} : Span{};
  const double root = b * b - a * c;
  if (root < 0.0) return {};
  const double wide = std::sqrt(root);
  return {(-b - wide) / a, (-b + wide) / a};
}

Span in_cone(const Shape& shape, Vec3 o, Vec3 d) noexcept {
  const double slope = shape.a / (shape.high_m - shape.low_m);
  const double px = o.x - shape.x;
  const double py = o.y - shape.y;
  const double pz = shape.high_m - o.z;  // below the point
  const double k2 = slope * slope;
  const double a = d.x * d.x + d.y * d.y - k2 * d.z * d.z;
  const double b = px * d.x + py * d.y + k2 * pz * d.z;
  const double c = px * px + py * py - k2 * pz * pz;
  Span out;
  const auto take = [&](double t) {
    out.from = std::min(out.from, t);
    out.to = std::max(out.to, t);
  };
  const auto on_side = [&](double t) {
    const double z = o.z + t * d.z;
    if (z >= shape.low_m && z <= shape.high_m + kTip_m) take(t);
  };
  if (std::abs(a) > 1e-12) {
    const double root = b * b - a * c;
    if (root >= -kTip_m * b * b) {
      const double wide = std::sqrt(std::max(0.0, root));
      on_side((-b - wide) / a);
      on_side((-b + wide) / a);
    }
  } else if (b != 0.0) {
    on_side(-c / (2.0 * b));
  }
  if (d.z != 0.0) {
    const double t = (shape.low_m - o.z) / d.z;
    if (std::hypot(px + t * d.x, py + t * d.y) <= shape.a) take(t);
  }
  return out;
}

Vec2 turned_back(const Shape& shape, double x, double y) noexcept {
  return {shape.c * x + shape.s * y, -shape.s * x + shape.c * y};
}

double to_segment_m(Vec2 at, Vec2 a, Vec2 b) noexcept {
  const Vec2 along = b - a;
  const double long2 = dot(along, along);
  const double share = long2 > 0.0 ? std::clamp(dot(at - a, along) / long2, 0.0, 1.0) : 0.0;
  return length(at - (a + share * along));
}

bool crossing(Vec2 a, Vec2 b, Vec2 c, Vec2 d) noexcept {
  const double one = cross(b - a, c - a);
  const double two = cross(b - a, d - a);
  const double three = cross(d - c, a - c);
  const double four = cross(d - c, b - c);
  return ((one > 0.0) != (two > 0.0)) && ((three > 0.0) != (four > 0.0));
}

double between_m(const std::vector<Vec2>& polygon, std::span<const Vec2> other) noexcept {
  double nearest = kAll;
  for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
    for (std::size_t m = 0, n = other.size() - 1; m < other.size(); n = m++) {
      if (crossing(polygon[i], polygon[k], other[m], other[n])) return 0.0;
      nearest = std::min({nearest, to_segment_m(polygon[i], other[m], other[n]),
                          to_segment_m(other[m], polygon[i], polygon[k])});
    }
  }
  return nearest;
}

}  // namespace

Span span_in(const Shape& shape, Vec3 o, Vec3 d) noexcept {
  const double px = o.x - shape.x;
  const double py = o.y - shape.y;
  if (shape.form == Form::Box) {
    const Vec2 p = turned_back(shape, px, py);
    const Vec2 v = turned_back(shape, d.x, d.y);
    const Span in = both(slab(p.x, v.x, -shape.a, shape.a), slab(p.y, v.y, -shape.b, shape.b));
    return in.empty() ? in : both(in, slab(o.z, d.z, shape.low_m, shape.high_m));
  }
  if (shape.form == Form::Cone) return in_cone(shape, o, d);
  double a = d.x * d.x + d.y * d.y;
  double b = px * d.x + py * d.y;
  double c = px * px + py * py - shape.a * shape.a;
  if (shape.form == Form::Sphere) {
    const double pz = o.z - 0.5 * (shape.low_m + shape.high_m);
    a += d.z * d.z;
    b += pz * d.z;
    c += pz * pz;
    return under_parabola(a, b, c);
  }
  const Span in = under_parabola(a, b, c);
  return in.empty() ? in : both(in, slab(o.z, d.z, shape.low_m, shape.high_m));
}

double facing(const Shape& shape, Vec3 at, Vec3 dir) noexcept {
  constexpr double kOnTop_m = 1e-6;
  const double px = at.x - shape.x;
  const double py = at.y - shape.y;
  if (shape.form != Form::Sphere &&
      (at.z >= shape.high_m - kOnTop_m || at.z <= shape.low_m + kOnTop_m)) {
    return std::abs(dir.z);
  }
  if (shape.form == Form::Box) {
    const Vec2 p = turned_back(shape, px, py);
    const Vec2 v = turned_back(shape, dir.x, dir.y);
    const bool end = shape.a - std::abs(p.x) < shape.b - std::abs(p.y);
    return std::abs(end ? v.x : v.y);
  }
  const double across = px * dir.x + py * dir.y;
  if (shape.form == Form::Cylinder) return std::min(1.0, std::abs(across) / shape.a);
  if (shape.form == Form::Cone) {
    const double slope = shape.a / (shape.high_m - shape.low_m);
    const double r = std::max(std::hypot(px, py), 1e-9);
    return std::min(1.0, std::abs(across / r + slope * dir.z) / std::hypot(1.0, slope));
  }
  const double pz = at.z - 0.5 * (shape.low_m + shape.high_m);
  return std::min(1.0, std::abs(across + pz * dir.z) / shape.a);
}

Section section_of(const Shape& shape, double low_m, double high_m) noexcept {
  Section out{false, true, {shape.x, shape.y}, shape.a, shape.b, shape.c, shape.s};
  const double low = std::max(low_m, shape.low_m);
  const double high = std::min(high_m, shape.high_m);
  if (!(low <= high)) return out;
  out.any = true;
  out.disc = shape.form != Form::Box;
  if (shape.form == Form::Cone) {
    out.a = shape.a * (shape.high_m - low) / (shape.high_m - shape.low_m);
  } else if (shape.form == Form::Sphere) {
    const double middle = 0.5 * (shape.low_m + shape.high_m);
    const double off = std::clamp(middle, low, high) - middle;
    out.a = std::sqrt(std::max(0.0, shape.a * shape.a - off * off));
  }
  return out;
}

double distance_m(const std::vector<Vec2>& polygon, const Section& section) noexcept {
  if (inside(polygon, section.middle)) return 0.0;
  if (section.disc) {
    double nearest = kAll;
    for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
      nearest = std::min(nearest, to_segment_m(section.middle, polygon[i], polygon[k]));
    }
    return std::max(0.0, nearest - section.a);
  }
  const Vec2 along{section.a * section.c, section.a * section.s};
  const Vec2 across{-section.b * section.s, section.b * section.c};
  const Vec2 m = section.middle;
  const std::array<Vec2, 4> corners{m + along + across, m - along + across, m - along - across,
                                    m + along - across};
  const Vec2 first = polygon.front() - m;
  if (std::abs(dot(first, {section.c, section.s})) <= section.a &&
      std::abs(dot(first, {-section.s, section.c})) <= section.b) {
    return 0.0;
  }
  return between_m(polygon, corners);
}

double distance_m(const std::vector<Vec2>& polygon, const std::vector<Vec2>& other) noexcept {
  if (inside(polygon, other.front()) || inside(other, polygon.front())) return 0.0;
  return between_m(polygon, other);
}

}  // namespace roverd::sim::world
