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

  float of(const Pose2& from, const Piece& piece) const noexcept {
    const int n = piece.steps(2.0 * Body::kApart_m, reach_m);
    float sum = 0.0F;
    for (int i = 1; i <= n; ++i) {
      const Pose2 p = piece.after(from, static_cast<double>(i) / n);
      if (!body->fits(p)) return Field::kNever;
      sum += field->price(p.x_m, p.y_m);
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
