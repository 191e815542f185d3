#include "driver_bay.hpp"

#include <algorithm>
#include <utility>

namespace roverd {

using base::Result;

DriverBay::DriverBay(std::vector<DevicePlan> plans, OnMeasurement on_measurement)
    : on_measurement_(std::move(on_measurement)) {
  slots_.reserve(plans.size());
  for (DevicePlan& plan : plans) slots_.push_back({std::move(plan)});
}

Result<std::unique_ptr<DriverBay>> DriverBay::make(std::vector<DevicePlan> plans,
                                                   OnMeasurement on_measurement) {
  std::unique_ptr<DriverBay> bay(new DriverBay(std::move(plans), std::move(on_measurement)));
  for (const Slot& slot : bay->slots_) {
    if (!slot.plan.moves) continue;
    if (bay->base_ != nullptr) {
      return base::fail(base::Code::Invalid, "drivers." + bay->base_->plan.name + " and drivers." +
                                                 slot.plan.name +
                                                 " both want to move the vehicle: enable one");
    }
    bay->base_ = &slot;
  }
  return bay;
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

DriverBay::~DriverBay() {
  stop();
}

void DriverBay::start() {
  {
    std::lock_guard lock(mutex_);
    // All are known, in the order of the configuration, before the first of them says a word.
    for (const Slot& slot : slots_) on_measurement_(starting(slot.plan.name));
    for (Slot& slot : slots_) slot.berth = Berth::begin(slot.plan, on_measurement_, {});
  }
  watch_ = std::thread([this] { look_after(); });
}

void DriverBay::look_after() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kLook, [this] { return stopping_; })) {
    std::vector<std::shared_ptr<Berth>> berths;
    for (const Slot& slot : slots_) berths.push_back(slot.berth);
    lock.unlock();
    for (const auto& berth : berths) berth->look(base::steady_now());
    berths.clear();
    lock.lock();
  }
}

void DriverBay::stop() {
  if (!watch_.joinable()) return;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  watch_.join();
  for (const Slot& slot : slots_) slot.berth->stop();
  const base::Time deadline = base::steady_now() + kGoodbye;
  for (const Slot& slot : slots_) {
    slot.berth->wait_until(deadline);
    slot.berth->abandon();
  }
}

void DriverBay::send(const base::DriveCommand& command, base::Time now) noexcept {
  std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || base_ == nullptr || !base_->berth) return;
  base_->berth->send(command, now);
}

Result<void> DriverBay::restart(const std::string& name) {
  std::shared_ptr<Berth> old;  // destroyed without the lock: closing links may take a while
  {
    std::lock_guard lock(mutex_);
    const auto slot = std::find_if(slots_.begin(), slots_.end(),
                                   [&name](const Slot& s) { return s.plan.name == name; });
    if (slot == slots_.end()) return base::fail(base::Code::NotFound, "no driver \"" + name + "\"");
    if (!slot->berth || stopping_) {
      return base::fail(base::Code::Unavailable, "the drivers are not running");
    }
    if (slot->berth->works()) {
      slot->berth->restart();
      return {};
    }
    old = slot->berth;
    old->abandon();
    Berth::Past past = old->past();
    ++past.restarts;
    slot->berth = Berth::begin(slot->plan, on_measurement_, std::move(past));
  }
  return {};
}

void DriverBay::ask(bool DevicePlan::*able, const char* what, Berth::Errand errand,
                    base::Time not_after, Done done) {
  std::shared_ptr<Berth> berth;
  {
    std::lock_guard lock(mutex_);
    for (const Slot& slot : slots_) {
      if (slot.plan.*able) berth = slot.berth;
    }
  }
  if (!berth) {
    return done(base::fail(base::Code::Conflict, std::string("this vehicle has no ") + what));
  }
  if (!berth->works()) {
    return done(base::fail(base::Code::Conflict, "the vehicle's driver is not running"));
  }
  berth->ask(
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

void DriverBay::set_lights(const base::LightState& lights, base::Time not_after, Done done) {
  ask(
      &DevicePlan::lights, "lights that can be set",
      [lights](const Device& device, base::Time now) {
        return sent_or_why(device.set_lights(lights, now));
      },
      not_after, std::move(done));
}

void DriverBay::clear_errors(int motor, base::Time not_after, Done done) {
  ask(
      &DevicePlan::clears_errors, "errors that can be cleared",
      [motor](const Device& device, base::Time now) {
        return sent_or_why(device.clear_errors(motor, now));
      },
      not_after, std::move(done));
}

bool DriverBay::has_lights() const noexcept {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& s) { return s.plan.lights; });
}

bool DriverBay::clears_errors() const noexcept {
  return std::any_of(slots_.begin(), slots_.end(),
                     [](const Slot& s) { return s.plan.clears_errors; });
}

std::vector<std::string> DriverBay::names() const {
  std::vector<std::string> names;
  names.reserve(slots_.size());
  for (const Slot& slot : slots_) names.push_back(slot.plan.name);
  return names;
}

}  // namespace roverd
