#pragma once
// The check of a mission with the vehicle where it is now and the active fence. Web thread.

#include <functional>
#include <optional>

#include "api/context.hpp"
#include "mission/checks.hpp"

namespace roverd::api {

/// With what is known at this moment; what it gives may be called beside the web thread.
std::function<mission::CheckReport(const mission::Plan&)> checker(const Context& context);

/// @param severity empty: all of them
Json findings_json(const mission::CheckReport& report, std::optional<mission::Severity> severity);

/// Why a mission with errors is not loaded: each with its pointer.
base::Error refusal(const mission::CheckReport& report);

}  // namespace roverd::api
