#pragma once
// The vehicles that are shipped: the profile of config/vehicles drives the plant of config/sim over
// the real driver and its bytes, in simulated time.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ackermann/driver.hpp"
#include "bumper/driver.hpp"
#include "config/settings.hpp"
#include "ratio/driver.hpp"
#include "rig.hpp"
#include "sim/cart.hpp"
#include "sim/config.hpp"
#include "source_folder.hpp"
#include "twist/driver.hpp"

namespace roverd::loop {

/// The settings of roverd with --vehicle NAME.
inline Settings settings_of(const std::string& vehicle) {
  auto settings = load_settings(
      {.config = tests::in_source("config/robot.toml"), .vehicle = vehicle, .overrides = {}});
  if (settings) return *settings;
  ADD_FAILURE() << settings.error().detail;
  return {};
}

inline sim::Params plant_of(const std::string& vehicle) {
  sim::Config config;
  const auto read =
      sim::read_config_file(config, tests::in_source("config/sim/" + vehicle + ".toml"));
  if (!read) ADD_FAILURE() << read.error().detail;
  return config.params;
}

struct CartOptions {
  std::string vehicle;
  std::uint64_t seed = 1;
  double heading_deg = 0.0;
  std::function<void(sim::Params&)> change_plant{};
  std::function<void(Settings&)> change_settings{};
};

class CartRig final : public RigBase {
 public:
  explicit CartRig(const CartOptions& o) : CartRig(o, settings(o), plant_params(o)) {}

  /// The driver that moves the vehicle.
  base::DriverStatus driver_status() const { return status_(at_); }

 private:
  static Settings settings(const CartOptions& o) {
    Settings s = settings_of(o.vehicle);
    if (o.change_settings) o.change_settings(s);
    return s;
  }
  static sim::Params plant_params(const CartOptions& o) {
    sim::Params p = plant_of(o.vehicle);
    if (o.change_plant) o.change_plant(p);
    return p;
  }

  CartRig(const CartOptions& o, const Settings& s, const sim::Params& p)
      : RigBase(std::make_unique<sim::Cart>(p, o.seed, start_of(o.heading_deg)), s.robot),
        cart_(static_cast<sim::Cart&>(plant)),
        drive_(wire()),
        bumper_(wire()) {
    drive_.b->on_bytes = [this](base::Bytes b, Time) { cart_.receive(b); };
    cart_.on_drive = [this](base::Bytes b, Time t) {
      at_ = t;
      drive_.b->write(b);
    };
    cart_.on_bumper = [this](base::Bytes b, Time t) {
      at_ = t;
      bumper_.b->write(b);
    };
    add<ackermann::Driver>("ackermann", s.ackermann, drive_);
    add<ratio::Driver>("ratio", s.ratio, drive_);
    add<twist::Driver>("twist", s.twist, drive_);
    add<bumper::Driver>("bumper", s.bumper, bumper_);
  }

  link::MemoryBytePair wire() {
    auto pair = link::memory_byte_pair();
    pair.a->set_immediate([this] { return at_; });
    pair.b->set_immediate([this] { return at_; });
    EXPECT_TRUE(pair.b->open());
    return pair;
  }

  template <class Driver, class Wired>
  void add(const std::string& name, const Wired& wired, link::MemoryBytePair& pair) {
    if (!wired.wiring.enabled) return;
    auto driver = std::make_shared<Driver>(
        name, wired.params,
        [&pair] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(pair.a)); },
        [this](const base::Measurement& m) { robot.measurements().put(m); });
    driver->start(at_);
    ticks_.push_back([driver](Time t) { driver->tick(t); });
    if constexpr (requires(base::DriveCommand c, Time t) { driver->send(c, t); }) {
      robot.send = [driver](const base::DriveCommand& c, Time t) { driver->send(c, t); };
      status_ = [driver](Time t) { return driver->status(t); };
    }
  }

  /// The device thread ticks twice as often as the robot.
  void run_devices(Time now) override {
    for (const Time t : {now - kTick / 2, now}) {
      plant.advance_to(t);
      at_ = t;
      for (const auto& tick : ticks_) tick(t);
      gnss_.tick(t);
      if (mti_) mti_->tick(t);
    }
  }

  sim::Cart& cart_;
  link::MemoryBytePair drive_;
  link::MemoryBytePair bumper_;
  std::vector<std::function<void(Time)>> ticks_;
  std::function<base::DriverStatus(Time)> status_;
};

}  // namespace roverd::loop
