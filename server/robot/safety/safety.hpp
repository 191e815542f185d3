#pragma once
// What is wrong now, and what follows from it. Pure: facts in, conditions out; worst one wins.
//
// The table of the failsafes: safety/failsafes.hpp; for people, docs/safety.md.
//
// Hold stops, goes to mode HOLD and stays there until an operator goes on. Only the radio's
// take-over ends by itself. What is wrong with the position is listed in every mode, and followed
// by something only while the robot drives by itself.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/snapshot.hpp"
#include "robot/config.hpp"
#include "robot/safety/facts.hpp"
#include "robot/safety/failsafes.hpp"
#include "robot/world.hpp"

namespace roverd::robot {

struct Assessment {
  Response response = Response::None;
  bool slow = false;  ///< it must creep: asked for, or the response is Hold or more
  std::string cause;  ///< of the worst response
  std::vector<base::SafetyCondition> conditions;
  bool base_estop = false;
  std::string disarms;  ///< why nothing may stay armed; empty: it may
};

/// Does the radio drive? The base says so, or the switch SWB stands elsewhere than up.
bool radio_drives(const World& world, const SafetyParams& p, Time now) noexcept;
/// Its frames come, and count.
bool radio_heard(const World& world, const SafetyParams& p, Time now) noexcept;
/// The base takes our commands.
bool base_listens(const World& world) noexcept;
bool base_lost(const World& world, const SafetyParams& p, Time now) noexcept;
/// Empty: the radio is all right. Otherwise why not.
std::string radio_trouble(const World& world, const SafetyParams& p, Time now);

/// @param rows the whole table, but in tests
Assessment assess(const Facts& facts, const SafetyParams& p, Time now,
                  std::span<const Failsafe> rows = failsafes());

/// The checks before arming, always all of them.
std::vector<base::Check> arming_checks(const Facts& facts, const SafetyParams& safety,
                                       const ArmingParams& p, bool mission_loaded, Time now);

}  // namespace roverd::robot
