#pragma once
// How fast a robot may drive that knows its place only so well.
//
//   v │ most ──────╮
//     │             ╲
//     │ creep        ╰─────────
//     └──────────┬───┬──────────▶ sigma of the position
//       sigma_free_m sigma_slow_m        or, in a corridor: 2 sigma of half of it, and of all of it

#include <algorithm>
#include <optional>

#include "robot/config.hpp"

namespace roverd::robot {

/// @param corridor_m of the mission that runs; empty: none. @param most_mps, creep_mps of nav.speed
inline double certain_mps(double sigma_m, std::optional<double> corridor_m, double most_mps,
                          double creep_mps, const SafetyParams& p) noexcept {
  const auto part = [](double value, double from, double to) {
    return to > from ? std::clamp((value - from) / (to - from), 0.0, 1.0)
                     : (value > to ? 1.0 : 0.0);
  };
  double doubt = part(sigma_m, p.sigma_free_m, p.sigma_slow_m);
  if (corridor_m) doubt = std::max(doubt, part(2.0 * sigma_m, 0.5 * *corridor_m, *corridor_m));
  return most_mps - doubt * (most_mps - std::min(creep_mps, most_mps));
}

}  // namespace roverd::robot
