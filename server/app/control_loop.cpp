#include "app/control_loop.hpp"

#include <ctime>
#include <utility>

#include <pthread.h>

#include "supervise/urgency.hpp"

namespace roverd {
namespace {

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
  real_time_ = make_urgent(Urgency::Control);
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
