#pragma once
// The check of a mission with the vehicle where it is now and the active fence. Web thread.

#include <functional>
#include <optional>

#include "api/context.hpp"
#include "mission/checks.hpp"

namespace roverd::api {

/// What speaks against a mission, with the robot where it stands: all that load and start would
/// refuse, in the words in which they do.
struct Verdict {
  mission::CheckReport report;
  std::shared_ptr<const robot::CompiledMission> compiled;  ///< null: it cannot be driven at all
  std::size_t lasting = 0;  ///< errors that driving the robot elsewhere does not cure
  base::Error refusal{};    ///< of a load; of no meaning without lasting errors
};
/// With what is known at this moment; what it gives may be called beside the web thread.
std::function<Verdict(robot::MissionCopy)> judge_now(const Context& context);

/// @param severity empty: all of them
Json findings_json(const mission::CheckReport& report, std::optional<mission::Severity> severity);
Json finding_json(const mission::Finding& finding);

}  // namespace roverd::api
