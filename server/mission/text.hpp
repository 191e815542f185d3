#pragma once
// Small helpers on text for this room's readers and writers. Pure, nothing throws but bad_alloc.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace roverd::mission {

/// Number of Unicode characters; empty if the bytes are not UTF-8 (over-long forms, surrogates and
/// anything beyond U+10FFFF count as broken).
std::optional<std::size_t> utf8_length(std::string_view text) noexcept;

/// What is wrong with a name that people give, as in "must …"; empty: nothing.
std::string name_problem(std::string_view name);

/// The nearest acceptable name: broken bytes and control characters become blanks, the ends are
/// trimmed, at most kMaxNameLength characters; `fallback` if nothing remains.
std::string clean_name(std::string_view name, std::string_view fallback);

/// The name with an ending (" (2)"), shortened so that it stays a name.
std::string name_with_ending(std::string name, std::string_view ending);

/// For comparing without regard to case: small letters of Latin (with accents), Greek and Cyrillic;
/// everything else as it is. Broken UTF-8 stays as it is, too.
std::string folded(std::string_view text);

/// The shortest text that reads back as the same double: "58.3780201". Not finite: "null".
void append_number(std::string& out, double value);
std::string number_text(double value);

/// Like append_number but never with an exponent and with at least `decimals` digits after the
/// point. Not finite: "0" with its decimals.
std::string fixed_number(double value, int decimals);

/// Without a leading UTF-8 byte order mark.
std::string_view without_bom(std::string_view text) noexcept;

}  // namespace roverd::mission
