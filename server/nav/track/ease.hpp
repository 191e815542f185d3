#pragma once
// Bends whose curvature comes and goes as steered wheels can turn.
//
//      κ │     ┌──────┐ arcs                    κ │      ╭────╮ eased
//        │     │      │                           │    ╱      ╲
//        └─────┘      └┐     ┌── s                └──╱────────╲      ╱── s
//                      └─────┘                                  ╲──╱
//
// Each place of the eased way is the mean of the arcs' places over a window of length w about it:
//
//   p(s) = 1/w ∫ q(u) du,  p' = (q(s + w/2) − q(s − w/2))/w,  p'' = (t(s + w/2) − t(s − w/2))/w
//
// so that lines stay what they are, and the curvature changes over w. The way lies inside of an arc
// of radius R by w²/(24·R). Pure; lengths m, angles rad, left positive.

#include <array>
#include <cstddef>

#include "nav/track/path.hpp"

namespace roverd::nav {

/// Up to two arcs, one after the other, with straight lines before and behind.
class EasedBend {
 public:
  struct Arc {
    double length_m = 0.0;
    double curvature_1pm = 0.0;
  };
  struct Place {
    EnuPoint at;
    double curvature_1pm = 0.0;
  };

  /// @param begin, yaw_rad where the first arc begins. @param window_m > 0.
  EasedBend(EnuPoint begin, double yaw_rad, const std::array<Arc, 2>& arcs, double window_m);

  /// From window/2 before the arcs to window/2 behind them.
  double length_m() const noexcept { return arcs_[0].length_m + arcs_[1].length_m + window_m_; }
  /// @param s_m 0 … length_m().
  Place place(double s_m) const noexcept;

 private:
  struct Pose {
    EnuPoint at;
    double yaw_rad = 0.0;
  };
  Pose raw(double s_m) const noexcept;

  std::array<Arc, 2> arcs_;
  std::array<Pose, 3> joints_;  ///< before, between and behind the arcs
  double window_m_;
};

/// How far inside of an arc the eased way lies.
inline double eased_inside_m(double radius_m, double window_m) noexcept {
  return window_m * window_m / (24.0 * radius_m);
}

}  // namespace roverd::nav
