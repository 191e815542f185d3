#include "supervise/urgency.hpp"

#include <sched.h>
#include <sys/resource.h>

namespace roverd {

bool make_urgent(Urgency urgency) noexcept {
  // Above ordinary threads, below the kernel's own interrupt threads (50).
  sched_param priority{};
  priority.sched_priority = urgency == Urgency::Control ? 20 : 15;
  // 0 is the calling thread alone. Its children (a recording's writer) begin as ordinary threads.
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority) == 0) return true;
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &ordinary);
  ::setpriority(PRIO_PROCESS, 0, -10);  // second best; refused to most users as well
  return false;
}

}  // namespace roverd
