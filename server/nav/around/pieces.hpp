#pragma once
// Ways made of arcs, straights and turns on the spot; and the shortest of arcs and straights
// between two poses.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/angle.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::around {

using sense::Pose2;

/// length_m < 0: backwards. turn_rad ≠ 0: on the spot, the other two are 0.
struct Piece {
  double curvature_1pm = 0.0;  ///< of the ground track, left positive for the body
  double length_m = 0.0;
  double turn_rad = 0.0;

  bool pivot() const noexcept { return turn_rad != 0.0; }
  /// After a part of it, 0 to 1.
  Pose2 after(const Pose2& from, double part) const noexcept {
    if (pivot()) return {from.x_m, from.y_m, base::wrap_rad(from.yaw_rad + part * turn_rad)};
    const double l = part * length_m;
    return from * sense::along(l, l * curvature_1pm, 1.0);
  }
  /// Poses of a sweep so that no point of a body of this reach goes farther than apart_m.
  int steps(double apart_m, double reach_m) const noexcept {
    const double way = pivot()
                           ? std::abs(turn_rad) * reach_m
                           : std::abs(length_m) * (1.0 + 0.8 * std::abs(curvature_1pm) * reach_m);
    return std::max(1, static_cast<int>(std::ceil(way / apart_m)));
  }
};

/// Three of them at most.
struct Link {
  std::array<Piece, 3> pieces{};
  std::size_t size = 0;
  double length_m = 0.0;  ///< driven
  double turned_rad = 0.0;

  void add(const Piece& p) noexcept {
    if (std::abs(p.length_m) < 1e-6 && std::abs(p.turn_rad) < 1e-6) return;
    pieces[size++] = p;
    length_m += std::abs(p.length_m);
    turned_rad += std::abs(p.turn_rad);
  }
};

/// Dubins' shortest of the six. @param radius_m more than 0
Link dubins(const Pose2& from, const Pose2& to, double radius_m) noexcept;
/// Turn, straight ahead, turn.
Link straight_between_turns(const Pose2& from, const Pose2& to) noexcept;

}  // namespace roverd::nav::around
