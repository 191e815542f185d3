#pragma once
// Does every failsafe still speak when it must? At the start, before anybody may arm.

#include <span>
#include <string>

#include "robot/safety/failsafes.hpp"

namespace roverd::robot {

/// Tries every row of the table on made-up facts: silent where all is well, speaking on what it is
/// there for, and followed by no less than its response. Takes well under a millisecond.
/// @return empty: all do; else which does not.
std::string test_failsafes(std::span<const Failsafe> rows = failsafes());

}  // namespace roverd::robot
