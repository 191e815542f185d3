#pragma once
// Request bodies and parameters: strict reading, every offending field named.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/message.hpp"
#include "mission/json/object.hpp"

namespace roverd::api {

/// The JSON of a body. Unsupported: the Content-Type is not application/json (a foreign page's
/// simple form cannot send that); Malformed: not JSON. @param optional an empty body is {}.
base::Result<Json> json_body(const Request& request, bool optional = false);

/// Unsupported unless the body is sent as application/json.
base::Result<void> check_json_type(const Request& request);

using mission::Members;

/// ?limit=, 1..1000, default 100. Invalid otherwise.
base::Result<int> limit_of(const Call& call);
/// Empty if it is not there.
std::string query_text(const Call& call, std::string_view name);
/// A decimal number without sign; empty if it is anything else or does not fit.
std::optional<std::int64_t> whole_number(std::string_view text) noexcept;

}  // namespace roverd::api
