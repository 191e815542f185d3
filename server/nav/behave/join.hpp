#pragma once
// Where a mission that is started joins its way: a robot that already stands on its beginning, or
// beside it, drives on from there and does not turn back to item 1.
//
//     item 1 ○────────────────────────────────▶ ○ item 2
//            ├── left out ──┤s                        s: nearest place of the way ahead
//                           ┆
//                          ▷ robot                    within join_m, or 3 sigma of what is known
//
// Only plain waypoints may lie behind s: nothing that holds, acts, waits, turns or ends is ever
// left out. A robot that turns on the spot must point ahead, else it begins at item 1; one that is
// steered goes round either way, and a place beside it is none that it could come to. Pure.

#include <optional>

#include "nav/behave/params.hpp"
#include "nav/behave/route.hpp"

namespace roverd::nav {

/// Beside its way by so much of nav.behave.lost_m a robot begins, not nearer to being lost.
inline constexpr double kBesideOfLost = 0.8;

/// How the robot stands.
struct Stand {
  EnuPoint at;
  std::optional<double> yaw_rad{};  ///< empty: not known
  double sigma_m = 0.0;             ///< of the position
};

struct Joining {
  std::size_t step = 0;  ///< the first waypoint that lies ahead of it
  double s_m = 0.0;      ///< where on Route::forth.path it joins
  double skips_m = 0.0;  ///< of the way that a start at item 1 would drive
  int left_out = 0;      ///< waypoints behind it that do not count as reached either
};

/// How far from an item the robot may stand so that it counts as reached: nobody comes nearer to a
/// place than the position is known.
double arrival_radius_m(const RouteNode* node, double sigma_m, const BehaveParams& p) noexcept;

/// @param step of Route::forth that a start begins with. Empty: it begins there, as ever.
std::optional<Joining> join_way(const Route& route, std::size_t step, const Stand& stand,
                                const PathParams& path, const BehaveParams& behave) noexcept;

}  // namespace roverd::nav
