#pragma once
// Where the point of a tool, or the axle of a trailer, truly went, from where the vehicle went: the
// study's judge of nav.tool, with kinematics of its own (a shared mistake would cancel).
//
// A tool is bolted on. A trailer's wheels do not slip sideways, and its coupling draws it:
// dφ = (way of the coupling across the trailer)/L. It begins straight behind.

#include <span>
#include <vector>

#include "nav/measure/measure.hpp"
#include "nav/track/params.hpp"

namespace roverd::study {

/// As many points as were driven. Yaw: of the tool's vehicle, or of the trailer.
std::vector<nav::DrivenPoint> tool_track(std::span<const nav::DrivenPoint> vehicle,
                                         const nav::ToolParams& tool);

}  // namespace roverd::study
