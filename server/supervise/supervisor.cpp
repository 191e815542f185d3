#include "supervise/supervisor.hpp"

#include <algorithm>
#include <utility>

namespace roverd {

using base::Result;

Supervisor::Supervisor(std::vector<DevicePlan> plans, OnMeasurement on_measurement)
    : on_measurement_(std::move(on_measurement)) {
  slots_.reserve(plans.size());
  for (DevicePlan& plan : plans) slots_.push_back({std::move(plan)});
}

Result<std::unique_ptr<Supervisor>> Supervisor::make(std::vector<DevicePlan> plans,
                                                     OnMeasurement on_measurement) {
  std::unique_ptr<Supervisor> supervisor(
      new Supervisor(std::move(plans), std::move(on_measurement)));
  for (const Slot& slot : supervisor->slots_) {
    if (!slot.plan.moves) continue;
    if (supervisor->base_ != nullptr) {
      return base::fail(base::Code::Invalid, "drivers." + supervisor->base_->plan.name +
                                                 " and drivers." + slot.plan.name +
                                                 " both want to move the vehicle: enable one");
    }
    supervisor->base_ = &slot;
  }
  return supervisor;
}

namespace {

base::DriverStatus starting(const std::string& name) {
  base::DriverStatus status;
  status.stamp = base::steady_now();
  status.name = name;
  status.reason = "starting";
  return status;
}

}  // namespace

Supervisor::~Supervisor() {
  stop();
}

void Supervisor::start() {
  {
    std::lock_guard lock(mutex_);
    // All are known, in the order of the configuration, before the first of them says a word.
    for (const Slot& slot : slots_) on_measurement_(starting(slot.plan.name));
    for (Slot& slot : slots_) slot.runner = Runner::begin(slot.plan, on_measurement_, {});
  }
  watch_ = std::thread([this] { look_after(); });
}

void Supervisor::look_after() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kLook, [this] { return stopping_; })) {
    std::vector<std::shared_ptr<Runner>> runners;
    for (const Slot& slot : slots_) runners.push_back(slot.runner);
    lock.unlock();
    for (const auto& runner : runners) runner->look(base::steady_now());
    runners.clear();
    lock.lock();
  }
}

void Supervisor::stop() {
  if (!watch_.joinable()) return;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  watch_.join();
  for (const Slot& slot : slots_) slot.runner->stop();
  const base::Time deadline = base::steady_now() + kGoodbye;
  for (const Slot& slot : slots_) {
    slot.runner->wait_until(deadline);
    slot.runner->abandon();
  }
}

void Supervisor::send(const base::DriveCommand& command, base::Time now) noexcept {
  std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || base_ == nullptr || !base_->runner) return;
  base_->runner->send(command, now);
}

Result<void> Supervisor::restart(const std::string& name) {
  std::shared_ptr<Runner> old;  // destroyed without the lock: closing links may take a while
  {
    std::lock_guard lock(mutex_);
    const auto slot = std::find_if(slots_.begin(), slots_.end(),
                                   [&name](const Slot& s) { return s.plan.name == name; });
    if (slot == slots_.end()) return base::fail(base::Code::NotFound, "no driver \"" + name + "\"");
    if (!slot->runner || stopping_) {
      return base::fail(base::Code::Unavailable, "the drivers are not running");
    }
    if (slot->runner->works()) {
      slot->runner->restart();
      return {};
    }
    old = slot->runner;
    old->abandon();
    Runner::Past past = old->past();
    ++past.restarts;
    slot->runner = Runner::begin(slot->plan, on_measurement_, std::move(past));
  }
  return {};
}

void Supervisor::ask(bool DevicePlan::*able, const char* what, Runner::Errand errand,
                     base::Time not_after, Done done) {
  std::shared_ptr<Runner> runner;
  {
    std::lock_guard lock(mutex_);
    for (const Slot& slot : slots_) {
      if (slot.plan.*able) runner = slot.runner;
    }
  }
  if (!runner) {
    return done(base::fail(base::Code::Conflict, std::string("this vehicle has no ") + what));
  }
  if (!runner->works()) {
    return done(base::fail(base::Code::Conflict, "the vehicle's driver is not running"));
  }
  runner->ask(
      [errand = std::move(errand), not_after](const Device& device, base::Time now) {
        if (now <= not_after) return errand(device, now);
        return Result<void>(
            base::fail(base::Code::Late, "the command arrived too late and was not carried out"));
      },
      std::move(done));
}

namespace {

Result<void> sent_or_why(bool sent) {
  if (sent) return {};
  return base::fail(base::Code::Conflict,
                    "it could not be sent: the vehicle is not heard, or its bus is busy");
}

}  // namespace

void Supervisor::set_lights(const base::LightState& lights, base::Time not_after, Done done) {
  ask(
      &DevicePlan::lights, "lights that can be set",
      [lights](const Device& device, base::Time now) {
        return sent_or_why(device.set_lights(lights, now));
      },
      not_after, std::move(done));
}

void Supervisor::clear_errors(int motor, base::Time not_after, Done done) {
  ask(
      &DevicePlan::clears_errors, "errors that can be cleared",
      [motor](const Device& device, base::Time now) {
        return sent_or_why(device.clear_errors(motor, now));
      },
      not_after, std::move(done));
}

bool Supervisor::has_lights() const noexcept {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& s) { return s.plan.lights; });
}

bool Supervisor::clears_errors() const noexcept {
  return std::any_of(slots_.begin(), slots_.end(),
                     [](const Slot& s) { return s.plan.clears_errors; });
}

std::vector<std::string> Supervisor::names() const {
  std::vector<std::string> names;
  names.reserve(slots_.size());
  for (const Slot& slot : slots_) names.push_back(slot.plan.name);
  return names;
}

}  // namespace roverd
