#pragma once
// JSON as it goes out.

#include <string>

#include "api/message.hpp"

namespace roverd::api {

/// Numbers stand without an exponent (0.0000001, not 1e-07), which every reader understands; no
/// number of JSON is NaN or infinite: those are null. Bytes that are no UTF-8 (a name out of a
/// device) are replaced. Never throws for what a value holds. Pure.
std::string plain_json(const Json& value);

}  // namespace roverd::api
