#pragma once
// Words that many rows of the table of failsafes share: how it ends, who may override.

#include <string_view>

namespace roverd::robot {

inline constexpr std::string_view kGoneAndGoOn = "the cause is gone, then an operator's word";
inline constexpr std::string_view kEndsByItself = "by itself";
inline constexpr std::string_view kReset = "an operator resets it; then disarmed";

inline constexpr std::string_view kNeedsNone = "(nothing to override)";
inline constexpr std::string_view kNobody = "nobody: the base itself stands";
inline constexpr std::string_view kRadio = "the radio's sticks";
inline constexpr std::string_view kHands = "by hand, the radio's sticks";

}  // namespace roverd::robot
