#pragma once
// Where a receiver's stream may be cut, and the receiver's own time: the time of day of NMEA
// sentences, the time of week (iTOW) of UBX navigation messages. Cut by the driver's own framer, so
// that what is a message to one is one to the other. Pure state.

#include "base/stream_time.hpp"

namespace roverd::gnss {

base::StreamClock stream_clock();

}  // namespace roverd::gnss
