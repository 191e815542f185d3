#pragma once
// One table for each protocol that moves a vehicle. Limits come from the driver's settings.

#include <vector>

#include "gate/table.hpp"

namespace roverd::gate {

/// Wire steps are 0.001 m/s and 0.001 rad/s; of V1, percent of the base's full speed.
struct BunkerLimits {
  int max_linear = 1500;
  int max_angular = 786;
  int max_linear_step = 250;
  int max_angular_step = 250;
  int max_linear_pct = 50;
  int max_angular_pct = 31;
  int max_linear_step_pct = 9;
  int max_angular_step_pct = 10;
  double motion_max_age_s = 0.3;  ///< of 0x221, 0x131
  double state_max_age_s = 0.7;   ///< of 0x211 and 0x151, which come every 100 to 200 ms
};

/// SI units; `turn` is the message's second value.
struct Limits {
  double max_speed = 0.0;
  double max_turn = 0.0;
  double max_speed_step = 0.0;
  double max_turn_step = 0.0;
  double feedback_max_age_s = 0.0;
};

/// AgileX over CAN, V2 and V1: a base speaks one of them, and nothing moves while both are heard.
std::vector<Table> bunker(const BunkerLimits& limits);
/// turn: wheel angle, rad. @param feedback_required false: once it was heard, it must go on.
std::vector<Table> ackermann(const Limits& limits, bool feedback_required);
/// turn: rad/s.
std::vector<Table> twist_text(const Limits& limits);
std::vector<Table> twist_binary(const Limits& limits);
/// turn: the ratio, whose limit is 2. This vehicle need not tell anything.
std::vector<Table> ratio(const Limits& limits);

}  // namespace roverd::gate
