#include "driver_bay.hpp"

#include <filesystem>
#include <functional>
#include <utility>

#include <boost/asio/post.hpp>
#include <net/if.h>

#include "gnss/nmea.hpp"
#include "link/address.hpp"
#include "link/record.hpp"
#include "link/replay_file.hpp"

namespace roverd {
namespace {

namespace asio = boost::asio;
using base::Result;

/// Drivers' time-outs and back-off are tenths of a second; 50 Hz is fine for all of them.
constexpr auto kTick = std::chrono::milliseconds(20);

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

link::ReplayOptions replay_options(const Options& options) {
  link::ReplayOptions replay;
  replay.speed = options.replay_speed;
  replay.line_clock = gnss::time_of_day_s;
  return replay;
}

Result<std::unique_ptr<link::FrameLink>> frame_link(asio::io_context& io,
                                                    const std::string& address,
                                                    const Settings& settings,
                                                    const Options& options) {
  auto made = link::make_frame_link(io, address, replay_options(options));
  if (!made || !records(settings, options)) return made;
  const auto file = recording_file(options, "can.log");
  if (!file) return tl::unexpected(file.error());
  auto taped = link::RecordedFrameLink::create(std::move(*made), *file);
  if (!taped) return tl::unexpected(taped.error());
  return std::move(*taped);
}

Result<std::unique_ptr<link::ByteLink>> byte_link(asio::io_context& io, const std::string& address,
                                                  const Settings& settings,
                                                  const Options& options) {
  auto made = link::make_byte_link(io, address, replay_options(options));
  if (!made || !records(settings, options)) return made;
  const auto file = recording_file(options, "gnss.raw");
  if (!file) return tl::unexpected(file.error());
  auto taped = link::RecordedByteLink::create(std::move(*made), *file);
  if (!taped) return tl::unexpected(taped.error());
  return std::move(*taped);
}

/// The link address of a driver and whether it is wanted at all, the recording considered.
DriverWiring wiring_of(const DriverWiring& said, const Options& options, bool for_frames) {
  if (options.replay.empty()) return said;
  return {holds_frames(options.replay) == for_frames, "replay:" + options.replay};
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

}  // namespace

Result<std::unique_ptr<DriverBay>> DriverBay::make(const Settings& settings, const Options& options,
                                                   const OnMeasurement& on_measurement) {
  if (!options.replay.empty() && !std::filesystem::is_regular_file(options.replay)) {
    return base::fail(base::Code::NotFound, "no recording " + options.replay);
  }
  if (auto good = bunker::validate(settings.bunker); !good) return tl::unexpected(good.error());
  Settings wired = settings;
  wired.bunker_wiring = wiring_of(settings.bunker_wiring, options, true);
  wired.gnss_wiring = wiring_of(settings.gnss_wiring, options, false);
  if (!options.replay.empty()) {
    // A hole in a recording is no reason to open it again: it would begin anew.
    wired.bunker.silent_reopen_s = 0.0;
    wired.gnss.silent_reopen_s = 0.0;
  }
  if (auto good = check("bunker", wired.bunker_wiring); !good) return tl::unexpected(good.error());
  if (auto good = check("gnss", wired.gnss_wiring); !good) return tl::unexpected(good.error());

  std::unique_ptr<DriverBay> bay(new DriverBay);
  if (wired.bunker_wiring.enabled) bay->add_bunker(wired, options, on_measurement);
  if (wired.gnss_wiring.enabled) bay->add_gnss(wired, options, on_measurement);
  return bay;
}

void DriverBay::add_bunker(const Settings& settings, const Options& options,
                           const OnMeasurement& sink) {
  bunker_ = std::make_unique<bunker::Driver>(
      "bunker", settings.bunker,
      [this, settings, options] {
        return frame_link(io_, settings.bunker_wiring.link, settings, options);
      },
      sink);
}

void DriverBay::add_gnss(const Settings& settings, const Options& options,
                         const OnMeasurement& sink) {
  gnss_ = std::make_unique<gnss::Driver>(
      "gnss", settings.gnss,
      [this, settings, options] {
        return byte_link(io_, settings.gnss_wiring.link, settings, options);
      },
      sink);
}

DriverBay::~DriverBay() {
  stop();
}

void DriverBay::start() {
  asio::post(io_, [this] {
    const base::Time now = base::steady_now();
    if (bunker_) bunker_->start(now);
    if (gnss_) gnss_->start(now);
    tick_soon();
  });
  thread_ = std::thread([this] { io_.run(); });
}

void DriverBay::tick_soon() {
  timer_.expires_after(kTick);
  timer_.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    const base::Time now = base::steady_now();
    if (bunker_) bunker_->tick(now);
    if (gnss_) gnss_->tick(now);
    tick_soon();
  });
}

void DriverBay::stop() {
  if (!thread_.joinable()) return;
  asio::post(io_, [this] {
    timer_.cancel();
    const base::Time now = base::steady_now();
    if (bunker_) bunker_->stop(now);
    if (gnss_) gnss_->stop(now);
    work_.reset();
    io_.stop();
  });
  thread_.join();
}

void DriverBay::send(const base::DriveCommand& command, base::Time now) noexcept {
  if (bunker_) bunker_->send(command, now);
}

std::vector<std::string> DriverBay::names() const {
  std::vector<std::string> names;
  if (bunker_) names.emplace_back("bunker");
  if (gnss_) names.emplace_back("gnss");
  return names;
}

}  // namespace roverd
