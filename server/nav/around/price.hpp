#pragma once
// What a piece of a way costs, in metres of free forward driving; kNever where the body does not
// fit somewhere on it.

#include <algorithm>
#include <cmath>

#include "nav/around/body.hpp"
#include "nav/around/pieces.hpp"

namespace roverd::nav::around {

struct Price {
  static constexpr float kReverse = 2.0F;   ///< a metre backwards
  static constexpr float kSwitch_m = 0.5F;  ///< stopping, to drive the other way
  static constexpr float kPivot_m = 0.25F;  ///< stopping, to turn on the spot
  static constexpr float kTurn_m = 0.5F;    ///< a radian of that
  static constexpr float kBend_m = 0.02F;   ///< a radian of a bend

  const Field* field = nullptr;
  const Body* body = nullptr;
  double reach_m = 0.7;
  bool keeps_ahead = false;  ///< as the question's

  float of(const Pose2& from, const Piece& piece) const noexcept {
    const int n = piece.steps(2.0 * Body::kApart_m, reach_m);
    // Every step is the same, seen from the pose before: no angle is taken in between.
    const Pose2 step = piece.after({}, 1.0 / n);
    const double step_cos = std::cos(step.yaw_rad);
    const double step_sin = std::sin(step.yaw_rad);
    const bool as_at_start = !keeps_ahead || piece.pivot() || piece.length_m < 0.0;
    Stand at{from};
    float sum = 0.0F;
    for (int i = 1; i <= n; ++i) {
      at.x_m += at.cos * step.x_m - at.sin * step.y_m;
      at.y_m += at.sin * step.x_m + at.cos * step.y_m;
      const double cos = at.cos;
      at.cos = cos * step_cos - at.sin * step_sin;
      at.sin = at.sin * step_cos + cos * step_sin;
      if (!body->fits(at, as_at_start)) return Field::kNever;
      sum += field->price(at.x_m, at.y_m);
    }
    if (piece.pivot()) return kPivot_m + kTurn_m * static_cast<float>(std::abs(piece.turn_rad));
    const auto way = static_cast<float>(std::abs(piece.length_m));
    const float bend = way * static_cast<float>(std::abs(piece.curvature_1pm));
    return way * (piece.length_m < 0.0 ? kReverse : 1.0F) * sum / static_cast<float>(n) +
           kBend_m * bend;
  }
  /// Gives up where it costs more than `most`.
  float of(Pose2 from, const Link& link, float most) const noexcept {
    float sum = 0.0F;
    for (std::size_t i = 0; i < link.size; ++i) {
      sum += of(from, link.pieces[i]);
      if (sum > most) return Field::kNever;
      from = link.pieces[i].after(from, 1.0);
    }
    return sum;
  }
  static float least(const Piece& piece) noexcept {
    if (piece.pivot()) return kPivot_m + kTurn_m * static_cast<float>(std::abs(piece.turn_rad));
    const auto way = static_cast<float>(std::abs(piece.length_m));
    return way * (piece.length_m < 0.0 ? kReverse : 1.0F);
  }
  /// The least that a link can cost.
  static float least(const Link& link) noexcept {
    return static_cast<float>(link.length_m) + kTurn_m * static_cast<float>(link.turned_rad);
  }
};

}  // namespace roverd::nav::around
