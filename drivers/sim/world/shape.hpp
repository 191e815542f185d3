#pragma once
// What rays meet and bodies touch: upright solids, and spheres of leaves. Pure geometry.

#include <cstdint>
#include <limits>
#include <vector>

#include "sim/world/vec.hpp"

namespace roverd::sim::world {

enum class Form : std::uint8_t {
  Cylinder,  ///< radius a, upright
  Cone,      ///< radius a at low_m, a point at high_m
  Box,       ///< half length a, half width b, turned by (c, s); upright
  Sphere,    ///< radius a about (x, y, middle of low_m and high_m)
};

struct Shape {
  Form form = Form::Box;
  bool moving = false;
  float reflect = 0.5F;
  float density_pm = 0.0F;  ///< 0: solid; otherwise leaves (Thing::density_pm)
  std::uint32_t thing = 0;  ///< number in World::things
  double x = 0.0;
  double y = 0.0;
  double low_m = 0.0;
  double high_m = 1.0;
  double a = 0.1;
  double b = 0.1;
  double c = 1.0;
  double s = 0.0;

  /// No point of it is farther from (x, y).
  double reach_m() const noexcept { return form == Form::Box ? std::hypot(a, b) : a; }
};

/// The part of a line within a convex shape: from .. to, both along the ray; empty: from > to.
struct Span {
  double from = std::numeric_limits<double>::infinity();
  double to = -std::numeric_limits<double>::infinity();
  bool empty() const noexcept { return !(from <= to); }
};

/// @param dir unit. The line is met behind `from` too (negative).
Span span_in(const Shape& shape, Vec3 from, Vec3 dir) noexcept;

/// Cosine of the angle between a ray and the face that it meets at `at`; 0 .. 1.
double facing(const Shape& shape, Vec3 at, Vec3 dir) noexcept;

/// In plan, what of a shape lies between two heights: a disc, a turned rectangle, or nothing.
struct Section {
  bool any = false;
  bool disc = true;
  Vec2 middle;
  double a = 0.0;  ///< radius, or half length
  double b = 0.0;
  double c = 1.0;
  double s = 0.0;
};
Section section_of(const Shape& shape, double low_m, double high_m) noexcept;

/// How far a polygon (convex or not, at least 3 corners) and a section are from each other; 0: they
/// overlap or touch.
double distance_m(const std::vector<Vec2>& polygon, const Section& section) noexcept;
double distance_m(const std::vector<Vec2>& polygon, const std::vector<Vec2>& other) noexcept;

}  // namespace roverd::sim::world
