#pragma once
// The body from above: a convex polygon in B (FLU, metres).

#include <array>
#include <cstddef>
#include <span>

#include "base/result.hpp"

namespace roverd::nav::sense {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
};
constexpr Vec2 operator-(Vec2 a, Vec2 b) noexcept {
  return {a.x - b.x, a.y - b.y};
}
constexpr Vec2 operator+(Vec2 a, Vec2 b) noexcept {
  return {a.x + b.x, a.y + b.y};
}
constexpr Vec2 operator*(double k, Vec2 a) noexcept {
  return {k * a.x, k * a.y};
}
constexpr double dot(Vec2 a, Vec2 b) noexcept {
  return a.x * b.x + a.y * b.y;
}
constexpr double cross(Vec2 a, Vec2 b) noexcept {
  return a.x * b.y - a.y * b.x;
}

/// Counter-clockwise, 3 to 16 corners, strictly convex. Copied freely.
class Footprint {
 public:
  static constexpr std::size_t kMaxCorners = 16;

  /// The convex hull of the corners. Refused: fewer than three that differ, no area, farther than
  /// 20 m from the origin, not finite, or more than kMaxCorners in the hull.
  static base::Result<Footprint> of(std::span<const Vec2> corners);
  /// @param back_m from the origin to the rear end (half of the length; less for a steered vehicle,
  /// whose origin is its rear axle). All positive.
  static Footprint box(double length_m, double width_m, double back_m) noexcept;

  /// Turned about the origin, to the left.
  Footprint turned(double rad) const noexcept;

  std::span<const Vec2> corners() const noexcept { return {corners_.data(), size_}; }
  /// Metres to the polygon, negative inside (then to the nearest edge).
  double distance_m(Vec2 p) const noexcept;
  /// Farthest corner from the origin.
  double reach_m() const noexcept { return reach_m_; }

 private:
  Footprint() = default;
  void finish() noexcept;

  std::array<Vec2, kMaxCorners> corners_{};
  std::size_t size_ = 0;
  double reach_m_ = 0.0;
};

}  // namespace roverd::nav::sense
