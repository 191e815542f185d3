#include "replay/parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <utility>

#include "ackermann/driver.hpp"
#include "bumper/driver.hpp"
#include "bunker/driver.hpp"
#include "cloud/driver.hpp"
#include "config/receiver_params.hpp"
#include "gnss/driver.hpp"
#include "gpsd/driver.hpp"
#include "link/memory.hpp"
#include "mti/driver.hpp"
#include "ranges/driver.hpp"
#include "ratio/driver.hpp"
#include "replay/replays.hpp"
#include "replay/sensors.hpp"
#include "rtcm/framer.hpp"
#include "sick/driver.hpp"
#include "twist/driver.hpp"
#include "velodyne/driver.hpp"
#include "vision/driver.hpp"

namespace roverd {
namespace {

using base::Result;
using base::Time;
using Tell = std::function<void(const base::Measurement&)>;

class BusPart final : public ReplayPart {
 public:
  BusPart(const bunker::Params& params, const Tell& tell)
      : wire_(link::memory_frame_pair()),
        driver_(
            "bunker", params,
            [this] { return Result<std::unique_ptr<link::FrameLink>>(std::move(wire_.a)); }, tell) {
    wire_.b->set_immediate([this] { return clock_; });
    static_cast<void>(wire_.b->open());
  }
  void start(Time now) override { driver_.start(now); }
  void tick(Time now) override { driver_.tick(now); }
  base::DriverStatus status(Time now) const override { return driver_.status(now); }

 private:
  Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) override {
    auto file = std::make_unique<link::FrameFile>(
        path, [this](const base::CanFrame& f, Time) { wire_.b->send(f); });
    if (const auto opened = file->open(); !opened) return tl::unexpected(opened.error());
    return Result<std::unique_ptr<link::ReplayFile>>(std::move(file));
  }
  link::MemoryFramePair wire_;
  bunker::Driver driver_;
};

/// @param sent hears what was sent then; null: nobody does.
Result<std::unique_ptr<link::ReplayFile>> byte_file(const std::string& path,
                                                    link::ByteFile::Receiver received,
                                                    link::ByteFile::Receiver sent) {
  link::ReplayOptions how;
  how.make_clock = device_clock;
  auto file = std::make_unique<link::ByteFile>(path, how, std::move(received), std::move(sent));
  if (const auto opened = file->open(); !opened) return tl::unexpected(opened.error());
  return Result<std::unique_ptr<link::ReplayFile>>(std::move(file));
}

template <class Driver, class Params>
class BytePart final : public ReplayPart {
 public:
  BytePart(const char* name, const Params& params, const Tell& tell)
      : wire_(link::memory_byte_pair()),
        ear_(wire_.a.get()),
        driver_(
            name, params,
            [this] { return Result<std::unique_ptr<link::ByteLink>>(std::move(wire_.a)); }, tell) {
    wire_.b->set_immediate([this] { return clock_; });
    static_cast<void>(wire_.b->open());
  }
  void start(Time now) override { driver_.start(now); }
  void tick(Time now) override { driver_.tick(now); }
  base::DriverStatus status(Time now) const override { return driver_.status(now); }

 private:
  Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) override {
    return byte_file(
        path, [this](base::Bytes b, Time) { wire_.b->write(b); },
        [this](base::Bytes b, Time t) {
          if (ear_->on_sent) ear_->on_sent(b, t);
        });
  }
  link::MemoryBytePair wire_;
  const link::ByteLink* const ear_;  ///< the driver's end, which it keeps
  Driver driver_;
};

/// What looks around says nothing of where the robot is: what it saw is told to whoever asks.
template <class Driver, class Params>
class SensorPart final : public ReplayPart {
 public:
  template <class OnSeen>
  SensorPart(const std::string& name, const Params& params, const OnSeen& on_seen)
      : wire_(link::memory_byte_pair()),
        driver_(
            name, params,
            [this] { return Result<std::unique_ptr<link::ByteLink>>(std::move(wire_.a)); },
            [](const base::Measurement&) {}, on_seen) {
    wire_.b->set_immediate([this] { return clock_; });
    static_cast<void>(wire_.b->open());
  }
  void start(Time now) override { driver_.start(now); }
  void tick(Time now) override { driver_.tick(now); }
  base::DriverStatus status(Time now) const override { return driver_.status(now); }

 private:
  Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) override {
    return byte_file(path, [this](base::Bytes b, Time) { wire_.b->write(b); }, {});
  }
  link::MemoryBytePair wire_;
  Driver driver_;
};

std::unique_ptr<ReplayPart> sensor_part(const std::string& name, const Sensor& configured,
                                        const base::OnSight& on_sight) {
  const Sensor s = as_recorded(configured);
  if (s.said.kind == "cloud" || s.said.kind == "depth") {
    return std::make_unique<SensorPart<cloud::Driver, cloud::Params>>(name, as_heard(s), on_sight);
  }
  if (s.said.kind == "ranges") {
    return std::make_unique<SensorPart<ranges::Driver, ranges::Params>>(name, s.ranges, on_sight);
  }
  if (s.said.kind == "sick") {
    return std::make_unique<SensorPart<sick::Driver, sick::Params>>(name, s.sick, on_sight);
  }
  if (s.said.kind == "vision") {
    const base::OnVision nobody = [](const std::shared_ptr<const base::Vision>&) {};
    return std::make_unique<SensorPart<vision::Driver, vision::Params>>(name, s.vision, nobody);
  }
  return std::make_unique<SensorPart<velodyne::Driver, velodyne::Params>>(name, s.velodyne,
                                                                          on_sight);
}

/// Corrections say nothing of the robot: their frames are counted.
class CorrectionsPart final : public ReplayPart {
 public:
  void start(Time) override {}
  void tick(Time) override {}
  base::DriverStatus status(Time now) const override {
    base::DriverStatus s;
    s.stamp = now;
    s.name = "ntrip";
    s.received = framer_.counts().frames;
    s.refused = framer_.counts().bad_crc;
    auto detail = std::make_shared<base::DriverDetail>();
    for (const auto& [number, count] : by_number_) {
      detail->counts["RTCM3 " + std::to_string(number)] = count;
    }
    s.detail = std::move(detail);
    return s;
  }

 private:
  Result<std::unique_ptr<link::ReplayFile>> make_file(const std::string& path) override {
    return byte_file(path,
                     [this](base::Bytes b, Time) {
                       framer_.feed(b, [this](const rtcm::Frame& f) { ++by_number_[f.number]; });
                     },
                     {});
  }
  rtcm::Framer framer_;
  std::map<int, std::uint64_t> by_number_;
};

/// A hole in a recording is no reason to open it again, and nobody there answers.
template <class Driver, class Params>
std::unique_ptr<ReplayPart> bytes_of(const char* name, Params params, const Tell& tell) {
  params.silent_reopen_s = 0.0;
  if constexpr (std::is_same_v<Params, mti::Params>) params.configure = false;
  if constexpr (std::is_same_v<Params, gnss::Params>) params.ubx_configure = false;
  return std::make_unique<BytePart<Driver, Params>>(name, params, tell);
}

}  // namespace

Result<void> ReplayPart::open(const std::string& path) {
  auto made = make_file(path);
  if (!made) return tl::unexpected(made.error());
  file_ = std::move(*made);
  return load();
}

void ReplayPart::align(std::optional<base::Duration> run_begin) {
  const auto begin = file_->begin();
  if (begin && run_begin) lead_ = *begin - *run_begin;  // without dates it begins with the run
}

std::optional<base::Duration> ReplayPart::due() const {
  if (!at_) return {};
  return lead_ + *at_;
}

Result<void> ReplayPart::emit(Time now) {
  clock_ = now;
  file_->emit(now);
  return load();
}

Result<void> ReplayPart::load() {
  auto next = file_->advance();
  if (!next) return tl::unexpected(next.error());
  at_ = *next;
  return {};
}

std::unique_ptr<ReplayPart> replay_part(const std::string& driver, const Settings& s,
                                        const Tell& tell, const base::OnSight& on_sight) {
  if (const auto sensor = s.sensors.find(driver); sensor != s.sensors.end()) {
    return sensor_part(driver, sensor->second, on_sight);
  }
  if (driver == "bunker") {
    bunker::Params p = s.bunker.params;
    p.silent_reopen_s = 0.0;
    return std::make_unique<BusPart>(p, tell);
  }
  if (driver == "ntrip") return std::make_unique<CorrectionsPart>();
  if (driver == "mti") return bytes_of<mti::Driver>("mti", s.mti.params, tell);
  if (driver == "ackermann") {
    return bytes_of<ackermann::Driver>("ackermann", s.ackermann.params, tell);
  }
  if (driver == "ratio") return bytes_of<ratio::Driver>("ratio", s.ratio.params, tell);
  if (driver == "twist") return bytes_of<twist::Driver>("twist", s.twist.params, tell);
  if (driver == "bumper") return bytes_of<bumper::Driver>("bumper", s.bumper.params, tell);
  if (driver == "gpsd") {
    return bytes_of<gpsd::Driver>("gnss", gpsd_params(s.gnss.params, ""), tell);
  }
  return bytes_of<gnss::Driver>("gnss", s.gnss.params, tell);
}

}  // namespace roverd
