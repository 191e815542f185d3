#include "app/devices.hpp"

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <net/if.h>

#include "ackermann/driver.hpp"
#include "app/picture_camera.hpp"
#include "app/tape.hpp"
#include "app/workshop.hpp"
#include "base/inbox.hpp"
#include "base/latest.hpp"
#include "base/log.hpp"
#include "bumper/driver.hpp"
#include "bunker/driver.hpp"
#include "camera/driver.hpp"
#include "cloud/driver.hpp"
#include "config/receiver_params.hpp"
#include "gnss/driver.hpp"
#include "gpsd/driver.hpp"
#include "link/address.hpp"
#include "mti/driver.hpp"
#include "ntrip/driver.hpp"
#include "ranges/driver.hpp"
#include "ratio/driver.hpp"
#include "replay/replays.hpp"
#include "replay/sensors.hpp"
#include "sick/driver.hpp"
#include "twist/driver.hpp"
#include "velodyne/driver.hpp"
#include "vision/driver.hpp"

namespace roverd {
namespace {

namespace asio = boost::asio;
using base::Result;

/// Between the corrections' thread and the receiver's.
struct Corrections {
  base::Inbox<std::vector<std::uint8_t>> frames{64};
  base::Latest<base::GnssFix> fix;
};
using CorrectionsPtr = std::shared_ptr<Corrections>;

Result<void> check_can(const std::string& who, const std::string& interface) {
  if (::if_nametoindex(interface.c_str()) == 0) {
    return base::fail(base::Code::NotFound,
                      who + ": CAN interface " + interface + " does not exist");
  }
  constexpr int kCanHardware = 280;  // ARPHRD_CAN
  int hardware = kCanHardware;
  std::ifstream("/sys/class/net/" + interface + "/type") >> hardware;
  if (hardware == kCanHardware) return {};
  return base::fail(base::Code::Invalid, who + ": " + interface + " is no CAN interface");
}

Result<void> check_link(const std::string& who, const std::string& address) {
  const auto parsed = link::parse_address(address);
  if (!parsed) return base::fail(base::Code::Invalid, who + ": " + parsed.error().detail);
  // A base that is not there at the start is a mistake in the configuration or the set-up: say so
  // at once. One that goes away later is waited for.
  if (parsed->scheme == link::Scheme::Can) return check_can(who, parsed->target);
  std::error_code ec;
  if (parsed->scheme == link::Scheme::CanSocket &&
      !std::filesystem::is_socket(parsed->target, ec)) {
    return base::fail(base::Code::NotFound, who + ": there is no socket " + parsed->target);
  }
  return {};
}

/// The kind of link that a driver needs, from a trial on a context that never runs.
template <class Kind>
Result<void> check_kind(const std::string& who, const std::string& address) {
  asio::io_context nowhere;
  if (auto made = Kind::kMake(nowhere, address, {}); !made) {
    return base::fail(base::Code::Invalid, who + ": " + made.error().detail);
  }
  return {};
}

template <class Driver>
concept Moves = requires(Driver d, base::DriveCommand c, base::Time t) {
  d.send(c, t);
};
template <class Driver>
concept HasLights = requires(Driver d, base::LightState l, base::Time t) {
  d.set_lights(l, t);
};
template <class Driver>
concept ClearsErrors = requires(Driver d, base::Time t) {
  d.clear_errors(0, t);
};

/// Whoever moves a vehicle has to know whom it speaks to: any sender may not become the vehicle.
Result<void> check_peer(const std::string& who, const std::string& address) {
  const auto parsed = link::parse_address(address);
  if (!parsed || parsed->scheme != link::Scheme::Udp || !parsed->target.empty()) return {};
  return base::fail(base::Code::Invalid,
                    who + ": " + address +
                        " names no peer; a vehicle wants udp:HOST:PORT or udp:LOCALPORT:HOST:PORT");
}

/// The driver lives as long as the device's functions.
template <class Driver>
Device device_of(std::shared_ptr<Driver> driver) {
  Device device{
      .start = [driver](base::Time now) { driver->start(now); },
      .tick = [driver](base::Time now) { driver->tick(now); },
      .stop = [driver](base::Time now) { driver->stop(now); },
      .restart = [driver](base::Time now) { driver->restart(now); },
  };
  if constexpr (Moves<Driver>) {
    device.send = [driver = driver.get()](const base::DriveCommand& command, base::Time now) {
      driver->send(command, now);
    };
  }
  if constexpr (HasLights<Driver>) {
    device.set_lights = [driver](const base::LightState& lights, base::Time now) {
      return driver->set_lights(lights, now);
    };
  }
  if constexpr (ClearsErrors<Driver>) {
    device.clear_errors = [driver](int motor, base::Time now) {
      return driver->clear_errors(motor, now);
    };
  }
  return device;
}

/// The receiver takes corrections, and what it says of its place is for the caster.
std::shared_ptr<gnss::Driver> corrected(const std::string& name, const gnss::Params& params,
                                        gnss::Driver::MakeLink make_link, const DeviceEars& ears,
                                        const CorrectionsPtr& corrections) {
  const auto hear = [corrections, tell = ears.on_measurement](const base::Measurement& m) {
    if (const auto* fix = std::get_if<base::GnssFix>(&m)) {
      corrections->fix.publish(std::make_shared<const base::GnssFix>(*fix));
    }
    tell(m);
  };
  auto driver = std::make_shared<gnss::Driver>(name, params, std::move(make_link), hear);
  driver->take_corrections = [corrections](gnss::Driver::Frames& out) {
    static_cast<void>(corrections->frames.try_take(out));
  };
  return driver;
}

template <class Driver>
using Of = std::type_identity<Driver>;

/// Plans the wanted ones of the drivers that there are.
class Planner {
 public:
  Planner(const Settings& settings, WorkshopPtr workshop, Replays replays)
      : settings_(settings), workshop_(std::move(workshop)), replays_(std::move(replays)) {}

  template <class Kind, class Driver, class Params>
  Result<void> add(const std::string& name, const Wired<Params>& said) {
    const bool replaying = !replays_.file_of.empty();
    const auto replay = replays_.file_of.find(name);
    if (replaying ? replay == replays_.file_of.end() : !said.wiring.enabled) return {};
    const std::string address = replaying ? "replay:" + replay->second : said.wiring.link;
    const std::string who = settings_.where("drivers." + name + ".link");
    if (auto good = check_link(who, address); !good) return good;
    if (auto good = check_kind<Kind>(who, address); !good) return good;
    if constexpr (Moves<Driver>) {
      if (auto good = check_peer(who, address); !good) return good;
    }
    Params params = said.params;
    // A hole in a recording is no reason to open it again: it would begin anew.
    if (replaying) params.silent_reopen_s = 0.0;
    if constexpr (std::is_same_v<Driver, mti::Driver>) {
      if (replaying) params.configure = false;  // a recording does not answer
    }
    if (auto good = validate(params); !good) {
      const auto& fields = good.error().fields;
      const std::string key = "drivers." + name + (fields.empty() ? "" : "." + fields[0].pointer);
      return base::fail(base::Code::Invalid, settings_.where(key) + ": " + good.error().detail);
    }
    DevicePlan plan{.name = name,
                    .moves = Moves<Driver>,
                    .lights = HasLights<Driver>,
                    .clears_errors = ClearsErrors<Driver>,
                    .make = {}};
    plan.make = [w = workshop_, c = corrections_, name, params, address](asio::io_context& io,
                                                                         const DeviceEars& ears) {
      const auto make_link = [w, name, address, ears, &io] {
        return open_link<Kind>(*w, io, ears, name, address);
      };
      if constexpr (std::is_same_v<Driver, gnss::Driver>) {
        return device_of(corrected(name, params, make_link, ears, c));
      }
      return device_of(std::make_shared<Driver>(name, params, make_link, ears.on_measurement));
    };
    plans_.push_back(std::move(plan));
    return {};
  }

  /// What looks around tells what it sees elsewhere than to the robot.
  Result<void> add_sensor(const std::string& name, const Sensor& configured,
                          const base::OnSight& on_sight, const base::OnVision& on_vision) {
    const bool replaying = !replays_.file_of.empty();
    const auto replay = replays_.file_of.find(name);
    if (replaying ? replay == replays_.file_of.end() : !configured.said.enabled) return {};
    const std::string who = settings_.where("sensors." + name + ".link");
    const std::string address = replaying ? "replay:" + replay->second : configured.said.link;
    Sensor sensor = address.starts_with("replay:") ? as_recorded(configured) : configured;
    sensor.said.link = address;
    if (sensor.said.listens() == 0 && v4l2::path_of(address).empty()) {
      if (auto good = check_link(who, address); !good) return good;
      if (auto good = check_kind<ByteStream>(who, address); !good) return good;
    }
    DevicePlan plan;
    plan.name = name;
    plan.sees = true;
    plan.make = [w = workshop_, name, sensor, address, on_sight, on_vision](
                    asio::io_context& io, const DeviceEars& ears) {
      const link::BytePort::MakeLink make_link = [w, name, address, sensor, ears, &io] {
        return open_sensor(*w, io, ears, name, address, sensor);
      };
      const auto made = [&](auto kind, const auto& params) {
        using Driver = typename decltype(kind)::type;
        return device_of(
            std::make_shared<Driver>(name, params, make_link, ears.on_measurement, on_sight));
      };
      if (sensor.said.kind == "cloud") return made(Of<cloud::Driver>{}, sensor.cloud);
      if (sensor.said.kind == "depth") return made(Of<cloud::Driver>{}, as_heard(sensor));
      if (sensor.said.kind == "ranges") return made(Of<ranges::Driver>{}, sensor.ranges);
      if (sensor.said.kind == "sick") return made(Of<sick::Driver>{}, sensor.sick);
      if (sensor.said.kind == "vision") {
        return device_of(std::make_shared<vision::Driver>(name, sensor.vision, make_link,
                                                          ears.on_measurement, on_vision));
      }
      return made(Of<velodyne::Driver>{}, sensor.velodyne);
    };
    plans_.push_back(std::move(plan));
    return {};
  }

  /// Cameras of pictures are not recorded: they would fill the disk.
  Result<void> add_camera(const std::string& name, const CameraSetup& camera,
                          const base::OnPicture& on_picture) {
    if (!replays_.file_of.empty() || !camera.said.enabled) return {};
    std::optional<camera::Source> source;
    if (v4l2::path_of(camera.said.link).empty()) {
      auto parsed = camera::parse_source(camera.said.link);
      if (!parsed) return tl::unexpected(parsed.error());  // it was checked with the settings
      source = std::move(*parsed);
    }
    DevicePlan plan;
    plan.name = name;
    plan.make = [name, camera, source, on_picture](asio::io_context& io, const DeviceEars& ears) {
      camera::Driver::Doors doors;
      doors.make_link = [camera, source, &io]() -> Result<std::unique_ptr<link::ByteLink>> {
        if (source) return link::make_byte_link(io, source->address());
        return open_picture_camera(io, camera);
      };
      doors.on_measurement = ears.on_measurement;
      doors.on_picture = on_picture;
      return device_of(
          std::make_shared<camera::Driver>(name, camera.params, source, std::move(doors)));
    };
    plans_.push_back(std::move(plan));
    return {};
  }

  /// Its casters, with their logins, stand where others have their link.
  Result<void> add_ntrip(const Wired<ntrip::Params>& said) {
    if (!replays_.file_of.empty() || !said.wiring.enabled) return {};
    const auto casters = ntrip::parse_casters(said.wiring.link);
    if (!casters) {
      return base::fail(base::Code::Invalid,
                        settings_.where("drivers.ntrip.link") + ": " + casters.error().detail);
    }
    DevicePlan plan;
    plan.name = "ntrip";
    plan.make = [w = workshop_, c = corrections_, params = said.params, casters = *casters](
                    asio::io_context& io, const DeviceEars& ears) {
      ntrip::Driver::Doors doors;
      doors.make_link = [&io](const std::string& address) {
        return link::make_byte_link(io, address);
      };
      doors.on_measurement = ears.on_measurement;
      doors.on_frame = [c, tape = std::make_shared<CorrectionsTape>(w, ears)](base::Bytes frame) {
        tape->put(frame);
        return c->frames.put({frame.begin(), frame.end()});
      };
      doors.where = [c] {
        const auto fix = c->fix.get();
        return fix ? *fix : base::GnssFix{};
      };
      return device_of(std::make_shared<ntrip::Driver>("ntrip", params, casters, std::move(doors)));
    };
    plans_.push_back(std::move(plan));
    return {};
  }

  /// The receiver: at a port of ours, or served by a gpsd.
  Result<void> add_receiver(const Wired<gnss::Params>& said) {
    const auto replay = replays_.file_of.find("gpsd");
    if (replay != replays_.file_of.end()) {
      gnss::Params params = said.params;
      params.silent_reopen_s = 0.0;  // as of any recording
      return add_gpsd(gpsd_params(params, ""), "replay:" + replay->second);
    }
    const bool served =
        replays_.file_of.empty() && said.wiring.enabled && gpsd::is_source(said.wiring.link);
    if (!served) return add<ByteStream, gnss::Driver>("gnss", said);
    const auto source = gpsd::parse_source(said.wiring.link);
    if (!source) {
      return base::fail(base::Code::Invalid,
                        settings_.where("drivers.gnss.link") + ": " + source.error().detail);
    }
    return add_gpsd(gpsd_params(said.params, source->device), source->address);
  }

  std::vector<DevicePlan> take() { return std::move(plans_); }

 private:
  Result<void> add_gpsd(const gpsd::Params& params, const std::string& address) {
    DevicePlan plan;
    plan.name = "gnss";
    plan.make = [w = workshop_, params, address](asio::io_context& io, const DeviceEars& ears) {
      const gpsd::Driver::MakeLink make_link = [w, address, ears, &io] {
        return open_link<ByteStream>(*w, io, ears, "gnss", address);
      };
      return device_of(
          std::make_shared<gpsd::Driver>("gnss", params, make_link, ears.on_measurement));
    };
    plans_.push_back(std::move(plan));
    return {};
  }

  const Settings& settings_;
  const WorkshopPtr workshop_;
  const Replays replays_;
  const CorrectionsPtr corrections_ = std::make_shared<Corrections>();
  std::vector<DevicePlan> plans_;
};

}  // namespace

Result<std::vector<DevicePlan>> plan_devices(const Settings& s, const Options& options,
                                             const DeviceEyes& eyes) {
  auto replays = read_replays(options.replays, options.replay_speed, s.sensors);
  if (!replays) return tl::unexpected(replays.error());
  for (const std::string& remark : replays->remarks) base::log(base::Level::Info, "replay", remark);
  auto workshop = std::make_shared<Workshop>();
  workshop->folder = (std::filesystem::path(options.data) / kRecordings).string();
  workshop->records = options.replays.empty() && (s.recording.enabled || options.record);
  workshop->record.max_bytes = static_cast<std::uint64_t>(s.recording.max_mb) * 1'000'000;
  workshop->record.keep_files = s.recording.keep_files;
  workshop->replay = replays->how;
  Planner planner(s, workshop, std::move(*replays));
  Result<void> done = planner.add<Frames, bunker::Driver>("bunker", s.bunker);
  if (done) done = planner.add<ByteStream, ackermann::Driver>("ackermann", s.ackermann);
  if (done) done = planner.add<ByteStream, ratio::Driver>("ratio", s.ratio);
  if (done) done = planner.add<ByteStream, twist::Driver>("twist", s.twist);
  if (done) done = planner.add<ByteStream, bumper::Driver>("bumper", s.bumper);
  if (done) done = planner.add_receiver(s.gnss);
  if (done) done = planner.add<ByteStream, mti::Driver>("mti", s.mti);
  if (done) done = planner.add_ntrip(s.ntrip);
  for (const auto& [name, sensor] : s.sensors) {
    if (done) done = planner.add_sensor(name, sensor, eyes.on_sight, eyes.on_vision);
  }
  for (const auto& [name, camera] : s.cameras) {
    if (done) done = planner.add_camera(name, camera, eyes.on_picture);
  }
  if (!done) return tl::unexpected(done.error());
  return planner.take();
}

}  // namespace roverd
