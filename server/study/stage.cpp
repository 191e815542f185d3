#include "study/stage.hpp"

#include <chrono>
#include <utility>

#include "ackermann/driver.hpp"
#include "bumper/driver.hpp"
#include "bunker/driver.hpp"
#include "mti/driver.hpp"
#include "ratio/driver.hpp"
#include "twist/driver.hpp"

namespace roverd::study {
namespace {

std::unique_ptr<sim::Vehicle> make_plant(const sim::Params& p, std::uint64_t seed,
                                         const sim::Start& start) {
  if (p.device.wire == "can") return std::make_unique<sim::Bunker>(p, seed, start);
  return std::make_unique<sim::Cart>(p, seed, start);
}

}  // namespace

Stage::Stage(const Settings& settings, const sim::Params& plant, std::uint64_t seed,
             const sim::Start& start)
    : plant_(make_plant(plant, seed, start)),
      wall_(start.wall),
      robot_(settings.robot),
      can_(link::memory_frame_pair()),
      drive_(link::memory_byte_pair()),
      bumper_(link::memory_byte_pair()),
      gnss_bytes_(link::memory_byte_pair()),
      imu_bytes_(link::memory_byte_pair()) {
  if (auto* bunker = dynamic_cast<sim::Bunker*>(plant_.get())) {
    wire_bunker(settings, *bunker);
  } else {
    wire_cart(settings, static_cast<sim::Cart&>(*plant_));
  }
  wire_sensors(settings);
}

void Stage::join(link::MemoryBytePair& pair) {
  pair.a->set_immediate([this] { return at_; });
  pair.b->set_immediate([this] { return at_; });
  (void)pair.b->open();
}

template <class Driver, class Wired>
void Stage::add(const std::string& name, const Wired& wired, link::MemoryBytePair& pair) {
  if (!wired.wiring.enabled) return;
  auto driver = std::make_shared<Driver>(
      name, wired.params,
      [&pair] { return base::Result<std::unique_ptr<link::ByteLink>>(std::move(pair.a)); },
      [this](const base::Measurement& m) { robot_.measurements().put(m); });
  driver->start(at_);
  ticks_.push_back([driver](base::Time t) { driver->tick(t); });
  if constexpr (requires(base::DriveCommand c, base::Time t) { driver->send(c, t); }) {
    robot_.send = [driver](const base::DriveCommand& c, base::Time t) { driver->send(c, t); };
  }
}

void Stage::wire_sensors(const Settings& s) {
  join(gnss_bytes_);
  join(imu_bytes_);
  plant_->on_gnss = [this](base::Bytes b, base::Time t) {
    at_ = t;
    gnss_bytes_.b->write(b);
  };
  plant_->on_imu = [this](base::Bytes b, base::Time t) {
    at_ = t;
    imu_bytes_.b->write(b);
  };
  imu_bytes_.b->on_bytes = [this](base::Bytes b, base::Time) { plant_->receive_imu(b); };
  add<gnss::Driver>("gnss", s.gnss, gnss_bytes_);
  add<mti::Driver>("mti", s.mti, imu_bytes_);
}

void Stage::wire_bunker(const Settings& s, sim::Bunker& plant) {
  can_.a->set_immediate([this] { return at_; });
  can_.b->set_immediate([this] { return at_; });
  can_.b->on_frame = [&plant](const base::CanFrame& f, base::Time) { plant.receive(f); };
  (void)can_.b->open();
  plant.on_frame = [this](const base::CanFrame& f, base::Time t) {
    at_ = t;
    can_.b->send(f);
  };
  auto driver = std::make_shared<bunker::Driver>(
      "bunker", s.bunker.params,
      [this] { return base::Result<std::unique_ptr<link::FrameLink>>(std::move(can_.a)); },
      [this](const base::Measurement& m) { robot_.measurements().put(m); });
  robot_.send = [driver](const base::DriveCommand& c, base::Time t) { driver->send(c, t); };
  driver->start(at_);
  ticks_.push_back([driver](base::Time t) { driver->tick(t); });
}

void Stage::wire_cart(const Settings& s, sim::Cart& plant) {
  join(drive_);
  join(bumper_);
  drive_.b->on_bytes = [&plant](base::Bytes b, base::Time) { plant.receive(b); };
  plant.on_drive = [this](base::Bytes b, base::Time t) {
    at_ = t;
    drive_.b->write(b);
  };
  plant.on_bumper = [this](base::Bytes b, base::Time t) {
    at_ = t;
    bumper_.b->write(b);
  };
  add<ackermann::Driver>("ackermann", s.ackermann, drive_);
  add<ratio::Driver>("ratio", s.ratio, drive_);
  add<twist::Driver>("twist", s.twist, drive_);
  add<bumper::Driver>("bumper", s.bumper, bumper_);
}

/// The device threads tick twice as often as the robot.
void Stage::tick() {
  now_ += kTick;
  for (const base::Time t : {now_ - kTick / 2, now_}) {
    plant_->advance_to(t);
    at_ = t;
    if (!alive_) continue;
    for (const auto& tick : ticks_) tick(t);
    if (on_heard) on_heard(t);
  }
  if (!alive_) return;
  const auto before = std::chrono::steady_clock::now();
  robot_.tick(now_, wall_ + now_.time_since_epoch());
  const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - before;
  tick_us_ = took.count();
  replies_.clear();
  robot_.replies().take(replies_);
  for (auto& r : replies_) {
    if (r.reply) r.reply(std::move(r.result));
  }
  events_.clear();
  robot_.events().take(events_);
}

base::Result<void> Stage::ask(robot::Command command) {
  base::Result<void> answer = base::fail(base::Code::Unavailable, "no answer came");
  robot_.request(std::move(command), now_ + std::chrono::seconds(1),
                 [&answer](base::Result<void> r) { answer = std::move(r); });
  tick();
  return answer;
}

}  // namespace roverd::study
