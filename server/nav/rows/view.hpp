#pragma once
// What is seen of the row that is driven along, in the frame O of the odometry.
//
//      ▓ ▓▓ ▓▓▓   ▓▓ ▓▓ ▓ ▓▓▓▓         left side: d = +width/2
//   ─ ─ ─ ─ ─ ─ L ─ ─ ─ ─ ─ ─ ─ ─▶     the line; L: its frame beside the robot, x along it
//      ▓▓▓ ▓▓  ▓▓▓ ▓▓▓      ▓▓ ▓       right side: d = −width/2        · · ·  end: to_end_m
//
// The line is an arc: a place of it at s from L lies d = 0 beside it. Metres, radians, left
// positive.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/time.hpp"
#include "nav/sense/odometry.hpp"

namespace roverd::nav::rows {

using sense::Pose2;

/// Which plants lead: both sides in the middle between them, or one at a distance.
enum class Sides : std::uint8_t { Both, Left, Right };
std::string_view to_string(Sides sides) noexcept;  // both left right
enum class Seeing : std::uint8_t { Line, Rays };
std::string_view to_string(Seeing seeing) noexcept;  // line rays

struct RowOrder {
  Sides sides = Sides::Both;
  Seeing seeing = Seeing::Line;
  double gap_m = 1.0;  ///< from the plants of the one side to the line; without meaning for Both
  friend bool operator==(const RowOrder&, const RowOrder&) = default;
};

struct RowView {
  base::Time stamp;            ///< of the scan that told it last
  Pose2 line;                  ///< X_OL
  double curvature_1pm = 0.0;  ///< of the line
  double width_m = 0.0;        ///< between the plants of both sides; 0: not known
  double width_sigma_m = 0.0;
  /// The row moves so far to the left in O for each metre that the body drives: what slides to the
  /// right without the odometry's knowing.
  double drift = 0.0;
  /// Covariance of where the line lies: [shift to the left at L, m; direction, rad; curvature,
  /// 1/m].
  std::array<double, 9> covariance{};
  int left = 0;                    ///< pieces of half a metre of that side that the line rests on
  int right = 0;                   ///< likewise
  double seen_m = 0.0;             ///< way along this row since it was found
  double plants_m = 0.0;           ///< from the first plant that was seen to the last one
  bool by_rays = false;            ///< of the rays of one moment, that are never sure
  std::optional<double> to_end_m;  ///< from L to the last plants, where nothing comes behind them

  /// 1 sigma of where the line lies at s from L.
  double sigma_m(double s_m) const noexcept {
    const double j[3] = {1.0, s_m, 0.5 * s_m * s_m};
    double sum = 0.0;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        sum += j[r] * j[c] * covariance[static_cast<std::size_t>(3 * r + c)];
    }
    return std::sqrt(std::max(0.0, sum));
  }
};

/// Along an arc and beside it. @param q in the frame of its begin.
struct Along {
  double s_m = 0.0;
  double d_m = 0.0;
};
/// The circle's distance in the form that holds for straight lines, too: with a = κ(x²+y²) − 2y,
/// d = −a/(1 + √(1 + κa)).
inline Along beside_arc(double x_m, double y_m, double curvature_1pm) noexcept {
  const double k = curvature_1pm;
  const double a = k * (x_m * x_m + y_m * y_m) - 2.0 * y_m;
  const double root = std::sqrt(std::max(0.0, 1.0 + k * a));
  const double s = std::abs(k) < 1e-6 ? x_m : std::atan2(k * x_m, 1.0 - k * y_m) / k;
  return {s, -a / (1.0 + root)};
}
/// The frame of an arc at s from its begin.
inline Pose2 on_arc(double s_m, double curvature_1pm) noexcept {
  return sense::along(s_m, curvature_1pm * s_m, 1.0);
}
/// Of the body beside the line. @param body X_OB.
inline Along beside_line(const RowView& view, const Pose2& body) noexcept {
  const Pose2 in_line = sense::inverse(view.line) * body;
  return beside_arc(in_line.x_m, in_line.y_m, view.curvature_1pm);
}

}  // namespace roverd::nav::rows
