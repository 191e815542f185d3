#pragma once
// The short way for plans that are as they should be.

#include <optional>
#include <string_view>

#include "mission/plan.hpp"

namespace roverd::mission {

/// The plan in a JSON text, without a tree of values in between: ten times as fast as parse_json
/// and plan_from_json. Empty for everything out of the ordinary (mistakes, but also escapes and
/// nested values where there need be none): the long way then says what is wrong, or reads it.
/// Never another plan than the long way's. Pure, any thread.
std::optional<Plan> quick_plan(std::string_view text);

}  // namespace roverd::mission
