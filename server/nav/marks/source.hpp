#pragma once
// Who tells of walls and landmarks, and by whose word a way is laid.

#include <optional>
#include <string_view>

namespace roverd::nav::marks {

enum class Source { Scan, Vision };
std::string_view to_string(Source s) noexcept;  // scan vision

/// Auto: by all that is seen, whoever sees it. Else what the other kind of sensor says of walls and
/// landmarks is left out, as if it were not there.
enum class By { Auto, Scan, Vision };
std::string_view to_string(By by) noexcept;  // auto scan vision
/// Empty: no such word.
std::optional<By> by_from(std::string_view word) noexcept;

}  // namespace roverd::nav::marks
