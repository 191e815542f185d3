#pragma once
// Memory held back for cleaning up: where there is none, an exception frees what a request took,
// and some destructors need a little themselves. Without it the first of them would end the
// program.

namespace roverd {

/// Once, before there are other threads: large blocks are given back when they are freed, and from
/// then on the first allocation that fails gives the reserve back to all others, and fails all the
/// same.
void hold_memory_back();

/// Takes what was given away anew, if it can be had. Any thread; quick while nothing is missing.
void refill_memory_reserve() noexcept;

}  // namespace roverd
