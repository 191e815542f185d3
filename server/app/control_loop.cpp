#include "app/control_loop.hpp"

#include <cerrno>
#include <ctime>
#include <utility>

#include <pthread.h>

#include "supervise/urgency.hpp"

namespace roverd {

ControlLoop::ControlLoop(Tick tick, Heed heed) : tick_(std::move(tick)), heed_(std::move(heed)) {
  sem_init(&alerts_, 0, 0);
  thread_ = std::thread([this] { run(); });
}

ControlLoop::~ControlLoop() {
  stop_ = true;
  thread_.join();
  sem_destroy(&alerts_);
}

void ControlLoop::alert() noexcept {
  if (!alerted_.exchange(true)) sem_post(&alerts_);
}

/// @return false: something is to be heeded first.
bool ControlLoop::sleep_until(base::Time t) noexcept {
  const auto since = t.time_since_epoch();
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since);
  const timespec at{whole.count(), (since - whole).count()};
  while (sem_clockwait(&alerts_, CLOCK_MONOTONIC, &at) != 0) {
    if (errno != EINTR) return true;  // it is time
  }
  alerted_ = false;
  return false;
}

void ControlLoop::run() noexcept {
  pthread_setname_np(pthread_self(), "control");
  real_time_ = make_urgent(Urgency::Control);
  base::Time next = base::steady_now();
  while (!stop_) {
    while (!sleep_until(next)) heed_(base::steady_now());
    const base::Time now = base::steady_now();
    tick_(now, base::wall_now(), now - next);
    next += kPeriod;
    const base::Time after = base::steady_now();
    if (after > next) next += ((after - next) / kPeriod + 1) * kPeriod;  // skip what was missed
  }
}

}  // namespace roverd
