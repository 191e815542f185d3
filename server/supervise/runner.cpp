#include "supervise/runner.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <boost/asio/post.hpp>
#include <pthread.h>

#include "base/log.hpp"
#include "supervise/urgency.hpp"

namespace roverd {
namespace {

namespace asio = boost::asio;
using Phase = base::DriverPhase;

/// The fastest driver that repeats its command (Ackermann over UDP) does so at 100 Hz.
constexpr auto kTickOfMovers = std::chrono::milliseconds(10);
constexpr auto kTick = std::chrono::milliseconds(20);

}  // namespace

Runner::Runner(const DevicePlan& plan, OnMeasurement on_measurement, Past past)
    : plan_(plan), on_measurement_(std::move(on_measurement)), past_(std::move(past)) {
  last_.name = plan_.name;
}

std::shared_ptr<Runner> Runner::begin(const DevicePlan& plan, OnMeasurement on_measurement,
                                      Past past) {
  std::shared_ptr<Runner> runner(new Runner(plan, std::move(on_measurement), std::move(past)));
  runner->doing("being made");
  // The thread keeps its runner: one that hangs may outlive everybody else.
  runner->thread_ = std::thread([runner] { runner->run(); });
  return runner;
}

void Runner::doing(const char* what) noexcept {
  doing_.store(what, std::memory_order_relaxed);
  alive_at_.store(base::steady_now().time_since_epoch().count(), std::memory_order_release);
}

void Runner::run() noexcept {
  pthread_setname_np(pthread_self(), plan_.name.substr(0, 15).c_str());
  if (plan_.moves) make_urgent(Urgency::Drive);
  if (plan_.sees) make_prompt();
  try {
    live();
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (...) {
    fail("an unknown exception");
  }
  ready_ = false;
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
  }
  end_.notify_all();
}

void Runner::live() {
  const DeviceEars ears{
      .on_measurement = [this](const base::Measurement& m) { hear(m); },
      .on_recording =
          [this](base::Recording recording, const std::string& problem) {
            std::lock_guard lock(mutex_);
            recording_ = recording;
            recording_problem_ = problem;
          },
  };
  device_ = plan_.make(io_, ears);
  ready_.store(true, std::memory_order_release);
  doing("starting");
  device_.start(base::steady_now());
  tick_soon();
  io_.run();
}

/// Whatever it did, it is over. Its base is told to stand, if the driver still can.
void Runner::fail(const std::string& what) noexcept {
  const std::string when = doing_.load(std::memory_order_relaxed);
  const bool made = ready_.exchange(false);
  failed_ = true;  // what it says while it is stopped is not passed on
  try {
    base::log(base::Level::Error, "drivers", "a driver failed",
              {{"driver", plan_.name}, {"while", when}, {"what", what}});
    tell_failure("failed while " + when + ": " + what, base::steady_now());
    if (made) device_.stop(base::steady_now());
  } catch (...) {
    ready_ = false;  // it cannot even stop; that it failed has been told
  }
}

void Runner::tell_failure(const std::string& what, base::Time now) {
  base::DriverStatus status;
  {
    std::lock_guard lock(mutex_);
    status = last_;
  }
  status.stamp = now;
  status.phase = Phase::Failed;
  status.reason = what + "; restart the driver to try again";
  status.detail = nullptr;
  tell(std::move(status));
}

void Runner::tick_soon() {
  // Absolute times, so that lateness does not add up; what is past is not made up for.
  const auto period = plan_.moves ? kTickOfMovers : kTick;
  due_ = std::max(due_ + period, std::chrono::steady_clock::now());
  timer_.expires_at(due_);
  doing("listening");
  timer_.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    doing("ticking");
    device_.tick(base::steady_now());
    tick_soon();
  });
}

void Runner::hear(const base::Measurement& m) {
  if (failed_) return;
  if (const auto* status = std::get_if<base::DriverStatus>(&m)) return tell(*status);
  std::lock_guard lock(mutex_);
  if (!abandoned_) on_measurement_(m);
}

/// Adds what the driver does not know of itself.
void Runner::tell(base::DriverStatus status) {
  std::lock_guard lock(mutex_);
  if (abandoned_) return;
  if (status.phase == Phase::Faulty || status.phase == Phase::Failed) {
    if (status.phase != last_.phase || status.reason != last_.reason) {
      past_.last_error = status.reason;
      past_.last_error_at = status.stamp;
    }
  }
  status.restarts = past_.restarts;
  status.last_error = past_.last_error;
  status.last_error_at = past_.last_error_at;
  status.recording = recording_;
  status.recording_problem = recording_problem_;
  last_ = status;
  on_measurement_(status);
}

void Runner::send(const base::DriveCommand& command, base::Time now) const noexcept {
  if (!ready_.load(std::memory_order_acquire) || !device_.send) return;
  device_.send(command, now);
}

// What is posted runs only on the thread, which keeps the runner; what never runs goes with io_.
// Were it to keep the runner too, the two would keep each other for ever.
void Runner::ask(Errand errand, Done done) {
  asio::post(io_, [this, errand = std::move(errand), done = std::move(done)] {
    doing("carrying out a command");
    try {
      done(errand(device_, base::steady_now()));
    } catch (...) {
      done(base::fail(base::Code::Unavailable, "the driver failed over it"));
      throw;
    }
  });
}

void Runner::restart() {
  {
    std::lock_guard lock(mutex_);
    ++past_.restarts;
  }
  asio::post(io_, [this] {
    doing("restarting");
    device_.restart(base::steady_now());
  });
}

void Runner::look(base::Time now) {
  if (ended_) return;
  const base::Time alive{base::Duration{alive_at_.load(std::memory_order_acquire)}};
  const bool hangs = now - alive > kHung;
  if (hung_.exchange(hangs) == hangs || !hangs) return;  // back again: it will say so itself
  const char* const when = doing_.load(std::memory_order_relaxed);
  base::log(base::Level::Error, "drivers", "a driver hangs",
            {{"driver", plan_.name}, {"while", when}});
  tell_failure(std::string("hangs while ") + when + ": no sign of life for 3 s", now);
}

Runner::Past Runner::past() const {
  std::lock_guard lock(mutex_);
  return past_;
}

void Runner::stop() {
  asio::post(io_, [this] {
    doing("stopping");
    timer_.cancel();
    if (ready_) device_.stop(base::steady_now());
    work_.reset();
    io_.stop();
  });
}

bool Runner::wait_until(base::Time deadline) {
  {
    std::unique_lock lock(mutex_);
    const auto left = deadline - base::steady_now();
    end_.wait_for(lock, std::max(left, base::Duration::zero()), [this] { return ended_.load(); });
  }
  if (!ended_) return false;
  if (thread_.joinable()) thread_.join();
  return true;
}

void Runner::abandon() noexcept {
  {
    std::lock_guard lock(mutex_);
    abandoned_ = true;
  }
  ready_ = false;
  if (!thread_.joinable()) return;
  if (ended_) {
    thread_.join();
  } else {
    thread_.detach();
    io_.stop();
  }
}

}  // namespace roverd
