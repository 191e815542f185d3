#pragma once
// The fence while driving, and before.
//
//        margin + σ         The robot acts on the place where it would stop, not where it is:
//      │◀────▶│             p + v·t_react + v²/2a. Beyond the margin it stops; what leads farther
//   ───┤ ·····│◀──── p ▶    inside stays allowed, by hand also from outside.
//    limit    stop          The margin is that of the parameters beyond the body's farthest part,
//                           however it is turned (Config::kept_fence).
//
// What is asked ahead (a mission, a goal, the way home) is looked at as a whole before it begins,
// on the caller's thread. Source: navigation notes, section 18.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/geo.hpp"
#include "base/snapshot.hpp"
#include "mission/checks.hpp"
#include "mission/fence/fence.hpp"
#include "nav/behave/route.hpp"
#include "robot/config.hpp"

namespace roverd::robot {

/// A fence in one local frame, and what it says of the mission that was loaded. Immutable.
struct LaidFence {
  std::uint64_t id = 0;
  std::shared_ptr<const mission::Fence> fence;
  std::uint32_t frame_id = 0;  ///< 0: no frame yet
  mission::CompiledFence limits;
  std::vector<base::EnuPoint> rally;
  std::uint64_t mission_id = 0;               ///< CompiledMission::id of the one that was looked at
  double margin_m = 0.0;                      ///< with this Config::way_margin_m
  std::optional<mission::Finding> objection;  ///< to it; empty: it stays inside
};

/// Where a route leaves the fence, or comes nearer to its limit than the margin, jumps and laps
/// included; names the item ("outside_fence"). Empty: nowhere. The ways home (Route::home_ends) are
/// looked at when it starts, as home may change. Linear in the route's length: not for the control
/// thread.
std::optional<mission::Finding> route_objection(const nav::Route& route,
                                                const mission::CompiledFence& limits,
                                                double margin_m);

/// May the straight way be driven? It may begin nearer to the limit than the margin, inside, if it
/// does not come nearer still.
bool may_drive(const mission::CompiledFence& limits, base::EnuPoint from, base::EnuPoint to,
               double margin_m) noexcept;

/// Where the robot is after `part` (0..1) of the way that braking from now on takes, on the arc
/// that it drives, which is followed for a quarter turn at most.
base::EnuPoint stopping_place(const base::Pose& pose, const base::BodyTwist& twist, double part,
                              const FenceParams& p) noexcept;

/// May it move so? Turning on the spot it always may. @param twist over ground
bool may_move(const mission::CompiledFence& limits, const base::Pose& pose,
              const base::BodyTwist& twist, bool by_hand, const FenceParams& p) noexcept;

}  // namespace roverd::robot
