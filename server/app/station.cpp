#include <thread>

#include "app/station_impl.hpp"

namespace roverd {

namespace {
constexpr base::Duration kGoodbye = std::chrono::milliseconds(500);
constexpr base::Duration kFirstTick = std::chrono::seconds(10);
constexpr base::Duration kRecall = std::chrono::seconds(2);
constexpr base::Duration kLook = std::chrono::milliseconds(1);
}  // namespace

void Station::Impl::start() {
  bell = std::make_unique<net::Doorbell>(web, [this] { api->drain(); });
  robot.wake = [this] { bell->ring(); };
  robot.send = [this](const base::DriveCommand& command, base::Time now) {
    supervisor->send(command, now);
  };
  robot.alert = [this] {
    if (loop) loop->alert();
  };
  signals.async_wait([this](const boost::system::error_code& ec, int) {
    if (!ec) stop();
  });
  supervisor->start();
  start_services();
  keep_learned_soon();
  tidy_recordings();
  loop = std::make_unique<ControlLoop>(
      [this](base::Time now, base::WallTime wall, base::Duration lateness) {
        robot.tick(now, wall, lateness);
      },
      [this](base::Time now) { robot.heed_stop(now); });
  await_first_tick();
  bell->ring();  // for what was found out before there was a bell
  watch_host_soon();
  watch_names_soon();
  manager.ready(address);
  tell_alive();
  base::log(base::Level::Info, "main", "serving",
            {{"robot", presence->badge().name}, {"address", address}, {"version", kVersion}});
}

/// Who asks the moment that "listening" is told hears of the robot, and of the mission that was
/// left behind, on a slow computer too.
void Station::Impl::await_first_tick() const {
  const auto known = [this](base::Duration waited) {
    return robot.snapshot() && (services->view()->recalled || waited > kRecall);
  };
  for (auto waited = base::Duration{}; waited < kFirstTick && !known(waited); waited += kLook) {
    std::this_thread::sleep_for(kLook);
  }
}

void Station::Impl::start_services() {
  const auto on_web = [this](auto work) { asio::post(web, std::move(work)); };
  services->start({.tell =
                       [this, on_web](base::Event event) {
                         on_web([this, event = std::move(event)] { api->on_event(event); });
                       },
                   .mission_changed =
                       [this, on_web](const std::string& id, std::int64_t revision) {
                         on_web([this, id, revision] { api->on_mission_change(id, revision); });
                       },
                   .answer = on_web});
}

void Station::Impl::halt() noexcept {
  loop.reset();
  if (supervisor) supervisor->stop();
  if (around) around->stop();
  if (place) place->stop();
  if (tags) tags->stop();
  if (maker) maker->cancel();
  if (sense) sense->stop();  // a driver that hangs may hold it for longer than the robot lives
}

void Station::Impl::stop() {
  base::log(base::Level::Info, "main", "stopping");
  manager.stopping();
  halt();
  drill.stop();
  server->stop(kGoodbye, [this] {
    bell->silence();
    api->on_end();
    web.stop();
  });
}

Station::Station(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Station::~Station() {
  impl_->halt();
  impl_->workers.stop();
  if (impl_->presence) impl_->presence->hush();
  impl_->keep_learned();
  // What is on its way to the web is dropped with the io_context.
  if (impl_->services) impl_->services->stop();
  impl_->server.reset();
  impl_->services.reset();
  impl_->backups.reset();
  impl_->store.reset();  // its last answers are posted, and dropped with the io_context
}

Result<std::unique_ptr<Station>> Station::open(const Settings& settings, const Options& options) {
  std::unique_ptr<Station> station(new Station(std::make_unique<Impl>(settings)));
  if (auto done = station->impl_->open(settings, options); !done) {
    return tl::unexpected(done.error());
  }
  return station;
}

std::string Station::address() const {
  return impl_->address;
}

std::string Station::invitation(bool drawn) const {
  return impl_->front ? impl_->front->invitation(drawn) : std::string();
}

/// No memory for one request must not end the others, nor the robot's control: what it cut off is
/// taken up again.
void Station::Impl::serve() {
  for (;;) {
    try {
      web.run();
      return;
    } catch (const std::exception& error) {
      try {
        base::log(base::Level::Error, "main", "a handler on the web thread failed",
                  {{"what", error.what()}});
        server->resume();
        bell->resume();
      } catch (const std::exception&) {
        continue;  // again, with the next one
      }
    }
  }
}

void Station::run() {
  impl_->serve();
}

}  // namespace roverd
