#include "devices.hpp"

#include <filesystem>
#include <memory>
#include <utility>

#include <net/if.h>

#include "ackermann/driver.hpp"
#include "bumper/driver.hpp"
#include "bunker/driver.hpp"
#include "gnss/driver.hpp"
#include "gnss/nmea.hpp"
#include "link/address.hpp"
#include "link/record.hpp"
#include "link/replay_file.hpp"
#include "ratio/driver.hpp"
#include "twist/driver.hpp"

namespace roverd {
namespace {

namespace asio = boost::asio;
using base::Result;

/// A file name for this moment: 20260301T120000Z-can0.log
std::string file_for_now(const std::string& ending) {
  std::string text;
  for (const char c : base::to_rfc3339(base::wall_now())) {
    if (c == '.') break;
    if (c != '-' && c != ':') text += c;
  }
  return text + "Z-" + ending;
}

Result<std::string> recording_file(const Options& options, const std::string& ending) {
  const auto folder = std::filesystem::path(options.data) / "recordings";
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  if (ec) {
    return base::fail(base::Code::Unavailable,
                      "recording folder " + folder.string() + ": " + ec.message());
  }
  return (folder / file_for_now(ending)).string();
}

bool records(const Settings& settings, const Options& options) {
  return options.replay.empty() && (settings.recording.enabled || options.record);
}

/// @return whether `file` is a recording of CAN frames.
bool holds_frames(const std::string& file) {
  return link::FrameFile(file, [](const base::CanFrame&, base::Time) {}).open().has_value();
}

/// The bus keeps its name in the log where it has one.
link::RecordOptions record_options(const Settings& settings, const std::string& address) {
  link::RecordOptions options;
  options.max_bytes = static_cast<std::uint64_t>(settings.recording.max_mb) * 1'000'000;
  options.keep_files = settings.recording.keep_files;
  const auto parsed = link::parse_address(address);
  if (parsed && parsed->scheme == link::Scheme::Can) options.bus = parsed->target;
  return options;
}

link::ReplayOptions replay_options(const Options& options) {
  link::ReplayOptions replay;
  replay.speed = options.replay_speed;
  replay.line_clock = gnss::time_of_day_s;
  return replay;
}

/// Frames or bytes: how such a link is made, and taped.
struct Frames {
  using Link = link::FrameLink;
  using Taped = link::RecordedFrameLink;
  static constexpr auto kMake = link::make_frame_link;
  static constexpr const char* kEnding = ".log";
};
struct ByteStream {
  using Link = link::ByteLink;
  using Taped = link::RecordedByteLink;
  static constexpr auto kMake = link::make_byte_link;
  static constexpr const char* kEnding = ".raw";
};

template <class Kind>
Result<std::unique_ptr<typename Kind::Link>> open_link(const Workshop& w, const std::string& name,
                                                       const std::string& address) {
  auto made = Kind::kMake(w.io, address, replay_options(w.options));
  if (!made || !records(w.settings, w.options)) return made;
  const auto file = recording_file(w.options, name + Kind::kEnding);
  if (!file) return tl::unexpected(file.error());
  auto taped = Kind::Taped::create(std::move(*made), *file, record_options(w.settings, address));
  if (!taped) return tl::unexpected(taped.error());
  return std::move(*taped);
}

Result<void> check(const std::string& key, const DriverWiring& wiring) {
  if (!wiring.enabled) return {};
  const auto parsed = link::parse_address(wiring.link);
  if (!parsed) {
    return base::fail(base::Code::Invalid, "drivers." + key + ".link: " + parsed.error().detail);
  }
  // A base that is not there at the start is a mistake in the configuration or the set-up: say so
  // at once. One that goes away later is waited for.
  if (parsed->scheme == link::Scheme::Can && ::if_nametoindex(parsed->target.c_str()) == 0) {
    return base::fail(base::Code::NotFound, "drivers." + key + ".link: CAN interface " +
                                                parsed->target + " does not exist");
  }
  return {};
}

/// Whoever moves a vehicle has to know whom it speaks to: any sender may not become the vehicle.
Result<void> check_peer(const std::string& key, const DriverWiring& wiring) {
  const auto parsed = link::parse_address(wiring.link);
  if (!parsed || parsed->scheme != link::Scheme::Udp || !parsed->target.empty()) return {};
  return base::fail(base::Code::Invalid,
                    "drivers." + key + ".link: " + wiring.link +
                        " names no peer; a vehicle wants udp:HOST:PORT or udp:LOCALPORT:HOST:PORT");
}

/// The driver lives as long as the device's functions.
template <class Driver>
Device device_of(const std::string& name, std::shared_ptr<Driver> driver) {
  Device device{
      .name = name,
      .start = [driver](base::Time now) { driver->start(now); },
      .tick = [driver](base::Time now) { driver->tick(now); },
      .stop = [driver](base::Time now) { driver->stop(now); },
      .restart = [driver](base::Time now) { driver->restart(now); },
      .send = {},
  };
  if constexpr (requires(base::DriveCommand c, base::Time t) { driver->send(c, t); }) {
    device.send = [driver = driver.get()](const base::DriveCommand& command, base::Time now) {
      driver->send(command, now);
    };
  }
  return device;
}

/// Makes the wanted ones of the drivers that there are.
class Maker {
 public:
  explicit Maker(const Workshop& workshop) : w_(workshop) {}

  template <class Kind, class Driver, class Params>
  Result<void> add(const std::string& name, const Wired<Params>& said) {
    const bool replays = !w_.options.replay.empty();
    if (replays && !plays(name)) return {};
    const DriverWiring wiring =
        replays ? DriverWiring{true, "replay:" + w_.options.replay} : said.wiring;
    if (!wiring.enabled) return {};
    if (auto good = check(name, wiring); !good) return good;
    if constexpr (requires(Driver & d, base::DriveCommand c, base::Time t) { d.send(c, t); }) {
      if (auto good = check_peer(name, wiring); !good) return good;
    }
    Params params = said.params;
    // A hole in a recording is no reason to open it again: it would begin anew.
    if (replays) params.silent_reopen_s = 0.0;
    if (auto good = validate(params); !good) return good;
    const auto make = [w = w_, name, link = wiring.link] { return open_link<Kind>(w, name, link); };
    made_.push_back(device_of(name, std::make_shared<Driver>(name, params, make, w_.sink)));
    return {};
  }

  std::vector<Device> take() { return std::move(made_); }

 private:
  /// A recording is either a bus or a receiver.
  bool plays(const std::string& name) const {
    return name == (holds_frames(w_.options.replay) ? "bunker" : "gnss");
  }

  const Workshop& w_;
  std::vector<Device> made_;
};

}  // namespace

Result<std::vector<Device>> make_devices(const Workshop& workshop) {
  const Settings& s = workshop.settings;
  Maker maker(workshop);
  if (auto done = maker.add<Frames, bunker::Driver>("bunker", s.bunker); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = maker.add<ByteStream, ackermann::Driver>("ackermann", s.ackermann); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = maker.add<ByteStream, ratio::Driver>("ratio", s.ratio); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = maker.add<ByteStream, twist::Driver>("twist", s.twist); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = maker.add<ByteStream, bumper::Driver>("bumper", s.bumper); !done) {
    return tl::unexpected(done.error());
  }
  if (auto done = maker.add<ByteStream, gnss::Driver>("gnss", s.gnss); !done) {
    return tl::unexpected(done.error());
  }
  return maker.take();
}

}  // namespace roverd
