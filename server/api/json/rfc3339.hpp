#pragma once
// Times that clients write.

#include <optional>
#include <string_view>

#include "base/time.hpp"

namespace roverd::api {

/// "2026-03-01T12:00:00Z", with or without a fraction, with "Z" or an offset (+02:00). Years
/// 1970 .. 9999; what is later than 2200 counts as the end of that year (the clock's range). Empty
/// for anything else. A leap second counts as the next second. Pure.
std::optional<base::WallTime> from_rfc3339(std::string_view text) noexcept;

}  // namespace roverd::api
