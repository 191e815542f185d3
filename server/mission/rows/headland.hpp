#pragma once
// How a vehicle comes from one lane of a block into another, seen with the rows' ends below:
//
//     pivot         arc           omega            shunt
//    ┌─────┐      ╭─────╮        ╭─────╮         ◀───────      backwards between two arcs
//    │     │      │     │        │     │         ╭───────╮
//    │     ▼      │     ▼        ╰╮   ╭╯         │ ╭─────│──
//                                 │   ▼          │ ▼
//
// Items that count from where the robot is and points (move and turn), so that no position is
// needed. Pure.

#include <string_view>
#include <vector>

#include "mission/plan.hpp"

namespace roverd::mission {

enum class RowTurn {
  Auto,   ///< on the spot; by a vehicle that cannot: arc, where the lanes are too near shunt
  Pivot,  ///< on the spot, across, on the spot
  Arc,    ///< two quarters, and straight between
  Omega,  ///< out to the other side first and round; where there is room, arc
  Shunt   ///< two quarters, and back between; where there is room, arc
};

std::string_view to_string(RowTurn kind) noexcept;  // auto pivot arc omega shunt

/// What a turn must know of the vehicle. From its profile.
struct TurningVehicle {
  double narrowest_m = 0.0;  ///< radius; 0: it turns on the spot
  bool pulls = false;        ///< a trailer
};

/// From lane to lane, as it will be driven.
struct LaneChange {
  double aside_m = 0.0;  ///< > 0: to the right, as the vehicle points; 0: back into the same lane
  Side hand = Side::Right;  ///< to turn to, where aside_m is 0
  double out_m = 0.0;       ///< out of the lane first
  RowTurn kind = RowTurn::Pivot;
  double radius_m = 0.0;  ///< of arcs
};

/// Auto and what needs less than it has room for are decided here. @return never Auto
RowTurn kind_of(const LaneChange& change, const TurningVehicle& vehicle) noexcept;

/// Appends the items. @param kind as kind_of() says. @return how far beyond the row's end it comes
double change_lane(const LaneChange& change, RowTurn kind, std::vector<Item>& items);

/// A point of a turn, seen from where the lane ends and as the vehicle points there.
struct TurnPoint {
  double ahead_m = 0.0;
  double right_m = 0.0;
};
/// Where such items lead the vehicle's origin, a few centimetres apart.
std::vector<TurnPoint> way_of(const std::vector<Item>& items);

}  // namespace roverd::mission
