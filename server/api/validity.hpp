#pragma once
// How long a command is good for, and from when on that counts.
//
//   seen ──the sender's time──▶ sent ──the way──▶ begun … whole ──the robot's queue──▶ tick
//    └──────────────────────── valid_for_s ────────────────────────┘ later: refused as Late
//
// `seen` is the robot's own monotonic time at which the sender saw what they acted upon: every
// stream message, GET /vehicle and GET /health tell it as `mono_s`, the sender adds what has passed
// since. Without it the age counts from `begun`, the first sign of the request. A stop that the
// robot took after `seen` refuses the command too: it overtook it (robot/safety/last_stop.hpp).

#include <string_view>

#include "api/body.hpp"
#include "api/message.hpp"
#include "robot/robot.hpp"

namespace roverd::api {

inline constexpr double kClickValid_s = 1.0;
inline constexpr double kStickValid_s = 0.25;
inline constexpr double kLongestValid_s = 5.0;

/// The robot's monotonic seconds, to the millisecond that has begun.
double mono_s(base::Time now) noexcept;

/// Whether a command moves, arms or resumes. What stops or slows is never too late.
enum class Moves { Yes, No };

/// Takes `valid_for_s` out of the body (without it: kClickValid_s) and reads the header
/// Roverd-Seen; complains of what cannot be, like a time in the future.
/// @return what the robot judges it by: what stops is never too late, and no stop refuses it
robot::Validity validity_of(Members& members, const Call& call, Moves moves);

/// The same for a message of the stream. @param begun when its first byte was there
/// @param outer,inner what holds `seen_s`: the message itself, or what it says
struct StreamAge {
  base::Time begun;
  Members& outer;
  Members& inner;
};
robot::Validity stick_validity_of(const StreamAge& age);

/// What was asked for too late.
base::Error late_error(base::Time not_after, base::Time now);
/// @return true: it is too late, and the caller has heard so.
bool refused_as_late(const CallPtr& call, const robot::Validity& validity);

}  // namespace roverd::api
