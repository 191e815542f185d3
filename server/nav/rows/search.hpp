#pragma once
// The first sight of a row: its direction and its sides, where nothing is known of it but that the
// robot stands in it or before its begin, and points along it roughly.

#include <optional>
#include <vector>

#include "nav/rows/fit.hpp"

namespace roverd::nav::rows {

/// The line that most pieces of plants stand along, with the way between them free. Of one side
/// the line is gap_m beside it, and width_m is twice that. @param body X_OB.
std::optional<Line> search_line(const std::vector<Mark>& marks, const Pose2& body,
                                const RowOrder& order, const RowParams& params);

}  // namespace roverd::nav::rows
