#pragma once
// What of this computer the server and the drivers take for themselves, so that no sensor takes it,
// too.

#include <vector>

#include "config/sensors.hpp"
#include "config/settings.hpp"

namespace roverd {

/// The server's port and the links of the enabled drivers.
std::vector<Ear> ears_of(Settings settings);

}  // namespace roverd
