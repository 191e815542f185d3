#pragma once
// Where the stream of an MTi may be cut, and the unit's own time: its sample time, where it does
// not tell that the UTC time of its samples. Pure state.

#include "base/stream_time.hpp"

namespace roverd::mti {

base::StreamClock stream_clock();

}  // namespace roverd::mti
