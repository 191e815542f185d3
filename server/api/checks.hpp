#pragma once
// The check of a mission with the vehicle where it is now and the active fence. Web thread.

#include <optional>

#include "api/context.hpp"
#include "mission/checks.hpp"

namespace roverd::api {

mission::CheckReport check_now(const Context& context, const mission::Plan& plan);

/// @param severity empty: all of them
Json findings_json(const mission::CheckReport& report, std::optional<mission::Severity> severity);

/// Why a mission with errors is not loaded: each with its pointer.
base::Error refusal(const mission::CheckReport& report);

}  // namespace roverd::api
