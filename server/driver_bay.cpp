#include "driver_bay.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <boost/asio/post.hpp>

namespace roverd {
namespace {

namespace asio = boost::asio;
using base::Result;

/// The fastest driver that repeats its command (Ackermann over UDP) does so at 100 Hz.
constexpr auto kTick = std::chrono::milliseconds(10);

}  // namespace

Result<std::unique_ptr<DriverBay>> DriverBay::make(const Settings& settings, const Options& options,
                                                   const OnMeasurement& on_measurement) {
  if (!options.replay.empty() && !std::filesystem::is_regular_file(options.replay)) {
    return base::fail(base::Code::NotFound, "no recording " + options.replay);
  }
  std::unique_ptr<DriverBay> bay(new DriverBay(settings, options));
  auto devices = make_devices({bay->io_, bay->settings_, bay->options_, on_measurement});
  if (!devices) return tl::unexpected(devices.error());
  bay->devices_ = std::move(*devices);
  for (const Device& device : bay->devices_) {
    if (!device.send) continue;
    if (bay->base_ != nullptr) {
      return base::fail(base::Code::Invalid, "drivers." + bay->base_->name + " and drivers." +
                                                 device.name +
                                                 " both want to move the vehicle: enable one");
    }
    bay->base_ = &device;
  }
  return bay;
}

DriverBay::~DriverBay() {
  stop();
}

void DriverBay::each(const std::function<void(const Device&, base::Time)>& act) const {
  const base::Time now = base::steady_now();
  for (const Device& device : devices_) {
    act(device, now);
  }
}

void DriverBay::start() {
  asio::post(io_, [this] {
    each([](const Device& device, base::Time now) { device.start(now); });
    tick_soon();
  });
  thread_ = std::thread([this] { io_.run(); });
}

void DriverBay::tick_soon() {
  // Absolute times, so that lateness does not add up; what is past is not made up for.
  due_ = std::max(due_ + kTick, std::chrono::steady_clock::now());
  timer_.expires_at(due_);
  timer_.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    each([](const Device& device, base::Time now) { device.tick(now); });
    tick_soon();
  });
}

void DriverBay::stop() {
  if (!thread_.joinable()) return;
  asio::post(io_, [this] {
    timer_.cancel();
    each([](const Device& device, base::Time now) { device.stop(now); });
    work_.reset();
    io_.stop();
  });
  thread_.join();
}

void DriverBay::send(const base::DriveCommand& command, base::Time now) noexcept {
  if (base_ != nullptr) base_->send(command, now);
}

Result<void> DriverBay::restart(const std::string& name) {
  for (const Device& device : devices_) {
    if (device.name != name) continue;
    asio::post(io_, [&device] { device.restart(base::steady_now()); });
    return {};
  }
  return base::fail(base::Code::NotFound, "no driver \"" + name + "\"");
}

std::vector<std::string> DriverBay::names() const {
  std::vector<std::string> names;
  names.reserve(devices_.size());
  for (const Device& device : devices_) names.push_back(device.name);
  return names;
}

}  // namespace roverd
