#pragma once
// Which threads the kernel runs first. The two that move the robot come before all others: a busy
// page, disk or bus must not cost a command.

namespace roverd {

/// Control before Drive: a flood on the drive link never costs a tick of the loop.
enum class Urgency { Control, Drive };

/// Of the calling thread, until it ends; threads that it starts are ordinary ones.
/// @return whether the kernel granted real-time priority. Ordinary users are refused it unless the
/// system allows it (rtprio in limits.conf, LimitRTPRIO= of a service); a better place among the
/// ordinary threads is then asked for.
bool make_urgent(Urgency urgency) noexcept;

/// For threads that see: of the ordinary ones the calling thread is run first, as far as its rights
/// go, and never keeps others from running, however much it has to look at. Threads that it starts
/// are ordinary ones.
void make_prompt() noexcept;

/// For threads whose work may wait: the calling thread gives way to all others.
void make_patient() noexcept;

}  // namespace roverd
