#pragma once
// A block of rows as a mission: from row to row by row, move and turn items. Nothing of it needs a
// position but the way to its entry.
//
//      ┌──▶ ░░░░░░░░░░░░░░░░░░ ──╮ out_m
//   entry   row 1                │ spacing_m · (skip + 1), turns on the spot
//      ╭─── ░░░░░░░░░░░░░░░░░░ ◀─╯        every other row is driven the other way
//      ▼    row 2 …
//
// Pure.

#include <optional>
#include <vector>

#include "base/result.hpp"
#include "mission/plan.hpp"

namespace roverd::mission {

struct RowBlock {
  int rows = 1;             ///< lanes to drive, 1 .. kMostRows
  double spacing_m = 2.5;   ///< from the middle of one to that of the next, 0.3 .. 50
  Side turn = Side::Right;  ///< where row 2 lies, seen along row 1
  int skip = 0;             ///< so many rows are left out and driven on later passes, 0 .. 20
  double out_m = 1.5;       ///< out of a row before it turns, 0.1 .. kFarthestOut_m
  /// Where row 1 begins; empty: where the robot stands when it starts, pointing along it.
  std::optional<LatLon> entry{};
  std::optional<double> heading_deg{};  ///< along row 1; needed with an entry
  Row row{};                            ///< how each of them is driven
};
inline constexpr int kMostRows = 1000;
inline constexpr double kFarthestOut_m = 6.0;  ///< from farther off the next row is not seen

/// The order in which rows are driven, numbers from 1: 1 3 5 2 4 with one skipped.
std::vector<int> order_of(const RowBlock& block);

/// Invalid names the member that is out of its range ("/spacing_m").
base::Result<std::vector<Item>> plan_rows(const RowBlock& block);

}  // namespace roverd::mission
