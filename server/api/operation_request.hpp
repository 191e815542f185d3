#pragma once
// The body of POST /missions/{id}/operations as an operation: {op, …}. Pure.

#include <optional>
#include <string>
#include <variant>

#include "api/message.hpp"
#include "mission/edit/operations.hpp"

namespace roverd::api {

/// What "here", "current" and "last" mean at this moment.
struct OperationFacts {
  int items = 0;                        ///< of the mission
  std::optional<base::LatLon> vehicle;  ///< empty: not known, or too old
  std::optional<int> current;           ///< number of the item driven; empty: not of this mission
};

struct JoinWith {
  std::string mission_id;
};
struct SplitAfter {
  int item = 0;
  bool shared = false;
  std::optional<std::string> name;  ///< of the new mission
};
using OperationRequest = std::variant<mission::Operation, JoinWith, SplitAfter>;

/// Invalid with every wrong member; Conflict where the vehicle's position or a current item is
/// meant and there is none.
/// @param dry_run set if the body asks for the answer alone: nothing is to be kept
base::Result<OperationRequest> read_operation(const Json& body, const OperationFacts& facts,
                                              bool& dry_run);

}  // namespace roverd::api
