#include "app/control_loop.hpp"

#include <ctime>
#include <utility>

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

namespace roverd {
namespace {

/// @return whether the calling thread now runs before every ordinary one.
bool ask_for_real_time() noexcept {
  sched_param priority{};
  priority.sched_priority = 20;  // above ordinary threads, below the kernel's own interrupt threads
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0) return true;
  (void)setpriority(PRIO_PROCESS, 0, -10);  // second best; refused to ordinary users as well
  return false;
}

void sleep_until(base::Time t) noexcept {
  const auto since = t.time_since_epoch();
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since);
  const timespec at{whole.count(), (since - whole).count()};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
  }
}

}  // namespace

ControlLoop::ControlLoop(Tick tick) : tick_(std::move(tick)), thread_([this] { run(); }) {}

ControlLoop::~ControlLoop() {
  stop_ = true;
  thread_.join();
}

void ControlLoop::run() noexcept {
  pthread_setname_np(pthread_self(), "control");
  real_time_ = ask_for_real_time();
  base::Time next = base::steady_now();
  while (!stop_) {
    sleep_until(next);
    const base::Time now = base::steady_now();
    tick_(now, base::wall_now(), now - next);
    next += kPeriod;
    const base::Time after = base::steady_now();
    if (after > next) next += ((after - next) / kPeriod + 1) * kPeriod;  // skip what was missed
  }
}

}  // namespace roverd
