#pragma once
// Where a scanner's stream may be cut, and the scanner's own time: when it sent its scans. Pure
// state.

#include "base/stream_time.hpp"

namespace roverd::sick {

base::StreamClock stream_clock();

}  // namespace roverd::sick
