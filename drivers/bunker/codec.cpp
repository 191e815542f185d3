#include "bunker/codec.hpp"

namespace roverd::bunker {

// The codec is checked before any test runs: what cannot be computed at compile time is not pure.
static_assert(encode(limited({.linear_mps = 0.15, .angular_radps = 0.0}, 1.5, 0.7853)).data[1] ==
              0x96);
static_assert(decode(encode(Odometer{-1, 1})).verdict == Verdict::Decoded);

}  // namespace roverd::bunker
