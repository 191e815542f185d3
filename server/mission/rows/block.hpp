#pragma once
// A block of rows as a mission: from row to row by row, move and turn items. Nothing of it needs a
// position but the way to its entry.
//
//      ┌──▶ ░░░░░░░░░░░░░░░░░░ ──╮ out_m
//   entry   row 1                │ spacing_m · (skip + 1), turned as headland.hpp says
//      ╭─── ░░░░░░░░░░░░░░░░░░ ◀─╯        every other row is driven the other way
//      ▼    row 2 …
//
// Not alternating, each row but the last is driven back, and the next one entered at the same end
// as row 1. Where a block is told to lie (lies.hpp), its rows end at the latest kPastEnd_m beyond
// there, as far as the position is known then; they end by sight before.
//
// Pure.

#include <array>
#include <optional>
#include <vector>

#include "base/result.hpp"
#include "mission/plan.hpp"
#include "mission/rows/headland.hpp"

namespace roverd::mission {

struct RowBlock {
  int rows = 1;             ///< lanes to drive, 1 .. kMostRows
  double spacing_m = 2.5;   ///< from the middle of one to that of the next, 0.3 .. 50
  Side turn = Side::Right;  ///< where row 2 lies, seen along row 1
  int skip = 0;             ///< so many rows are left out and driven on later passes, 0 .. 20
  double out_m = 1.5;       ///< out of a row before it turns, 0.1 .. kFarthestOut_m
  RowTurn turn_kind = RowTurn::Auto;
  std::optional<double> radius_m{};  ///< of turns that are arcs; empty: as suits the vehicle
  bool alternating = true;
  /// Where row 1 begins; empty: where the robot stands when it starts, pointing along it.
  std::optional<LatLon> entry{};
  std::optional<double> heading_deg{};  ///< along row 1; needed with an entry
  /// Where each lane begins and ends as row 1 is driven, from lane 1 on; empty: nobody knows.
  std::vector<std::array<LatLon, 2>> lanes{};
  Row row{};  ///< how each of them is driven
};
inline constexpr int kMostRows = 1000;
inline constexpr double kFarthestOut_m = 6.0;  ///< from farther off the next row is not seen
inline constexpr double kPastEnd_m = 1.0;

/// The order in which rows are driven, numbers from 1: 1 3 5 2 4 with one skipped.
std::vector<int> order_of(const RowBlock& block);

struct PlannedRows {
  std::vector<Item> items;
  /// How far beyond the rows' ends the vehicle's origin comes.
  double headland_m = 0.0;
};

/// Invalid names the member that is out of its range, or that this vehicle cannot drive
/// ("/spacing_m").
base::Result<PlannedRows> plan_rows(const RowBlock& block, const TurningVehicle& vehicle);

}  // namespace roverd::mission
