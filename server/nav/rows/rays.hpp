#pragma once
// Rows seen by the rule of the Husky between berry rows: the mean of the outermost rays of the left
// less that of the right. Rays beyond rays_far_m do not count; where none of the outermost ones
// counts, the row is at its end. No memory, no certainty: for comparison, and for cameras that see
// little.

#include <optional>

#include "nav/rows/scan.hpp"
#include "nav/rows/view.hpp"

namespace roverd::nav::rows {

/// The line leads from the body's origin to the middle (or to gap_m beside the one side) where the
/// outermost rays end. Where a side that leads is not seen at all, it goes straight on. to_end_m: 0
/// where all of them are endless and were looked at, whether a row was met before or not.
RowView view_by_rays(const RowScan& scan, const RowOrder& order, const RowParams& params);

}  // namespace roverd::nav::rows
