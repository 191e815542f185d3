#pragma once
// The unit counts its samples in steps of 100 us.

#include "base/sample_clock.hpp"

namespace roverd::mti {

using base::Time;
using SampleClock = base::SampleClock<100>;

}  // namespace roverd::mti
