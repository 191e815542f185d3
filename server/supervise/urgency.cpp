#include "supervise/urgency.hpp"

#include <cstdint>

#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace roverd {

namespace {

/// struct sched_attr as the kernel knows it since 3.14 (sched_setattr(2)); glibc 2.36 has none.
struct SchedAttr {
  std::uint32_t size = sizeof(SchedAttr);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;
  std::uint64_t deadline = 0;
  std::uint64_t period = 0;
};

/// What anybody may ask for: to be woken on time (the kernel may be 50 us late otherwise), and,
/// since Linux 6.12, a short slice: a thread that works for moments is then run before those that
/// work for long. Older kernels take the call and have no such slice.
void ask_for_short_slices() noexcept {
  (void)::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  SchedAttr wish;
  wish.flags = 1;  // SCHED_FLAG_RESET_ON_FORK
  wish.nice = ::getpriority(PRIO_PROCESS, 0);
  wish.runtime = 100'000;  // ns, the shortest there is
  (void)::syscall(SYS_sched_setattr, 0, &wish, 0U);
}

}  // namespace

bool make_urgent(Urgency urgency) noexcept {
  // Above ordinary threads, below the kernel's own interrupt threads (50).
  sched_param priority{};
  priority.sched_priority = urgency == Urgency::Control ? 20 : 15;
  // 0 is the calling thread alone. Its children (a recording's writer) begin as ordinary threads.
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority) == 0) return true;
  make_prompt();  // second best
  return false;
}

void make_prompt() noexcept {
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER | SCHED_RESET_ON_FORK, &ordinary);
  ::setpriority(PRIO_PROCESS, 0, -10);  // refused to most users as well
  ask_for_short_slices();
}

void make_patient() noexcept {
  ::setpriority(PRIO_PROCESS, 0, 5);
}

}  // namespace roverd
