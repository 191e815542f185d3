#include "app/station.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include "api/api.hpp"
#include "app/backup_keeper.hpp"
#include "app/child_process.hpp"
#include "app/control_loop.hpp"
#include "app/devices.hpp"
#include "app/drill.hpp"
#include "app/estop_keeper.hpp"
#include "app/front.hpp"
#include "app/host_watch.hpp"
#include "app/memory_reserve.hpp"
#include "app/presence.hpp"
#include "app/recordings.hpp"
#include "app/version.hpp"
#include "app/wiring.hpp"
#include "app/workshop.hpp"
#include "base/angle.hpp"
#include "base/log.hpp"
#include "base/params.hpp"
#include "config/learned.hpp"
#include "config/reach.hpp"
#include "net/assets.hpp"
#include "net/doorbell.hpp"
#include "net/hub.hpp"
#include "net/page.hpp"
#include "net/server.hpp"
#include "net/workers.hpp"
#include "pair/code.hpp"
#include "robot/robot.hpp"
#include "store/store.hpp"
#include "store/tiles.hpp"
#include "supervise/claim.hpp"
#include "supervise/service_manager.hpp"
#include "supervise/supervisor.hpp"

namespace roverd {
namespace {

namespace asio = boost::asio;
using base::Result;

constexpr base::Duration kGoodbye = std::chrono::milliseconds(500);
constexpr base::Duration kKeepLearned = std::chrono::minutes(1);
constexpr base::Duration kLookAtHost = std::chrono::seconds(1);
constexpr base::Duration kTidyRecordings = std::chrono::minutes(1);
constexpr base::Duration kLookAtNames = std::chrono::seconds(5);
/// A stop that was obeyed is confirmed then, whether the disk has taken it or hangs.
constexpr base::Duration kKeepEstop = std::chrono::milliseconds(200);

}  // namespace

struct Station::Impl {
  explicit Impl(const Settings& settings) : robot(settings.robot) {}

  asio::io_context web{net::kWebConcurrency};
  robot::Robot robot;
  net::Files page{net::page_entries()};
  store::TileFolder tiles;
  std::unique_ptr<Supervisor> supervisor;
  std::unique_ptr<store::Store> store;
  std::unique_ptr<BackupKeeper> backups;
  std::unique_ptr<services::Services> services;
  people::Book people;                 ///< web thread
  std::unique_ptr<Presence> presence;  ///< before front, which asks it
  std::unique_ptr<Front> front;        ///< null: no TLS
  std::unique_ptr<api::Api> api;
  std::unique_ptr<net::Server> server;
  std::unique_ptr<net::Doorbell> bell;
  std::unique_ptr<EstopKeeper> estop;  ///< null: a recording is played, nothing is kept
  std::unique_ptr<ControlLoop> loop;
  asio::signal_set signals{web, SIGINT, SIGTERM};
  asio::steady_timer learned_timer{web};
  asio::steady_timer host_timer{web};
  asio::steady_timer tidy_timer{web};
  std::shared_ptr<RecordingTidier> tidier;  ///< null: a recording is played, none is removed
  asio::steady_timer names_timer{web};
  LatenessWatch lateness_watch;
  std::vector<base::HostProblem> host;  ///< what is wrong with this computer
  const bool memory_locked = lock_memory();
  ServiceManager manager = ServiceManager::of_this_process();
  asio::steady_timer alive_timer{web};
  std::optional<Claim> claim;          ///< of the link that moves the robot
  std::filesystem::path learned_file;  ///< empty: a recording is played, nothing is kept
  std::string learned_by;
  ChildProcess drill{web};    ///< plays failures, beside all this
  net::Workers workers{web};  ///< for what would keep the web waiting; ends first
  std::string address;

  Result<void> open(const Settings& settings, const Options& options);
  Result<void> open_tiles(const Settings& settings);
  Result<void> open_store(const Settings& settings, const Options& options);
  void open_estop(const Options& options, bool first);
  void when_estop_kept(std::function<void()> then);
  void serve();
  Result<void> open_server(const Settings& settings, const Options& options);
  void make_api(const Settings& settings, const Options& options);
  api::DriverDoor driver_door();
  void start();
  void start_services();
  void recall(const Settings& settings, const Options& options);
  void tell_left_out(const Settings& settings);
  void keep_learned();
  void keep_learned_soon();
  void tidy_recordings();
  Result<void> claim_robot(const Settings& settings, const Options& options);
  void watch_host();
  void watch_host_soon();
  void tell_certificate();
  void tell_address();
  void watch_names_soon();
  void tell_alive();
  void halt() noexcept;
  void stop();
};

Result<void> Station::Impl::open(const Settings& settings, const Options& options) {
  auto plans = plan_devices(settings, options);
  if (!plans) return tl::unexpected(plans.error());
  auto made = Supervisor::make(std::move(*plans),
                               [this](const base::Measurement& m) { robot.measurements().put(m); });
  if (!made) return tl::unexpected(made.error());
  supervisor = std::move(*made);
  if (auto done = open_tiles(settings); !done) return done;
  const bool first = !std::filesystem::exists(std::filesystem::path(options.data) / "roverd.db");
  if (auto done = open_store(settings, options); !done) return done;
  if (auto done = claim_robot(settings, options); !done) return done;
  open_estop(options, first);
  services = std::make_unique<services::Services>(robot, *store, settings.vehicle.name);
  auto known = Presence::open(settings);
  if (!known) return tl::unexpected(known.error());
  presence = std::move(*known);
  if (settings.server.tls) {
    auto opened = Front::open(settings.server, options.data, *presence);
    if (!opened) return tl::unexpected(opened.error());
    front = std::move(*opened);
  }
  make_api(settings, options);
  if (auto done = open_server(settings, options); !done) return done;
  recall(settings, options);
  if (options.replays.empty()) {
    const auto folder = std::filesystem::path(options.data) / kRecordings;
    tidier = std::make_shared<RecordingTidier>(folder, bounds_of(settings.recording));
  }
  robot.reviewed(settings.reviewed);
  tell_left_out(settings);
  tell_certificate();
  presence->announce(server->port(), front ? front->fingerprint() : "", [this](auto news) {
    asio::post(web, [this, news = std::move(news)] {
      if (auto event = presence->heard(news)) robot.tell(std::move(*event));
    });
  });
  start();
  return {};
}

Result<void> Station::Impl::open_tiles(const Settings& settings) {
  for (const auto& set : settings.tiles) {  // one by one first, to name the line of the wrong one
    if (auto done = store::TileFolder().open({set}); !done) {
      return base::fail(done.error().code,
                        settings.where("tiles." + set.first) + ": " + done.error().detail);
    }
  }
  return tiles.open(settings.tiles);
}

Result<void> Station::Impl::open_store(const Settings& settings, const Options& options) {
  store::Options how;
  how.keep_deleted = std::chrono::hours(24) * settings.missions.keep_deleted_days;
  how.keep_runs = settings.runs.keep;
  how.keep_runs_for = std::chrono::hours(24) * settings.runs.keep_days;
  how.max_run_bytes = std::int64_t{settings.runs.total_mb} * 1'000'000;
  how.max_events = settings.events.keep;
  how.keep_events_for = std::chrono::hours(24) * settings.events.keep_days;
  how.tell = [this](base::Event event) {
    asio::post(web, [this, event = std::move(event)] { api->on_event(event); });
  };
  auto opened = store::Store::open(
      std::filesystem::path(options.data) / "roverd.db",
      [this](std::function<void()> answer) { asio::post(web, std::move(answer)); }, std::move(how));
  if (!opened) return tl::unexpected(opened.error());
  store = std::move(*opened);
  if (settings.backups.keep > 0) {
    backups = std::make_unique<BackupKeeper>(
        options.data, backup_options(settings), [this](const std::string& why) {
          asio::post(web, [this, why] {
            api->on_event({base::wall_now(), base::Severity::Warning, "backup_failed", why});
          });
        });
  }
  return {};
}

void Station::Impl::open_estop(const Options& options, bool first) {
  if (!options.replays.empty()) return;
  const auto trouble = [this](const std::string& why) {
    asio::post(web, [this, why] {
      api->on_event({base::wall_now(), base::Severity::Error, "estop_not_kept", why});
    });
  };
  estop = EstopKeeper::open(std::filesystem::path(options.data) / "estop", first, {trouble});
  const EstopKeeper::Found& found = estop->found();
  if (found.latched) robot.begin_latched(found.why, base::wall_now());
  robot.on_latch = [this](bool latched) { estop->want(latched); };
}

/// Web thread.
void Station::Impl::when_estop_kept(std::function<void()> then) {
  if (!estop) return then();
  const auto once = std::make_shared<std::function<void()>>(std::move(then));
  const auto call = [once] {
    if (const auto now = std::exchange(*once, nullptr)) now();
  };
  const auto patience = std::make_shared<asio::steady_timer>(web, kKeepEstop);
  patience->async_wait([call, patience](const boost::system::error_code&) { call(); });
  estop->when_kept([this, call, patience] {
    asio::post(web, [call, patience] {
      patience->cancel();
      call();
    });
  });
}

/// What the web asks of drivers, and their answers back on the web thread.
api::DriverDoor Station::Impl::driver_door() {
  const auto on_web = [this](api::DriverDoor::Done done) {
    return [this, done = std::move(done)](Result<void> result) {
      asio::post(web, [done, result = std::move(result)] { done(result); });
    };
  };
  api::DriverDoor door;
  door.restart = [this](const std::string& name) { return supervisor->restart(name); };
  if (supervisor->has_lights()) {
    door.set_lights = [this, on_web](const base::LightState& lights, base::Time not_after,
                                     api::DriverDoor::Done done) {
      supervisor->set_lights(lights, not_after, on_web(std::move(done)));
    };
  }
  if (supervisor->clears_errors()) {
    door.clear_errors = [this, on_web](int motor, base::Time not_after,
                                       api::DriverDoor::Done done) {
      supervisor->clear_errors(motor, not_after, on_web(std::move(done)));
    };
  }
  return door;
}

void Station::Impl::make_api(const Settings& settings, const Options& options) {
  api::Deps deps{.robot = robot,
                 .store = *store,
                 .services = *services,
                 .version = kVersion,
                 .profile = profile_of(settings, *supervisor)};
  deps.tiles = {tiles.sets(), [this](const std::string& set, int zoom, int x, int y) {
                  return tiles.read(set, zoom, x, y);
                }};
  deps.drivers = driver_door();
  deps.drill = drill_door(drill, robot, settings, options);
  deps.page = [this](const net::Request& request) {
    auto answer = front ? front->answer(request) : presence->answer(request);
    return answer ? std::move(answer) : page.answer(request);
  };
  deps.tls = front != nullptr;
  if (front && reaches_out(settings.server)) {
    deps.is_ours = [this](const std::string& name) { return front->is_ours(name); };
  }
  deps.figures = [this] {
    const net::Stats stats = server->stats();
    return api::NetFigures{.accepted = stats.accepted,
                           .refused = stats.refused,
                           .timed_out = stats.timed_out,
                           .requests = stats.requests,
                           .delivered = server->hub().delivered(),
                           .dropped = server->hub().dropped(),
                           .connections = stats.connections,
                           .clients = stats.clients};
  };
  deps.identity = [this] { return presence->identity(); };
  deps.host = [this] { return host; };
  deps.aside = [this](api::Aside a) {
    const net::Lane lane = a.large ? net::Lane::Large : net::Lane::Small;
    if (!a.must) return workers.run(lane, std::move(a.work), std::move(a.then));
    workers.must_run(lane, std::move(a.work), std::move(a.then));
    return true;
  };
  deps.later = [this](std::function<void()> call) { asio::post(web, std::move(call)); };
  deps.when_estop_kept = [this](std::function<void()> then) { when_estop_kept(std::move(then)); };
  if (settings.server.access) deps.people = &people;
  deps.control_grace = base::from_seconds(settings.server.control_grace_s);
  deps.tell_code = [this](const std::string& code) {
    // For whoever stands here; never for the log.
    std::printf("nobody can log in yet: make the first admin at %s with the code %s\n",
                address.c_str(), code.c_str());
    std::fflush(stdout);
  };
  deps.poster = [this](const std::string& path) {
    const auto code = pair::qr_code(address + path);
    return api::Poster{address + path, code ? pair::svg_of(*code) : std::string()};
  };
  api = std::make_unique<api::Api>(std::move(deps));
}

Result<void> Station::Impl::open_server(const Settings& settings, const Options& options) {
  const auto addresses = addresses_of(settings.server);
  const int port = options.port.value_or(settings.server.port);
  net::Limits limits;
  limits.per_address = settings.server.connections_per_address;
  auto listening = net::Server::listen(web, addresses, static_cast<std::uint16_t>(port), limits,
                                       handlers_of(*api, front.get()));
  if (!listening) return tl::unexpected(listening.error());
  server = std::move(*listening);
  api->attach(stream_of(server->hub()));
  if (front) {
    server->secure(front->tls());
    front->set_port(server->port());
    address = front->address();
    return {};
  }
  address = "http://" + authority_of(addresses.front(), server->port());
  return {};
}

/// Nobody reads a log: what holds in place of a kept value is told where the robot's events are.
void Station::Impl::tell_left_out(const Settings& settings) {
  if (!settings.rescued.empty()) {
    robot.tell({base::wall_now(), base::Severity::Error, "database_rescued", settings.rescued});
  }
  for (const std::string& why : settings.left_out) {
    robot.tell({base::wall_now(), base::Severity::Warning, "parameter_left_out",
                "a kept value is not taken any more, the one before it holds: " + why});
  }
}

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
  watch_host_soon();
  watch_names_soon();
  manager.ready(address);
  tell_alive();
  base::log(base::Level::Info, "main", "serving",
            {{"robot", presence->badge().name}, {"address", address}, {"version", kVersion}});
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

void Station::Impl::recall(const Settings& settings, const Options& options) {
  if (!options.replays.empty()) return;
  learned_file = std::filesystem::path(options.data) / "learned.json";
  learned_by = learner(settings);
  const nav::Learned known = read_learned(learned_file, learned_by, base::wall_now());
  robot.recall(known);
  if (!known.odometry_scale && !known.gyro_bias_radps) return;
  const auto text = [](const std::optional<nav::LearnedValue>& v) {
    return v ? std::to_string(v->value) : std::string("not known");
  };
  base::log(base::Level::Info, "main", "learned before",
            {{"odometry_scale", text(known.odometry_scale)},
             {"gyro_bias_radps", text(known.gyro_bias_radps)}});
}

/// A disk may pause: on a worker's thread, or, at the end, after all others.
void Station::Impl::keep_learned() {
  const auto learned = robot.learned();
  if (learned_file.empty() || !learned) return;
  if (!learned->odometry_scale && !learned->gyro_bias_radps) return;
  const auto kept = write_learned(learned_file, *learned, learned_by, base::wall_now());
  if (!kept) {
    base::log(base::Level::Warning, "main", "what was learned is not kept",
              {{"reason", kept.error().detail}});
  }
}

void Station::Impl::keep_learned_soon() {
  learned_timer.expires_after(kKeepLearned);
  learned_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    workers.must_run(net::Lane::Small, [this] { keep_learned(); }, {});
    keep_learned_soon();
  });
}

/// At once and then every minute, each when the one before is done: a disk may take its time.
void Station::Impl::tidy_recordings() {
  if (!tidier) return;
  const auto events = std::make_shared<std::vector<base::Event>>();
  workers.must_run(
      net::Lane::Large, [tidier = tidier, events] { *events = tidier->tidy(base::wall_now()); },
      [this, events] {
        for (base::Event& event : *events) api->on_event(std::move(event));
        tidy_timer.expires_after(kTidyRecordings);
        tidy_timer.async_wait([this](const boost::system::error_code& ec) {
          if (!ec) tidy_recordings();
        });
      });
}

/// A folder that was removed holds no lock any more: the link is what a second one would drive
/// over.
Result<void> Station::Impl::claim_robot(const Settings& settings, const Options& options) {
  const std::string link = drive_link(settings);
  if (link.empty() || !options.replays.empty()) return {};
  auto taken = Claim::take(link);
  if (!taken) return tl::unexpected(taken.error());
  claim.emplace(std::move(*taken));
  return {};
}

/// What is new is an event, too: nobody looks at GET /health all day.
void Station::Impl::watch_host() {
  refill_memory_reserve();
  const base::Time now = base::steady_now();
  if (const auto snapshot = robot.snapshot()) lateness_watch.take(snapshot->loop, now);
  auto found = host_problems({.now = now,
                              .wall = base::wall_now(),
                              .storage = store->storage(),
                              .real_time = loop->real_time(),
                              .memory_locked = memory_locked,
                              .lateness_s = lateness_watch.p999_s(),
                              .unannounced = presence->unannounced()});
  for (const base::HostProblem& problem : found) {
    const auto same = [&](const base::HostProblem& known) { return known.id == problem.id; };
    if (!problem.alarming || std::any_of(host.begin(), host.end(), same)) continue;
    robot.tell({base::wall_now(), base::Severity::Warning, problem.id, problem.detail});
  }
  host = found;
  robot.measurements().put(base::HostStatus{now, std::move(found)});
}

/// From the web thread: it must live as well as the loop.
void Station::Impl::tell_alive() {
  if (!manager.period() || !loop) return;
  const auto snapshot = robot.snapshot();
  manager.alive(snapshot ? snapshot->loop.ticks : 0);
  alive_timer.expires_after(*manager.period());
  alive_timer.async_wait([this](const boost::system::error_code& ec) {
    if (!ec) tell_alive();
  });
}

void Station::Impl::watch_host_soon() {
  host_timer.expires_after(kLookAtHost);
  host_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec || !loop) return;
    watch_host();
    watch_host_soon();
  });
}

/// It changes what devices must trust, or may have to be done again: not only for the log.
void Station::Impl::tell_certificate() {
  if (!front) return;
  for (const trust::Told& one : front->news()) {
    const auto level = one.alarming ? base::Level::Warning : base::Level::Info;
    const auto severity = one.alarming ? base::Severity::Warning : base::Severity::Info;
    base::log(level, "main", "certificate", {{"done", one.text}});
    robot.tell({base::wall_now(), severity, "certificate", one.text});
  }
}

/// For whoever stands before the terminal.
void Station::Impl::tell_address() {
  if (front->address() == address) return;
  address = front->address();
  std::printf("now at %s\n", address.c_str());
  std::fflush(stdout);
}

/// Names, addresses and clock change while the robot runs.
void Station::Impl::watch_names_soon() {
  if (!front) return;
  names_timer.expires_after(kLookAtNames);
  names_timer.async_wait([this](const boost::system::error_code& ec) {
    if (ec) return;
    const auto found = std::make_shared<std::optional<Result<Front::Found>>>();
    workers.must_run(
        net::Lane::Small, [this, found] { *found = front->look(); },
        [this, found] {
          if (*found) front->take(std::move(**found));
          presence->vouched_by(front->fingerprint());
          tell_certificate();
          tell_address();
          watch_names_soon();
        });
  });
}

/// The robot first: no command after this, and the base is told to stand.
void Station::Impl::halt() noexcept {
  loop.reset();
  if (supervisor) supervisor->stop();
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
