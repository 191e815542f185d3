#pragma once
// What the vehicle is and may do, as it is now: parameters change while the program runs.

#include "api/json/words.hpp"
#include "robot/config.hpp"

namespace roverd::api {

/// Puts in what the parameters say: size, kinematics, limits, what the radio's levers mean.
void take_parameters(Profile& profile, const robot::Config& config);

}  // namespace roverd::api
